"""The C compiler that makes the library of a native FMU from the wrapper and the kernels."""

import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import fmpy

from herringbone.core import FmuError
from herringbone.fmi.native.platforms import Platform, own_platform

SOURCES = Path(__file__).parent / "c"
"""Folder of the wrapper's C files."""
INCLUDES = (SOURCES, *sorted(f for f in SOURCES.iterdir() if f.is_dir()))
"""Folders of its headers."""
_FLAGS = (
    "-std=c11", "-Os", "-g0", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off",
    "-ffunction-sections", "-fdata-sections", "-fno-stack-protector", "-U_FORTIFY_SOURCE",
    "-fomit-frame-pointer", "-fno-ident",
)  # fmt: skip
_NO_UNWINDING = ("-fno-asynchronous-unwind-tables", "-fno-unwind-tables")  # nothing is thrown
_SYSTEM = {
    "so": _NO_UNWINDING,
    "dll": ("-D__USE_MINGW_ANSI_STDIO=0",),
    "dylib": _NO_UNWINDING,
}
_WINDOWS = ("convert", "heap", "locale", "private", "runtime", "stdio", "string")
_LINK = {
    "so": (
        "-Wl,--gc-sections", "-Wl,--build-id=none", "-Wl,-z,defs", "-Wl,--hash-style=gnu",
    ),
    "dll": (
        "-nostdlib", "-rtlib=none", "-Wl,--gc-sections",
        *(f"-lapi-ms-win-crt-{part}-l1-1-0" for part in _WINDOWS), "-lkernel32",
    ),
    "dylib": ("-Wl,-dead_strip",),
}  # fmt: skip
"""What differs by system. Windows: its own C runtime, in place of mingw's library, which takes a
minute to build, and nothing of the compiler's library; functions there need their tables for
unwinding."""
_ZIG = ("-fno-sanitize=undefined",)
"""For linking: zig would build a library for a sanitizer that nothing uses, for four seconds."""


@dataclass(frozen=True, slots=True)
class Compiler:
    """A compiler for one platform.

    Attributes:
        name: for messages and for the cache.
        command: how it is called.
    """

    name: str
    command: tuple[str, ...]


def find_compiler(platform: Platform) -> Compiler | None:
    """`cc` for the platform of this process, otherwise zig; None if there is neither."""
    if platform == own_platform() and (cc := shutil.which("cc")):
        return Compiler("cc", (cc,))
    if importlib.util.find_spec("ziglang"):
        command = (sys.executable, "-m", "ziglang", "cc", "-target", platform.zig)
        return Compiler("zig", command)
    return None


def require_compiler(platform: Platform) -> Compiler:
    """As `find_compiler`.

    Raises:
        FmuError: there is none.
    """
    found = find_compiler(platform)
    if found is None:
        own = "install a C compiler (cc), or " if platform == own_platform() else ""
        raise FmuError(
            f"no C compiler for {platform.name} was found: {own}"
            "install zig with 'pip install herringbone[native]'"
        )
    return found


def compile_wrapper(compiler: Compiler, platform: Platform, folder: Path, fmi: int) -> None:
    """Compile the wrapper, which all components share, into object files.

    Args:
        compiler: for `platform`.
        platform: what the library is for.
        folder: in which the object files are written.
        fmi: FMI version, 2 or 3; the functions of the other one are left out.

    Raises:
        FmuError: the compiler failed.
    """
    for source in _sources(fmi):  # zig takes one at a time
        _compile(compiler, platform, source, folder)


def compile_library(
    compiler: Compiler,
    platform: Platform,
    description: Path,
    objects: Sequence[Path],
    library: Path,
) -> None:
    """Compile a component's description, and link it with the wrapper and the kernels.

    Args:
        compiler: for `platform`.
        platform: what the library is for.
        description: C file from `component_source`.
        objects: object files of the wrapper and of the kernels.
        library: file that is written.

    Raises:
        FmuError: the compiler failed.
    """
    link = list(_LINK[platform.extension])
    if platform.extension == "dylib":
        link.append(f"-Wl,-install_name,@rpath/{library.name}")
    own = _compile(compiler, platform, description, library.parent)
    inputs = [own, *map(str, objects), "-o", library.name]
    link += _ZIG if compiler.name == "zig" else ()
    _run(compiler, platform, ["-shared", "-s", *inputs, *link], library.parent)


def _compile(compiler: Compiler, platform: Platform, source: Path, folder: Path) -> str:
    """Compile a C file into a folder; name of its object file there."""
    made = f"{source.stem}.o"
    flags = [*_FLAGS, *_SYSTEM[platform.extension], *_include(), "-c"]
    _run(compiler, platform, [*flags, str(source), "-o", made], folder)
    return made


def _include() -> list[str]:
    return [f"-I{folder}" for folder in (*INCLUDES, Path(fmpy.__file__).parent / "c-code")]


def _run(compiler: Compiler, platform: Platform, arguments: Sequence[str], folder: Path) -> None:
    command = [*compiler.command, *arguments]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if run.returncode:
        raise FmuError(f"{compiler.name} for {platform.name} failed: {_reason(run.stderr)}")


def _sources(fmi: int) -> list[Path]:
    """C files, in the order of their names whatever folder they are in."""
    other = {2: "fmi3", 3: "fmi2"}[fmi]
    files = sorted(SOURCES.rglob("*.c"), key=lambda file: file.name)
    return [file for file in files if not file.name.startswith(other)]


def _reason(said: str) -> str:
    """The line that tells most: the first error of the compiler, else the linker's last words."""
    lines = [line.strip() for line in said.splitlines() if not line.startswith("collect2")]
    errors = [line for line in lines if "error:" in line]
    return next(iter(errors or lines[-1:]), "no message")
