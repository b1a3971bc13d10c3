"""What would be generated now, against what is there."""

import os
import shutil
import tempfile
from collections.abc import Collection
from pathlib import Path

import numpy as np

from herringbone.commands.generate.items import PICTURES, generate
from herringbone.core.places.paths import CACHE_VARIABLE

_ROUNDING = 1e-6
"""Largest difference of numbers, over the largest one of their column: platforms round apart."""
_COPIED = ("pyproject.toml", "fmus", "system_models", "src", str(PICTURES))


def differences(names: Collection[str], root: Path) -> list[str]:
    """Files that are not what would be generated now, by what is wrong with them.

    Raises:
        HerringboneError: a process fails.
    """
    os.environ.setdefault(CACHE_VARIABLE, str(root / "build"))
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch)
        for name in _COPIED:
            source, target = root / name, copy / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copyfile(source, target)
        generate(names, copy)
        made = sorted([
            *(file for file in (copy / "fmus").rglob("*") if file.is_file()),
            *(copy / "system_models").rglob("*.md"),
            *(copy / "docs").rglob("*.csv"),
        ])  # fmt: skip
        found = ((file.relative_to(copy), file) for file in made)
        return [f"{name}: {why}" for name, file in found if (why := difference(root / name, file))]


def difference(there: Path, made: Path) -> str:
    """How a file differs from what was made; empty if it does not."""
    if not there.is_file():
        return "missing"
    old, new = (file.read_text(encoding="utf-8") for file in (there, made))
    if old == new:
        return ""
    return _numbers_differ(old, new) if there.suffix == ".csv" else "differs"


def _numbers_differ(old: str, new: str) -> str:
    """How two tables differ, rounding aside; numbers are told from words."""
    commas, other = ([line.count(",") for line in text.splitlines()] for text in (old, new))
    if commas != other:
        return "another table"
    words, column, before = _cells(old)
    other_words, _, after = _cells(new)
    if words != other_words:
        return "other words"
    size = np.zeros(column.max(initial=0) + 1)
    np.maximum.at(size, column, np.abs(before))
    off = np.abs(after - before) > _ROUNDING * size[column]
    return f"{off.sum()} numbers differ by more than rounding" if off.any() else ""


def _cells(text: str) -> tuple[list[tuple[int, str]], np.ndarray, np.ndarray]:
    """Words with their columns, and columns and values (n,) of the numbers."""
    words, column, values = [], [], []
    for line in text.splitlines():
        for at, cell in enumerate(line.split(",")):
            try:
                values.append(float(cell))
                column.append(at)
            except ValueError:
                words.append((at, cell))
    return words, np.array(column, dtype=int), np.array(values)
