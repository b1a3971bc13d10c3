"""Mass and stiffness matrices of a foreign program, and how they become a housing."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from herringbone.core import ResourceError
from herringbone.core.declaring.roles import HALVES
from herringbone.core.process.telling import Tell, untold
from herringbone.core.reading.numbers import whole
from herringbone.core.reading.texts import LARGEST_MODEL, read_text
from herringbone.housing.importers.mode_set import make_frame, make_point
from herringbone.housing.importers.seat_file import SeatFile, Selection
from herringbone.housing.modal_model import AXES, ModalHousing, Point
from herringbone.housing.reduction.reduce import reduce_model
from herringbone.housing.reduction.reduced_housing import RESIDUAL_DAMPING

Row = tuple[int, int]
"""Node and component (1, 2, 3: translations) of a matrix row."""
_DAMPING = 0.01
_SLOWEST = 1e-2
"""Hz at which no node of a housing shakes on the springs around it."""
_MOST_ROWS = 10**7
_SAME_MASS = 1e-5
"""Difference of the masses along three axes that rounding of a file may make."""
"""More rows than any model that can be reduced here."""


@dataclass(frozen=True, eq=False)
class MatrixModel:
    """A held structure by its matrices, in the units of its file.

    Attributes:
        stiffness, mass: (N, N).
        rows: label of each row; None if the file has none.
        coordinates: of nodes, as far as the file tells.
        seat_input: (N, 12) forces by unit seat forces in the gearbox frame; None if the seats are
            given by nodes.
        source: what made them.
    """

    stiffness: sp.sparray
    mass: sp.sparray
    rows: tuple[Row, ...] | None
    coordinates: Mapping[int, np.ndarray]
    seat_input: np.ndarray | None
    source: Mapping[str, Any]


def only_name(names: Sequence[str], letter: str, path: Path) -> str:
    """The one matrix whose name begins with a letter: K is stiffness, M mass.

    Beside another one that begins with K, K4 is the structural damping of Nastran.
    """
    found = [name for name in names if name.startswith(letter)]
    if len(found) > 1:
        found = [name for name in found if not name.startswith("K4")]
    if len(found) != 1:
        raise ResourceError(
            f"{path}: one matrix whose name begins with {letter} is needed; "
            f"it has {', '.join(names) or 'none'}"
        )
    return found[0]


def check_size(rows: int, columns: int) -> None:
    """Refuse a matrix before there is memory for it; raises ResourceError."""
    if max(rows, columns) > _MOST_ROWS:
        raise ResourceError(f"{max(rows, columns)} rows or columns; at most {_MOST_ROWS} are read")


def read_rows(path: Path) -> tuple[Row, ...]:
    """Labels of matrix rows, one "node.axis" a line; raises ResourceError."""
    labels = read_text(path, most=LARGEST_MODEL).split()
    try:
        rows = tuple((whole(node), whole(axis)) for node, axis in (li.split(".") for li in labels))
    except ValueError as error:
        raise ResourceError(f"{path}: each line must be 'node.axis', such as 12.3") from error
    if bad := [row for row in rows if not 1 <= row[1] <= 6]:
        raise ResourceError(f"{path}: axis of '{bad[0][0]}.{bad[0][1]}' must lie between 1 and 6")
    return rows


def housing_from_matrices(
    model: MatrixModel,
    seats: SeatFile | None,
    *,
    band_hz: float,
    tolerance: float,
    most_modes: int,
    progress: Tell = untold,
) -> ModalHousing:
    """Reduce matrices to a housing, in SI units and the gearbox frame.

    Args:
        model: the matrices.
        seats: may be None if the model has its seat input.
        band_hz, tolerance, most_modes, progress: see `reduce_model`.

    Raises:
        HerringboneError: a node or the labels of the rows are missing, or see `reduce_model`.
    """
    _check_order(model)
    if seats is None:
        return _without_seat_file(model, band_hz, tolerance, most_modes, progress)
    rows = _labels(model, seats)
    selected = [s for s in seats.selections if s.role == "sensor" or model.seat_input is None]
    inputs = {s.name: _selected_input(s, rows, model.mass.shape[0], seats) for s in selected}
    seat_input = model.seat_input
    if seat_input is None:
        seat_input = np.hstack([inputs[name] for name in HALVES])
    found = reduce_model(
        model.stiffness * (seats.mass / seats.time**2),
        model.mass * seats.mass,
        seat_input,
        band_hz=band_hz,
        tolerance=tolerance,
        most_modes=most_modes,
        progress=progress,
    )
    points = tuple(make_point(s, _position(s, model, seats), seats) for s in seats.selections)
    sensors = [
        inputs[s.name][:, [AXES.index(dof) for dof in s.dofs]].T @ found.vectors
        for s in seats.selections
        if s.role == "sensor"
    ]
    housing = _housing(
        found, points, sensors, seats.damping_ratio, seats.damping_source, band_hz, model.source
    )
    description = {"description": seats.source} if seats.source else {}
    return replace(
        housing,
        boundary=seats.boundary,
        frame=make_frame(seats),
        source={**housing.source, **description},
    )


def _check_order(model: MatrixModel) -> None:
    """Refuse mass and stiffness of each other; in any units, nodes shake at more than 0.01 Hz."""
    stiffness, mass = model.stiffness.diagonal(), model.mass.diagonal()
    both = (stiffness > 0.0) & (mass > 0.0)
    if not both.any():
        return
    slow = math.sqrt(float(np.median(stiffness[both] / mass[both]))) / (2.0 * math.pi)
    if slow < _SLOWEST:
        raise ResourceError(
            f"{model.source.get('file', 'the matrices')}: stiffness over mass is that of "
            f"{slow:.2g} Hz; are they in the wrong order? Stiffness comes first"
        )


def _without_seat_file(
    model: MatrixModel,
    band_hz: float,
    tolerance: float,
    most_modes: int,
    progress: Tell,
) -> ModalHousing:
    if model.seat_input is None:
        raise ResourceError("where are the seats? Give --seats SEATS.toml, or a matrix (N, 12)")
    found = reduce_model(
        model.stiffness, model.mass, model.seat_input, band_hz=band_hz, tolerance=tolerance,
        most_modes=most_modes, progress=progress,
    )  # fmt: skip
    points = tuple(Point(name, "seat", (0.0, 0.0, 0.0)) for name in HALVES)
    source = {**model.source, "positions": "not given"}
    return _housing(found, points, [], _DAMPING, "assumed", band_hz, source)


def _housing(
    found: Any,  # noqa: ANN401
    points: tuple[Point, ...],
    sensors: Sequence[np.ndarray],
    damping_ratio: float,
    damping_source: str,
    band_hz: float,
    source: Mapping[str, Any],
) -> ModalHousing:
    residual = np.array([kind == "residual" for kind in found.kind])
    return ModalHousing(
        found.kind,
        found.frequency_hz,
        np.where(residual, RESIDUAL_DAMPING, damping_ratio),
        points,
        np.vstack([found.seat_shapes, *sensors]),
        band_hz,
        {
            "model": "viscous-modal",
            "source": f"{damping_source}; residual modes {RESIDUAL_DAMPING:g}, assumed",
        },
        source=source,
        static=found.static,
        certificate=found.certificate,
    )


def _labels(model: MatrixModel, seats: SeatFile) -> Mapping[Row, int]:
    size = model.mass.shape[0]
    rows = read_rows(seats.rows) if seats.rows else model.rows
    if rows is None:
        if size % 3:
            raise ResourceError(
                f"{seats.path}: the matrices have {size} rows without labels, which are not 3 per "
                "node; give [matrix] rows, a file of 'node.axis' lines"
            )
        _check_translations(model, seats)
        rows = tuple((row // 3 + 1, row % 3 + 1) for row in range(size))
    if len(rows) != size:
        raise ResourceError(
            f"{seats.rows or seats.path}: {len(rows)} labels for matrices of {size} rows"
        )
    return {row: i for i, row in enumerate(rows)}


def _check_translations(model: MatrixModel, seats: SeatFile) -> None:
    """Refuse rows that are not x, y and z of each node: a mass is the same in all directions.

    Six rows per node are a multiple of three, too, and seats would be taken at other nodes; of
    lumped masses the rotations have none.
    """
    mass = sp.csr_array(model.mass)
    massless = abs(mass).sum(axis=1).reshape(-1, 3).max(axis=1) == 0.0
    if massless.any() and not massless.all():
        raise ResourceError(
            f"{seats.path}: the matrices have {mass.shape[0]} rows without labels; as x, y, z of "
            f"each node {massless.sum()} of {massless.size} nodes would have no mass, the first "
            f"is node {int(massless.argmax()) + 1}: such rows are rotations; give [matrix] rows, a "
            "file of 'node.axis' lines"
        )
    along = np.array([mass[k::3, k::3].sum() for k in range(3)])
    if np.ptp(along) > _SAME_MASS * np.abs(along).max():
        ratios = ", ".join(f"{share:.4g}" for share in along / along[0])
        raise ResourceError(
            f"{seats.path}: the matrices have {mass.shape[0]} rows without labels; as x, y, z of "
            f"each node their masses along the axes would be as {ratios}: nodes have rotations, or "
            "rows are missing; give [matrix] rows, a file of 'node.axis' lines"
        )


def _selected_input(
    selection: Selection, rows: Mapping[Row, int], size: int, seats: SeatFile
) -> np.ndarray:
    """(N, 3) forces by unit forces on a selection along the gearbox axes."""
    found = np.zeros((size, 3))
    for node, weight in zip(selection.nodes, selection.weights, strict=True):
        at = [rows[row] for axis in (1, 2, 3) if (row := (node, axis)) in rows]
        if len(at) < 3:
            raise ResourceError(
                f"{seats.path}: {selection.role} {selection.name}: the matrices have no rows for "
                f"the three directions of node {node}"
            )
        found[at] += weight * seats.rotation.T
    return found


def _position(selection: Selection, model: MatrixModel, seats: SeatFile) -> np.ndarray:
    if selection.position is not None:
        return np.array(selection.position)
    if missing := [n for n in selection.nodes if n not in model.coordinates]:
        raise ResourceError(
            f"{seats.path}: {selection.role} {selection.name}: node {missing[0]} has no "
            "coordinates; give 'position'"
        )
    return selection.weights @ np.array([model.coordinates[n] for n in selection.nodes])
