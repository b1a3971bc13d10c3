"""The keys of everything that is cached: what a generated artefact depends on, and nothing else.

| artefact | key |
|---|---|
| kernel, piece | syntax of its module and of all modules of the package that this one imports |
| generated module | its text; as a kernel's source it is a module like others |
| step of a system | as of a kernel, of the factory and of its generated module; layout and form |
| object code of a component or system | syntax of its modules and of the compiler; the wiring |
| native library | its object code, the C sources, its description in C, which has `sources_key` |
| FMU | `packed_key`, its resources; a native one: its library |
| stiffness table, teeth of finite elements | values; syntax as of a kernel; versions of libraries |
| trials of a foreign part | content, values, name; where trials begin; syntax as of a kernel |
| answer of a command | question, folder; when sources changed; what is installed; files read |

Syntax: without comments, docstrings and layout, see `core.caching.syntax`. All sources are read
before the modules that they make are imported: what is edited later in this process must not get
compiled code cached under its name.
"""

import hashlib
import os
import sys
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path

from herringbone.core.caching.modules import Modules, stamps_of
from herringbone.core.caching.syntax import syntax_of
from herringbone.core.places.paths import PACKAGE, components_folder, systems_folder

_NAME = PACKAGE.name
_COMPUTING = ("core", "kernels", "components", "cosim", "fmi")
"""Packages that decide what is compiled and packed."""
_RESOURCES = {".py", ".csv"}
_LENGTH = 16
_DESCRIBED = ".dist-info", ".egg-info"
"""How folders that describe what is installed end."""
_BY_NAME = "importlib.import_module"
"""Who imports this, as the registry of components does, imports any module of its package. Who only
loads lazily what it imports for type checkers takes `importlib` itself."""


def digest_of(*texts: str | bytes) -> str:
    """A short hash of texts."""
    digest = hashlib.sha256()
    for text in texts:
        digest.update((text.encode() if isinstance(text, str) else text) + b"\0")
    return digest.hexdigest()[:_LENGTH]


@cache
def kernels_key(*modules: str, without: str = "") -> str:
    """Key of what is compiled from modules: their import closure, as syntax.

    Args:
        modules: of the package.
        without: package on which what is computed does not depend, such as that of the pictures.
    """
    found = sorted(_closure(modules, without))
    _MODULES.keep()
    return digest_of(*(f"{m} {_MODULES[m].digest}" for m in found))


@cache
def module_key(module: str, file: str) -> str:
    """Key of the kernels of a module: of the package, or a file outside that may import from it.

    Of generated modules that import others, these count with what they import.
    """
    if module in _MODULES:
        return kernels_key(module)
    syntax = syntax_of(Path(file).read_text(encoding="utf-8"))
    generated = (sys.modules.get(m) for m in syntax.imports if m.startswith(f"{_NAME}_"))
    keys = [module_key(m.__name__, m.__file__) for m in generated if m and m.__file__]
    return digest_of(syntax.digest, kernels_key(*_known(syntax.imports)), *keys)


def versions_of(*libraries: str) -> list[str]:
    """Names and versions of the libraries that are installed."""
    return [known for library in libraries if (known := _version_of(library))]


@cache
def _version_of(library: str) -> str:
    """Name and version; "" of one that is not installed."""
    beginning = f"{library}-"
    for name in _installed():
        if name.startswith(beginning):
            return f"{library} {name.removesuffix(_DESCRIBED[0]).removeprefix(beginning)}"
    from importlib.metadata import PackageNotFoundError, version  # noqa: PLC0415 (takes 10 ms)

    with suppress(PackageNotFoundError):
        return f"{library} {version(library)}"
    return ""


@cache
def sources_key() -> str:
    """Identity of FMUs: the sources and resources that decide what is compiled and packed.

    Golden results are left out: they follow from the sources.
    """
    computing = [name for name in sorted(_MODULES) if name.split(".")[1] in _COMPUTING]
    syntax = [f"{name} {_MODULES[name].digest}" for name in computing]
    _MODULES.keep()
    return digest_of(
        *syntax,
        *_contents(PACKAGE / "fmi", {".c", ".h"}),
        *_contents(components_folder(), _RESOURCES),
    )


@cache
def packed_key() -> str:
    """Key of packed FMUs: `sources_key`, and the docstrings, which are their documentation."""
    folders = PACKAGE / "components", PACKAGE / "kernels"
    return digest_of(sources_key(), *(c for f in folders for c in _contents(f, {".py"})))


@cache
def wrapper_key() -> str:
    """Key of the C sources around the kernels of native FMUs."""
    return digest_of(*_contents(PACKAGE / "fmi", {".c", ".h"}))


def answer_key(*asked: str) -> str:
    """Key of a command's answer, without the files that it was read from, see `caching.answers`.

    Sources count by the time of their last change: to look at it is quicker than to read them.
    """
    return digest_of(*asked, str(Path.cwd()), _all_that_answers())


@cache
def _all_that_answers() -> str:
    return digest_of(sys.version, *_installed(), repr(_STAMPS))


@cache
def _installed() -> list[str]:
    """What is installed, with versions: the names of its descriptions."""
    found = []
    for place in sys.path:
        with suppress(OSError), os.scandir(place) as entries:
            found += [entry.name for entry in entries if entry.name.endswith(_DESCRIBED)]
    return sorted(found)


def _contents(root: Path, suffixes: set[str]) -> Iterable[bytes]:
    for file in sorted(root.rglob("*")):
        if file.suffix in suffixes and file.is_file() and file.name != "golden.csv":
            yield file.relative_to(root).as_posix().encode()
            yield file.read_bytes()


def _closure(modules: Iterable[str], without: str = "") -> set[str]:
    """Modules of the package that are reached by imports, those of a package left out."""
    found, todo = set(), list(modules)
    while todo:
        module = todo.pop()
        if module in found or module not in _MODULES:
            continue
        if without and f"{module}.".startswith(f"{without}."):
            continue
        found.add(module)
        todo += _imported(module)
    return found


@cache
def _imported(module: str) -> list[str]:
    """Modules of the package that one of them imports."""
    imports = _MODULES[module].imports
    found = _known(imports)
    if _BY_NAME in imports:
        package = module.rpartition(".")[0] + "."
        found += [name for name in _MODULES if name.startswith(package)]
    return found


def _known(imports: Iterable[str]) -> list[str]:
    """Those of the imported names that are modules of the package, and the packages around them."""
    found = set()
    for name in imports:
        parts = name.split(".")
        if parts[0] == _NAME:
            found |= {".".join(parts[:k]) for k in range(2, len(parts) + 1)}
    return sorted(found & _MODULES.keys())


_MODULES = Modules()
_STAMPS = [
    *_MODULES.stamps.values(),
    *stamps_of(components_folder()),
    *stamps_of(systems_folder()),
]
"""As they were when this process began: what it computes is theirs."""
