"""Reader of the two modal tables: frequencies with damping, and shapes at the seats."""

from pathlib import Path

import numpy as np

from herringbone.components.flat_csv import read_flat_csv
from herringbone.core import ResourceError

_KINDS = ("normal", "residual", "rigid")


def read_modes(
    modes: Path, shapes: Path, dofs: tuple[tuple[str, str], ...], most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Read and check modes and shapes.

    Args:
        modes: columns mode, kind (normal, residual, rigid), frequency_hz [Hz], damping_ratio [1].
        shapes: columns point, dof, then one column a mode [kg^-1/2], mass-normalised.
        dofs: (point, dof) pairs that are needed; further rows, such as sensors, are allowed.
        most: largest number of modes.

    Returns:
        frequency_hz (n,), damping_ratio (n,), shapes (len(dofs), n).

    Raises:
        ResourceError: see `read_flat_csv`; unknown kind, frequency or damping out of range,
            missing seat, numbers of modes that differ or are too large.
    """
    _, frequency_hz, damping_ratio = read_mode_table(modes)
    if frequency_hz.size > most:
        raise ResourceError(f"{modes}: {frequency_hz.size} modes; at most {most}")
    keys, values = read_shape_table(shapes)
    if values.shape[1] != frequency_hz.size:
        raise ResourceError(
            f"{shapes} has {values.shape[1]} modes, {modes} has {frequency_hz.size}"
        )
    rows = {key: i for i, key in enumerate(keys)}
    missing = [f"{point} {dof}" for point, dof in dofs if (point, dof) not in rows]
    if missing:
        raise ResourceError(f"{shapes}: rows are missing for {', '.join(missing)}")
    return frequency_hz, damping_ratio, values[[rows[d] for d in dofs]]


def read_mode_table(modes: Path) -> tuple[tuple[str, ...], np.ndarray, np.ndarray]:
    """Read and check the table of modes.

    Returns:
        kind (n,), frequency_hz (n,) [Hz], damping_ratio (n,) [1].

    Raises:
        ResourceError: see `read_flat_csv`; unknown kind, frequency or damping out of range.
    """
    columns, _ = read_flat_csv(
        modes, ("kind",), {"mode": ("1",), "frequency_hz": ("Hz",), "damping_ratio": ("1",)}
    )
    frequency_hz, damping_ratio = columns["frequency_hz"], columns["damping_ratio"]
    _check_modes(columns["kind"], frequency_hz, damping_ratio, modes)
    return tuple(map(str, columns["kind"])), frequency_hz, damping_ratio


def read_shape_table(shapes: Path) -> tuple[tuple[tuple[str, str], ...], np.ndarray]:
    """Read and check the table of shapes.

    Returns:
        (point, dof) of the d rows, and the shapes (d, n) [kg^-1/2].

    Raises:
        ResourceError: see `read_flat_csv`; not mass-normalised, or a row stands twice.
    """
    table, units = read_flat_csv(shapes, ("point", "dof"), {}, more="shape")
    if units.get("shape") != "kg^-1/2":
        raise ResourceError(
            f"{shapes}: shapes have unit '{units.get('shape', 'none')}' in the '# units:' line; "
            "they must be mass-normalised, 'shape kg^-1/2'"
        )
    rows = tuple((str(p), str(d)) for p, d in zip(table["point"], table["dof"], strict=True))
    if len(set(rows)) < len(rows):
        raise ResourceError(f"{shapes}: a point and dof stand twice")
    names = [name for name in table if name not in {"point", "dof"}]
    return rows, np.array([table[name] for name in names]).reshape(len(names), len(rows)).T


def _check_modes(
    kinds: np.ndarray, frequency_hz: np.ndarray, damping_ratio: np.ndarray, file: Path
) -> None:
    for n, (kind, f, zeta) in enumerate(zip(kinds, frequency_hz, damping_ratio, strict=True), 1):
        where = f"{file}, mode {n}"
        if kind not in _KINDS:
            raise ResourceError(f"{where}: kind '{kind}' is none of {', '.join(_KINDS)}")
        if f < 0.0 or (f == 0.0 and kind != "rigid"):
            raise ResourceError(f"{where}: frequency {f:g} Hz must be positive (0 only if rigid)")
        if zeta < 0.0:
            raise ResourceError(f"{where}: damping ratio {zeta:g} must not be negative")
