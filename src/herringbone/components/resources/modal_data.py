"""The two modal tables: frequencies with damping, and shapes at the seats; what is refused.

Modes: columns mode (1, 2, ...), kind (normal, residual, rigid), frequency_hz [Hz] and
damping_ratio [1].
Shapes: columns point, dof, then one column a mode, m1, m2, ... [kg^-1/2], mass-normalised. Shapes
are those of the modes in their order, so that other numbers are refused; the loader of FMUs does
not see the names of the columns.
"""

from collections.abc import Sequence

import numpy as np

from herringbone.components.resources.flat_csv import check_units, read_flat_csv
from herringbone.components.resources.loader import REPORT, Refusal, read_numbers
from herringbone.core import Column, ResourceError
from herringbone.core.reading.texts import AnyPath
from herringbone.kernels.compiling.jit import kernel

Dofs = tuple[tuple[str, str], ...]

_KINDS = ("normal", "residual", "rigid")
_RIGID = _KINDS.index("rigid")
MODE_COLUMNS = (
    Column("mode", ("1",)),
    Column("kind", words=_KINDS),
    Column("frequency_hz", ("Hz",)),
    Column("damping_ratio", ("1",)),
)
_WIDTH = len(MODE_COLUMNS)
_SHAPE_UNITS = ("kg^-1/2",)
_SHAPE_HEADER, _NAMING = 3, 2
_NUMBER, _FREQUENCY, _DAMPING, _TOO_MANY, _OTHER_COUNT, _TWICE, _MISSING = range(1, 8)


def shape_columns(dofs: Dofs) -> tuple[Column, ...]:
    """Columns of the shapes; rows of other points, such as sensors, are allowed."""
    points = tuple(dict.fromkeys(point for point, _ in dofs))
    axes = tuple(dict.fromkeys(axis for _, axis in dofs))
    return (
        Column("point", words=points, other_words=True),
        Column("dof", words=axes, other_words=True),
        Column("shape", _SHAPE_UNITS, rest=True),
    )


def wanted_rows(dofs: Dofs) -> np.ndarray:
    """(len(dofs), 2): numbers of point and axis of each dof, as `shape_columns` reads them."""
    point, axis, _ = shape_columns(dofs)
    return np.array([[point.words.index(p), axis.words.index(a)] for p, a in dofs])


def refusals(dofs: Dofs, most: int) -> tuple[Refusal, ...]:
    """What `collect` may return."""
    return (
        Refusal(", mode %g has the number %g; sort the modes"),
        Refusal(", mode %g: frequency %g Hz must be positive, and 0 if rigid"),
        Refusal(", mode %g: damping ratio %g must lie between 0 and 1"),
        Refusal(f": %g modes; at most {most}"),
        Refusal(" has %g modes, the file of frequencies has %g", 1),
        Refusal(": a point and dof stand twice", 1),
        *(
            Refusal(f": %g of {len(dofs)} rows are missing, the first for {point} {axis}", 1)
            for point, axis in dofs
        ),
    )


@kernel
def _check_modes(values: np.ndarray, modes: int, report: np.ndarray) -> int:
    for mode in range(modes):
        at = _WIDTH * (mode + 1)
        kind, frequency_hz, damping_ratio = values[at + 1], values[at + 2], values[at + 3]
        report[0] = mode + 1
        if values[at] != mode + 1:
            report[1] = values[at]
            return _NUMBER
        if frequency_hz < 0.0 or (frequency_hz == 0.0) != (kind == _RIGID):
            report[1] = frequency_hz
            return _FREQUENCY
        if damping_ratio < 0.0 or damping_ratio > 1.0:
            report[1] = damping_ratio
            return _DAMPING
    return 0


@kernel
def collect(
    values: np.ndarray,
    shape: np.ndarray,
    wanted: np.ndarray,
    most: int,
    out: np.ndarray,
    at: int,
    report: np.ndarray,
) -> int:
    """Check modes and shapes, and arrange them.

    Args:
        values, shape: see `ResourceLoader`.
        wanted: see `wanted_rows`.
        most: largest number of modes.
        out, at: the number of modes, `most` frequencies [Hz], `most` damping ratios [1] and the
            shapes [kg^-1/2] by dof, each with room for `most` modes, are written to `out[at:]`.
        report: numbers of a refusal.

    Returns:
        0 or the number of a refusal (modes in another order, frequency or damping out of range, too
        many modes, numbers of modes that differ, a row that stands twice or is missing).
    """
    modes, rows, columns = shape[0], shape[2], shape[3]
    refusal = _check_modes(values, modes, report)
    if refusal:
        return refusal
    report[0], report[1] = modes, modes
    if modes > most:
        return _TOO_MANY
    if columns - _NAMING != modes:
        report[0] = columns - _NAMING
        return _OTHER_COUNT
    out[at] = modes
    for mode in range(modes):
        out[at + 1 + mode] = values[_WIDTH * (mode + 1) + 2]
        out[at + 1 + most + mode] = values[_WIDTH * (mode + 1) + 3]
    first_row = _WIDTH * (modes + 1) + _SHAPE_HEADER
    dofs = wanted.shape[0]
    missing, first_missing = 0, 0
    for k in range(dofs):
        found = 0
        for row in range(rows):
            here = first_row + row * columns
            if values[here] == wanted[k, 0] and values[here + 1] == wanted[k, 1]:
                found += 1
                for mode in range(modes):
                    out[at + 1 + (2 + k) * most + mode] = values[here + _NAMING + mode]
        if found > 1:
            return _TWICE
        if found == 0:
            first_missing = k if missing == 0 else first_missing
            missing += 1
    report[0] = missing
    return _MISSING + first_missing if missing else 0


def read_mode_table(modes: AnyPath) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Read and check the table of modes.

    Returns:
        kind (n,), frequency_hz (n,) [Hz], damping_ratio (n,) [1].

    Raises:
        ResourceError: see `read_numbers`; modes in another order, frequency or damping out of
            range.
    """
    values, (count, width) = read_numbers(modes, MODE_COLUMNS)
    report = np.zeros(REPORT)
    if refusal := _check_modes(values, count, report):
        raise refusals((), count)[refusal - 1].error([modes], report)
    _, kinds, frequency_hz, damping_ratio = values[width:].reshape(count, width).T
    return tuple(_KINDS[int(kind)] for kind in kinds), frequency_hz, damping_ratio


def read_shape_table(shapes: AnyPath) -> tuple[Dofs, np.ndarray]:
    """Read and check the table of shapes.

    Returns:
        (point, dof) of the d rows, and the shapes (d, n) [kg^-1/2].

    Raises:
        ResourceError: see `read_flat_csv`; not mass-normalised, modes in another order, or a row
            stands twice.
    """
    table, units = read_flat_csv(shapes, ("point", "dof"), {}, more="shape")
    check_units(units, {"shape": _SHAPE_UNITS}, shapes)
    rows = tuple((str(p), str(d)) for p, d in zip(table["point"], table["dof"], strict=True))
    if len(set(rows)) < len(rows):
        raise ResourceError(f"{shapes}: a point and dof stand twice")
    names = [name for name in table if name not in {"point", "dof"}]
    check_mode_columns(names, shapes)
    return rows, np.array([table[name] for name in names]).reshape(len(names), len(rows)).T


def check_mode_columns(names: Sequence[str], file: AnyPath) -> None:
    """Refuse columns other than m1, m2, ... in this order; raises ResourceError."""
    for n, name in enumerate(names, 1):
        if name != f"m{n}":
            raise ResourceError(
                f"{file}: column '{name}' stands where 'm{n}' must: give modes as m1, m2, ..."
            )
