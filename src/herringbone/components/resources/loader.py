"""From resource files to tables: the files become numbers, a kernel checks and arranges them.

The kernel is the same for Python and native FMUs, so that both have the same tables and refuse the
same files with the same words.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from herringbone.components.resources.flat_csv import (
    check_units,
    read_flat_csv,
    read_header,
)
from herringbone.core import Column, ResourceError, Text
from herringbone.core.reading.texts import AnyPath

REPORT = 12
"""Numbers that a refusal may show."""

NO_FILE = -1

LoadKernel = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray], int]
CheckKernel = Callable[[np.ndarray, np.ndarray], int]


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a resource file is refused.

    Attributes:
        format: follows the file's path; has `%g` conversions for the numbers of the report.
        text: which one of the component's resource files is at fault; NO_FILE: parameters are, and
            the format stands alone.
    """

    format: str
    text: int = 0

    def error(self, files: Sequence[AnyPath], report: np.ndarray) -> ResourceError:
        """The refusal with its numbers."""
        numbers = self.format.replace("%%", "").count("%")
        file = "" if self.text == NO_FILE else files[self.text]
        return ResourceError(f"{file}{self.format % tuple(report[:numbers])}")


@dataclass(frozen=True, eq=False)
class ResourceLoader:
    """Reads a component's resource files into the tables of a block.

    Attributes:
        texts: the String parameters that name the files, with their columns.
        kernel: load(values, shape, b, scratch, report) -> int, in the kernel language. `values`
            and `shape`: see `read_numbers`, file after file. It returns 0, or the number of a
            refusal, counted from 1, and writes the numbers that the refusal shows to `report`.
        refusals: what the kernel may return.
        scratch: length of the scratch space.
        check: check(b, report) -> int, in the kernel language: what was loaded against the
            parameters; it returns what `kernel` does. None: there is nothing to check.
    """

    texts: tuple[Text, ...]
    kernel: LoadKernel
    refusals: tuple[Refusal, ...]
    scratch: int
    check: CheckKernel | None = None

    def __call__(self, block: np.ndarray, files: Mapping[str, Path]) -> None:
        """Read the files, given by String parameter; raises ResourceError."""
        paths = self._paths(files)
        read = [
            read_numbers(p, text.columns, text.header, text.header_count, text.section)
            for p, text in zip(paths, self.texts, strict=True)
        ]
        values = np.concatenate([numbers for numbers, _ in read])
        shape = np.array([shape for _, shape in read], dtype=np.int64).ravel()
        report = np.zeros(REPORT)
        refusal = self.kernel(values, shape, block, np.empty(self.scratch), report)
        if refusal:
            raise self.refusals[refusal - 1].error(paths, report)

    def verify(self, block: np.ndarray, files: Mapping[str, Path]) -> None:
        """Check what was loaded against the parameters; raises ResourceError."""
        if self.check is None:
            return
        report = np.zeros(REPORT)
        refusal = self.check(block, report)
        if refusal:
            raise self.refusals[refusal - 1].error(self._paths(files), report)

    def _paths(self, files: Mapping[str, Path]) -> list[Path]:
        return [files[text.shared or text.name] for text in self.texts]


def read_numbers(
    file: AnyPath,
    columns: tuple[Column, ...],
    header: str = "",
    header_count: int = 0,
    section: str = "",
) -> tuple[np.ndarray, tuple[int, int]]:
    """Read a flat CSV file as numbers; see `Text` for its grammar.

    Returns:
        One number per declared column (which of its units the file uses; 0 for words), then the
        numbers of the header line (NaN if there is none), then the rows, columns in declared
        order; and the number of rows and of columns.

    Raises:
        ResourceError: see `read_flat_csv` and `read_header`; or a word that a column does not take.
    """
    words = tuple(c for c in columns if c.words)
    rest = next((c.name for c in columns if c.rest), "")
    wanted = {c.name: c.units for c in columns if c.units and not c.rest}
    names = tuple(c.name for c in words)
    table, units = read_flat_csv(file, names, wanted, more=rest, section=section)
    check_units(units, {c.name: c.units for c in columns if c.units}, file)
    for column in words:
        table[column.name] = _numbered(column, table[column.name], file)
    declared = [c.name for c in columns if not c.rest]
    order = [*declared, *(name for name in table if name not in declared)]
    rows = np.column_stack([table[name] for name in order])
    used = [float(c.units.index(units[c.name].strip())) if c.units else 0.0 for c in columns]
    given = read_header(file, header, header_count, section)
    return np.concatenate([used, given, rows.ravel()]), rows.shape


def _numbered(column: Column, found: np.ndarray, file: AnyPath) -> np.ndarray:
    numbers = {word: float(i) for i, word in enumerate(column.words)}
    if not column.other_words and (unknown := [w for w in found if w not in numbers]):
        raise ResourceError(
            f"{file}: {column.name} '{unknown[0][:64]}' is none of {', '.join(column.words)}"
        )
    return np.array([numbers.get(word, -1.0) for word in found])
