"""Importer of CalculiX result files (.frd) with the modes of a *FREQUENCY step.

The step needs *NODE FILE with U. Frequencies are taken from the generalised stiffness and mass (7
digits), of which the result's header has 6 and no sign.

Source: CalculiX CrunchiX user's manual, *FREQUENCY; CalculiX GraphiX manual, result format.
"""

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from herringbone.core import ResourceError
from herringbone.core.reading.numbers import number, whole
from herringbone.core.reading.texts import LARGEST_MODEL, lines_of, read_text
from herringbone.housing.importers.mode_set import ModeSet, check_modal_mass, in_order
from herringbone.housing.importers.modes_twice import check_no_number_twice

_LABEL_WIDTHS = {"0": 5, "1": 10}
"""Columns of a node number by the format number of a block; 2 and 3 are binary."""
_VALUE = 12


def read_frd(path: str | Path) -> ModeSet:
    """Read the modes of a CalculiX result file.

    Raises:
        ResourceError: not readable, binary, truncated, without modes, or complex modes, or the
            modes of two steps.
    """
    path = Path(path)
    lines = lines_of(read_text(path, most=LARGEST_MODEL, ascii_only=True))
    if not lines or not lines[0].startswith("    1C"):
        raise ResourceError(f"{path} is no CalculiX result file: it does not begin with '    1C'")
    if lines[-1].strip() != "9999":
        raise ResourceError(f"{path} is truncated: the end mark 9999 is missing")
    try:
        node, coordinates, frequency, shapes = _parse(lines)
    except (ValueError, IndexError, KeyError, StopIteration) as error:
        raise ResourceError(f"{path} is malformed: {error or 'a block does not end'}") from error
    except ResourceError as error:
        raise ResourceError(f"{path}: {error}") from None
    version = next((li.split()[-1] for li in lines[:20] if li.startswith("    1UVERSION")), "")
    return ModeSet(
        node,
        coordinates,
        frequency,
        np.full(frequency.size, np.nan),
        shapes,
        {"tool": f"CalculiX {version}".strip(), "file": path.name},
    )


def _parse(lines: list[str]) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    node = np.empty(0, dtype=int)
    coordinates = np.empty((0, 3))
    header: dict[str, float] = {}
    numbers: list[int] = []
    frequencies: list[float] = []
    shapes: list[np.ndarray] = []
    rest = iter(lines)
    for line in rest:
        if line.startswith("    2C"):
            node, coordinates = _block(rest, _label_width(line))
        elif line.startswith("    1P"):
            name, _, value = line.strip().partition(" ")
            header[name] = number(value.split()[0])
        elif line.startswith("  100C"):
            kind = line[58:70].strip()
            found = _result(rest, _label_width(line), kind)
            if found is not None:
                at, values = found
                if kind.endswith("I") or "1PGM" not in header:
                    raise ResourceError("the modes are complex or have no generalised mass")
                mass = check_modal_mass(header["1PGM"], f"mode {len(shapes) + 1}")
                numbers.append(int(header.get("1PMODE", 0)))
                frequencies.append(_frequency(header["1PGK"] / mass))
                shapes.append(in_order(node, at, values) / math.sqrt(mass))
            header.clear()
    if not shapes:
        raise ResourceError(
            "it has no modal displacements; ask for *NODE FILE with U in a *FREQUENCY step"
        )
    check_no_number_twice(numbers, frequencies)
    return node, coordinates, np.array(frequencies), np.stack(shapes, axis=-1)


def _label_width(line: str) -> int:
    if (number := line[72:].strip()[-1:]) not in _LABEL_WIDTHS:
        raise ResourceError("it is binary; ask for ASCII output (*NODE FILE, no OUTPUT=BINARY)")
    return _LABEL_WIDTHS[number]


def _frequency(square: float) -> float:
    """Frequency from the square of w; negative where that is, of which the header does not tell."""
    return math.copysign(math.sqrt(abs(square)), square) / (2.0 * math.pi)


def _block(lines: Iterator[str], width: int) -> tuple[np.ndarray, np.ndarray]:
    """Labels (k,) and three values each (k, 3), up to the end of a block."""
    labels: list[int] = []
    values: list[list[float]] = []
    first = 3 + width
    for line in lines:
        if line.startswith(" -3"):
            return np.array(labels, dtype=int), np.array(values).reshape(-1, 3)
        if line.startswith(" -1"):
            labels.append(whole(line[3:first]))
            values.append([number(line[first + _VALUE * j :][:_VALUE]) for j in range(3)])
    raise ResourceError("a block does not end")


def _result(lines: Iterator[str], width: int, kind: str) -> tuple[np.ndarray, np.ndarray] | None:
    """Labels and displacements of a modal result; None for any other result."""
    name = next(lines)[5:13].strip()
    if name.startswith("DISP") and "MODAL" in kind:
        return _block(lines, width)
    for line in lines:
        if line.startswith(" -3"):
            return None
    raise ResourceError("a block does not end")
