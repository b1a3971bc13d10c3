"""Where compiled kernels are cached, and when they are made anew.

numba takes a cached kernel as long as the file that holds it is the same, byte by byte: it sees
neither the files that hold its callees nor that an edit was but a comment. Here kernels are taken
as long as the syntax of all that they are compiled from is the same (see `core.caching.keys`).
Files that cannot be read, being cut off or empty, are made anew.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

import contextlib
import hashlib
import inspect
import logging
import pickle
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TypeVar

from numba.core import config
from numba.core.caching import (
    CompileResultCacheImpl,
    FunctionCache,
    IndexDataCacheFile,
    _CacheLocator,
)
from numba.core.codegen import JITCPUCodegen
from numba.core.compiler import CompileResult
from numba.core.cpu import CPUContext
from numba.core.typing import Signature

from herringbone.core.caching.keys import digest_of, module_key
from herringbone.core.places.paths import cache_folder, cache_root, is_trusted, make_private

D = TypeVar("D")
_LOG = logging.getLogger("herringbone")
_DIGEST = hashlib.sha256().digest_size


@cache
def _kernels(root: Path) -> Path:
    """The folder of all kernels in the present cache, which is looked at once for hundreds."""
    del root  # by which it is known
    return cache_folder("kernels")


class _Locator(_CacheLocator):
    """Where the code of one kernel lies."""

    def __init__(self, function: Callable, file: str) -> None:
        self._py_file, self._function = file, function

    def get_cache_path(self) -> str:
        """A folder for each module, and each way of compiling it."""
        module = self._function.__module__.removeprefix("herringbone.")
        how = f"optimised-{int(config.OPT)}" + "-checked" * bool(config.BOUNDSCHECK)
        return str(_kernels(cache_root()) / how / module)

    def ensure_cache_path(self) -> None:
        """Make the folder; raises OSError if nothing can be written there."""
        make_private(Path(self.get_cache_path()))
        super().ensure_cache_path()

    def get_source_stamp(self) -> str:
        """Key of what it is compiled from."""
        return module_key(self._function.__module__, self._py_file)

    def get_disambiguator(self) -> str:
        """Nothing: no two kernels of a module have the same name."""
        return "kernel"

    @classmethod
    def from_function(cls, py_func: Callable, py_file: str) -> "_Locator":
        """The locator of a kernel."""
        return cls(py_func, py_file)


class KernelFiles(CompileResultCacheImpl):
    """numba's files, under names of ours."""

    def __init__(self, py_func: Callable) -> None:
        self._lineno = py_func.__code__.co_firstlineno
        self._locator = _Locator(py_func, inspect.getfile(py_func))
        self._filename_base = self.get_filename_base(py_func.__qualname__, "")


class _CheckedData(IndexDataCacheFile):
    """numba's files, with a digest in front of the machine code."""

    def save(self, key: tuple, data: tuple) -> None:
        """Save the code of a signature in a file of its own.

        numba counts files: of two processes that save at the same time, each would take the same
        number, and the index could name the code of another signature.
        """
        name = self._data_name(int(digest_of(repr(key)), 16))
        try:
            overloads = self._load_index()
        except ValueError:  # it is damaged
            overloads = {}
        overloads[key] = name
        self._save_data(name, data)
        self._save_index(overloads)

    def _load_index(self) -> dict:
        try:
            version, stamp, overloads = self._read(self._index_path)
        except FileNotFoundError:
            return {}
        known = (version, stamp) == (self._version, self._source_stamp)
        return pickle.loads(overloads) if known else {}

    def _save_index(self, overloads: dict) -> None:
        packed = self._dump(overloads)  # which another numba might not understand
        self._write(self._index_path, (self._version, self._source_stamp, packed))

    def _save_data(self, name: str, data: tuple) -> None:
        self._write(self._data_path(name), data)

    def _load_data(self, name: str) -> tuple:
        return self._read(self._data_path(name))

    def _write(self, path: str, data: tuple) -> None:
        content = self._dump(data)
        with self._open_for_write(path) as file:
            Path(file.name).chmod(0o600)  # whatever the umask, see `_read`
            file.write(hashlib.sha256(content).digest() + content)

    def _read(self, path: str) -> tuple:
        """Content of a file; raises OSError, or ValueError if it is not what was written."""
        if not is_trusted(Path(path)):
            raise ValueError("it is of another user, or others can write it")
        read = Path(path).read_bytes()
        digest, content = read[:_DIGEST], read[_DIGEST:]
        if hashlib.sha256(content).digest() != digest:
            raise ValueError("it is damaged")
        return pickle.loads(content)


class KernelCache(FunctionCache):
    """numba's cache of a function, with our keys; it survives damaged files."""

    _impl_class = KernelFiles

    def __init__(self, py_func: Callable) -> None:
        super().__init__(py_func)
        locator = self._impl.locator
        self._cache_file = _CheckedData(
            self._cache_path, self._impl.filename_base, locator.get_source_stamp()
        )

    def load_overload(self, sig: Signature, target_context: CPUContext) -> CompileResult | None:
        """A compiled kernel; None: it must be compiled."""
        try:
            return super().load_overload(sig, target_context)
        except Exception as error:
            self._make_anew(error)
            return None

    def save_overload(self, sig: Signature, data: CompileResult) -> None:
        """Save a compiled kernel."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            _LOG.warning("%s is not cached: %s", self._py_func.__qualname__, error)

    def _make_anew(self, error: Exception) -> None:
        _LOG.warning(
            "cached kernel %s cannot be read (%s); it is compiled again",
            self._impl.filename_base, error or type(error).__name__,
        )  # fmt: skip
        with contextlib.suppress(OSError):
            self.flush()


class NamedCache(KernelCache):
    """The cache of a kernel whose name tells all that its factory was given."""

    def _index_key(self, sig: Signature, codegen: JITCPUCodegen) -> tuple:
        """numba would ask closures for bytes, in which kernels have numbers of the process."""
        return sig, codegen.magic_tuple()


def cached(compiled: D, function: Callable, kind: type[KernelCache] = KernelCache) -> D:
    """Let a dispatcher or C callback of numba cache what it compiles of a function."""
    compiled._cache = kind(function)  # type: ignore[attr-defined]  # of both kinds
    return compiled
