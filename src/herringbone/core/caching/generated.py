"""Modules that are generated, written to the cache folder and imported from there.

A file, not `exec`, so that numba can cache what such a module compiles.
"""

import contextlib
import importlib.util
import logging
import marshal
import sys
from pathlib import Path
from threading import RLock
from types import CodeType, ModuleType

from herringbone.core.caching.files import read_stored, store, write_file
from herringbone.core.caching.keys import digest_of
from herringbone.core.places.paths import cache_folder

_PYTHON = f"{sys.implementation.cache_tag}-{importlib.util.MAGIC_NUMBER.hex()}"
_LOG = logging.getLogger("herringbone")
_locks: dict[str, RLock] = {}
"""By name: with one for all, two threads whose modules import each other would wait for ever."""


def load_generated(kind: str, source: str) -> ModuleType:
    """Import a generated module, once per process; its name follows from its content.

    Args:
        kind: what it is, such as "twin"; becomes part of its name.
        source: Python source.
    """
    name = f"herringbone_{kind}_{digest_of(source)}"
    with _locks.setdefault(name, RLock()):
        if name in sys.modules:
            return sys.modules[name]
        file = cache_folder("generated") / f"{name}.py"
        if not _is_written(file, source):
            write_file(file, source.encode())
        spec = importlib.util.spec_from_file_location(name, file)
        module = importlib.util.module_from_spec(spec)  # type: ignore[arg-type]  # .py has one
        sys.modules[name] = module  # before, because what it defines asks for its module
        try:
            exec(_code(file, source), module.__dict__)
        except BaseException:  # Ctrl-C, too: half of a module would stay for all that ask later
            sys.modules.pop(name, None)
            raise
        return module


def _code(file: Path, source: str) -> CodeType:
    """Byte code of a module; Python itself would not check what it keeps.

    It names its file: that of a cache folder that was moved or copied is compiled anew.
    """
    kept = file.with_suffix(f".{_PYTHON}.code")
    if (found := read_stored(kept)) is not None:
        code: CodeType = marshal.loads(found)
        if code.co_filename == str(file):
            return code
    code = compile(source, file, "exec")
    with contextlib.suppress(OSError):  # it can be made again
        store(kept, marshal.dumps(code))
    return code


def _is_written(file: Path, source: str) -> bool:
    """True if the file holds the source; a line is logged if it holds something else."""
    if not file.is_file():
        return False
    if file.read_bytes() == source.encode():
        return True
    _LOG.warning("%s is damaged; it is written anew", file)
    return False
