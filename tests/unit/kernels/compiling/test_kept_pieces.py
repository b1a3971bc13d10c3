"""Pieces of kernels serve whatever else is compiled of them, in this process and in others.

This leans on the inside of numba: it is run with every minor version that pyproject admits.
"""

import shutil
import subprocess
import sys
from functools import partial

import pytest

HEAD = """
from herringbone.kernels.compiling.jit import inner, kernel
"""
PART = f"""{HEAD}

@kernel
def part(x: float, n: int) -> float:
    return min(x, 0.25) ** n + int(4.0 * x)
"""
MIDDLE = f"""{HEAD}
from parts import part


@kernel
def middle(x: float) -> float:
    return 2 * part(x, 3)
"""
CALLER = f"""{HEAD}
from middles import middle


@kernel
def {{name}}(x: float) -> float:
    return middle(x) + {{more}}
"""
MADE = f"""{HEAD}

def factory(factor):
    @inner("made")
    def part(x: float, n: int) -> float:
        return factor * x

    return part


part = factory(3.0)
"""
SHOW = """
import sys
from {name}s import {name}
value = {name}(0.5)
from middles import middle
from parts import part
stats = [k.piece.stats for k in (middle, part)]
counts = [s.cache_hits for s in stats] + [s.cache_misses for s in stats]
print(value, *(sum(c.values()) for c in counts))
"""
VALUE = 2.0 * (0.25**3 + 2.0)


def show(folder, name, more):
    """Value of a new kernel in a process of its own, hits and misses of `middle` and `part`."""
    (folder / f"{name}s.py").write_text(CALLER.format(name=name, more=more))
    environment = {
        "PATH": "/usr/bin:/bin",
        "PYTHONPATH": str(folder),
        "HERRINGBONE_CACHE": str(folder / "cache"),
        "PYTHONDONTWRITEBYTECODE": "1",  # the old one serves what has the same size and second
    }
    ran = subprocess.run(
        [sys.executable, "-c", SHOW.format(name=name)],
        capture_output=True, text=True, check=True, env=environment,
    )  # fmt: skip
    value, *counts = ran.stdout.split()
    return float(value), list(map(int, counts))


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """Folder of the pieces, with what a first process has left in the cache."""
    folder = tmp_path_factory.mktemp("warm")
    (folder / "parts.py").write_text(PART)
    (folder / "middles.py").write_text(MIDDLE)
    assert show(folder, "one", 1.0) == (VALUE + 1.0, [0, 0, 1, 1])
    return folder


@pytest.fixture
def shown(warm, tmp_path):
    """Function, see `show`, of a copy of the folder."""
    shutil.copytree(warm, tmp_path, dirs_exist_ok=True)
    return partial(show, tmp_path)


def test_another_process_compiles_no_piece_again(shown):
    assert shown("two", 2.0) == (VALUE + 2.0, [1, 1, 0, 0])


def test_an_edited_piece_is_compiled_again(shown, tmp_path):
    """Its caller serves on: it calls it by its name."""
    (tmp_path / "parts.py").write_text(PART.replace("int(4.0 * x)", "3.0"))
    assert shown("two", 2.0) == (2.0 * (0.25**3 + 3.0) + 2.0, [1, 0, 0, 1])


def test_who_calls_what_returns_something_else_is_compiled_again(shown, tmp_path):
    (tmp_path / "parts.py").write_text(PART.replace("min(x, 0.25) ** n + ", ""))
    assert shown("two", 2.0) == (2.0 * 2 + 2.0, [0, 0, 1, 1])


def test_what_factories_make_is_not_kept(shown, tmp_path):
    (tmp_path / "parts.py").write_text(MADE)
    assert shown("other", 1.0) == (3.0 + 1.0, [0, 0, 1, 1])
    (tmp_path / "parts.py").write_text(MADE.replace("3.0", "5.0"))
    assert shown("two", 2.0) == (5.0 + 2.0, [0, 0, 1, 1])


@pytest.mark.parametrize("left", [0, 60])
def test_damaged_pieces_are_compiled_again(shown, tmp_path, left):
    damaged = [f for f in tmp_path.rglob("*.piece.*") if f.suffix == ".nbc"]
    assert len(damaged) == 2
    for file in damaged:
        file.write_bytes(file.read_bytes()[:left])
    assert shown("two", 2.0) == (VALUE + 2.0, [0, 0, 1, 1])
    assert shown("three", 3.0) == (VALUE + 3.0, [1, 1, 0, 0])
