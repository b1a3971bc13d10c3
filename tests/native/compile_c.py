"""Compile the C tests of native FMUs."""

import shutil
import subprocess
from pathlib import Path

import fmpy

import herringbone.fmi

HERE = Path(__file__).parent
WRAPPER = Path(herringbone.fmi.__file__).parent / "native" / "c"
COMPILER = shutil.which("gcc") or shutil.which("clang")
VALGRIND = ("valgrind", "-q", "--leak-check=full", "--error-exitcode=9")
_HEADERS = Path(fmpy.__file__).parent / "c-code"
_WARNINGS = ("-Wall", "-Wextra", "-Werror", "-Wno-format-nonliteral")


def compile_c(*arguments: str | Path) -> None:
    command = [COMPILER, "-std=c11", "-g", "-O1", "-pthread", *_WARNINGS]
    folders = (WRAPPER, *(f for f in WRAPPER.iterdir() if f.is_dir()), _HEADERS, HERE)
    command += [*(f"-I{folder}" for folder in folders), *map(str, arguments)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr


def execute(*command: str | Path, **options: object) -> None:
    run = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
