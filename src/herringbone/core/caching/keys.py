"""The keys of everything that is cached: what a generated artefact depends on, and nothing else.

| artefact | key |
|---|---|
| kernel, piece | syntax of its module and of all modules of the package that this one imports |
| generated module | its text; as a kernel's source it is a module like others |
| object code of a component or system | syntax of its modules and of the compiler; the wiring |
| native library | its object code, the C sources, its description in C, which has `sources_key` |
| FMU | `packed_key`, its resources; a native one: its library |
| stiffness table, teeth of finite elements | values; syntax as of a kernel; versions of libraries |

Syntax: without comments, docstrings and layout, see `core.caching.syntax`. All sources are read
before the modules that they make are imported: what is edited later in this process must not get
compiled code cached under its name.
"""

import hashlib
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.syntax import Syntax, syntax_of
from herringbone.core.places.paths import PACKAGE, cache_root, components_folder

_NAME = PACKAGE.name
_COMPUTING = ("core", "kernels", "components", "cosim", "fmi")
"""Packages that decide what is compiled and packed."""
_RESOURCES = {".py", ".csv"}
_LENGTH = 16
_BY_NAME = "importlib.import_module"
"""Who imports this, as the registry of components does, imports any module of its package."""


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
        imports = _MODULES[module].imports
        todo += _known(imports)
        if _BY_NAME in imports:
            package = module.rpartition(".")[0] + "."
            todo += [name for name in _MODULES if name.startswith(package)]
    return found


def _known(imports: Iterable[str]) -> list[str]:
    """Those of the imported names that are modules of the package, and the packages around them."""
    found = set()
    for name in imports:
        parts = name.split(".")
        if parts[0] == _NAME:
            found |= {".".join(parts[:k]) for k in range(2, len(parts) + 1)}
    return sorted(found & _MODULES.keys())


class _Modules(Mapping[str, Syntax]):
    """All modules of the package by name; files that have not changed are not parsed again.

    All are read now; what nobody asks for is not parsed.
    """

    def __init__(self) -> None:
        self._memo = cache_root() / f"syntax-{sys.version_info[0]}.{sys.version_info[1]}.json"
        known = kept(self._memo) or {}
        self._stamps: dict[str, list] = {}
        self._found: dict[str, Syntax] = {}
        self._sources: dict[str, bytes] = {}
        for file in sorted(PACKAGE.rglob("*.py")):
            status = file.stat()
            stamp = [str(file), status.st_mtime_ns, status.st_size]
            parts = file.relative_to(PACKAGE).with_suffix("").parts
            name = ".".join((_NAME, *parts)).removesuffix(".__init__")
            if name == _NAME:  # it only says where names are
                continue
            self._stamps[name] = stamp
            old = known.get(name)
            if old and old[:3] == stamp:
                self._found[name] = Syntax(old[3], tuple(old[4]))
            else:
                self._sources[name] = file.read_bytes()
        self._kept = set(self._found) if self._found.keys() == known.keys() else set()

    def __getitem__(self, name: str) -> Syntax:
        if name not in self._found:
            self._found[name] = _syntax_of(self._sources.pop(name))
        return self._found[name]

    def __contains__(self, name: object) -> bool:
        return name in self._stamps

    def __iter__(self) -> Iterator[str]:
        return iter(self._stamps)

    def __len__(self) -> int:
        return len(self._stamps)

    def keep(self) -> None:
        """Keep what is known now for other processes."""
        if self._kept != self._found.keys():
            self._kept = set(self._found)
            found = sorted(self._found.items())
            keep(self._memo, {m: [*self._stamps[m], s.digest, list(s.imports)] for m, s in found})


def _syntax_of(source: bytes) -> Syntax:
    try:
        return syntax_of(source.decode())
    except SyntaxError:  # whoever imports it gets the message
        return Syntax(digest_of(source), ())


_MODULES = _Modules()
