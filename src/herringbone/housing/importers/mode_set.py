"""Modes of a foreign program, and how they become a housing."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from herringbone.core import ResourceError
from herringbone.housing.importers.modes_twice import check_no_mode_twice
from herringbone.housing.importers.seat_file import SeatFile, Selection
from herringbone.housing.modal_model import AXES, Frame, ModalHousing, Point

_COLLINEAR = 0.95
_REAL = 0.1
"""Largest imaginary part of a complex mode's modal mass, over its real part."""
_RIGID_HZ = 1e-3
_ROUNDING = 1e-4
"""A negative frequency that is rounding of zero, over the highest frequency."""


@dataclass(frozen=True, eq=False)
class ModeSet:
    """Mass-normalised real modes at nodes, in the units and coordinates of their file.

    Attributes:
        node: (k,) labels.
        coordinates: (k, 3) [length].
        frequency: (n,) [1/time]; negative where the modal stiffness is.
        damping_ratio: (n,) [1]; NaN where the file does not tell.
        shapes: (k, 3, n) [mass^-1/2]; NaN where a mode leaves a node out.
        source: what made them.
    """

    node: np.ndarray
    coordinates: np.ndarray
    frequency: np.ndarray
    damping_ratio: np.ndarray
    shapes: np.ndarray
    source: Mapping[str, Any]


def in_order(node: np.ndarray, labels: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(k, 3) values of a mode in the order of the nodes; NaN where it leaves a node out.

    Args:
        node: (k,) labels of all nodes.
        labels: (m,) nodes of the mode.
        values: (m, 3).

    Raises:
        ResourceError: a node of the mode has no coordinates.
    """
    if np.array_equal(node, labels):
        return values
    rows = {int(label): i for i, label in enumerate(node)}
    if unknown := [int(label) for label in labels if int(label) not in rows]:
        raise ResourceError(f"a mode has the node {unknown[0]}, which has no coordinates")
    found = np.full((node.size, 3), math.nan)
    found[[rows[int(label)] for label in labels]] = values
    return found


def real_shape(shape: np.ndarray, where: object) -> tuple[np.ndarray, complex]:
    """Rotate a complex mode shape to real.

    Accepted if the modal phase collinearity is at least 0.95.

    Args:
        shape: (...) complex.
        where: named in the message.

    Returns:
        The real shape, and the phase factor: shape = factor * real shape.

    Raises:
        ResourceError: the phases scatter too much: damping is far from proportional.

    Source: R. S. Pappa, K. B. Elliott, A. Schenk, J. Guidance, Control, Dynamics 16 (1993) 852-858.
    """
    flat = np.stack([shape.real.ravel(), shape.imag.ravel()])
    smaller, larger = np.linalg.eigvalsh(flat @ flat.T)
    collinearity = ((larger - smaller) / (larger + smaller)) ** 2 if larger > 0.0 else 0.0
    if collinearity < _COLLINEAR:
        raise ResourceError(
            f"{where}: the shape is complex, phase collinearity {collinearity:.2f} < {_COLLINEAR}; "
            "give real normal modes"
        )
    factor = np.sqrt((shape**2).sum())
    factor /= abs(factor)
    return (shape / factor).real, complex(factor)


def mass_of_complex_mode(
    modal_a: complex, factor: complex, damped_w: float, where: object
) -> float:
    """Modal mass of a complex mode's real shape, from its modal A: A = 2 j w_d m factor**2.

    Args:
        modal_a: modal A of the complex shape.
        factor: of `real_shape`.
        damped_w: damped angular frequency [rad/time]; negative of a conjugate.
        where: named in the message.

    Raises:
        ResourceError: modal A is zero, or does not fit to a real mode.

    Source: D. J. Ewins, Modal Testing, section 2.7 (viscous damping, general case).
    """
    mass = modal_a / factor**2 / (2j * damped_w)
    if mass.real <= 0.0 or abs(mass.imag) > _REAL * mass.real:
        raise ResourceError(
            f"{where}: modal A = {modal_a:.4g} gives no positive modal mass; scale the modes"
        )
    return mass.real


def check_modal_mass(mass: float, where: object) -> float:
    """A positive modal mass; raises ResourceError for an unscaled mode."""
    if not 0.0 < mass < math.inf:
        raise ResourceError(
            f"{where}: modal mass {mass:g}; the mode has no scale (as from operational modal "
            "analysis) and cannot be used"
        )
    return mass


def housing_from_modes(modes: ModeSet, seats: SeatFile) -> ModalHousing:
    """Take the mean motion of the seats' and sensors' nodes, in SI units and the gearbox frame.

    Raises:
        ResourceError: a node is missing, has no shape in a mode, a mode stands twice, or has a
            negative stiffness.
    """
    _check_stiff(modes.frequency / seats.time, modes.source["file"])
    check_no_mode_twice(modes.frequency, modes.shapes, modes.source["file"])
    rows = {int(label): i for i, label in enumerate(modes.node)}
    points, shapes = [], []
    for selection in seats.selections:
        at = node_rows(rows, selection, seats)
        _check_complete(modes, at, selection, seats)
        position = selection.position or selection.weights @ modes.coordinates[at]
        points.append(make_point(selection, np.asarray(position), seats))
        mean = np.einsum("k,kan->an", selection.weights, modes.shapes[at])
        turned = seats.rotation @ mean / math.sqrt(seats.mass)
        shapes.append(turned[[AXES.index(dof) for dof in selection.dofs]])
    frequency_hz = modes.frequency / seats.time
    rigid = frequency_hz < _RIGID_HZ
    frequency_hz[rigid] = 0.0
    known = np.isfinite(modes.damping_ratio)
    order = np.argsort(frequency_hz, kind="stable")
    return ModalHousing(
        tuple("rigid" if rigid[i] else "normal" for i in order),
        frequency_hz[order],
        np.where(known, modes.damping_ratio, seats.damping_ratio)[order],
        tuple(points),
        np.concatenate(shapes)[:, order],
        seats.valid_to_hz,
        {
            "model": "viscous-modal",
            "source": "file" if known.all() else seats.damping_source,
        },
        seats.boundary,
        {**modes.source, **({"description": seats.source} if seats.source else {})},
        make_frame(seats),
    )


def _check_stiff(frequency_hz: np.ndarray, file: str) -> None:
    """Refuse a mode that would run away; taken as a rigid one, its stiffness would be zero."""
    lowest = int(np.argmin(frequency_hz))
    if frequency_hz[lowest] < -max(_RIGID_HZ, _ROUNDING * frequency_hz.max()):
        raise ResourceError(
            f"{file}: mode {lowest + 1} has the frequency {frequency_hz[lowest]:g} Hz, below zero: "
            "its stiffness is negative, as of a structure that has buckled under its preload"
        )


def _check_complete(modes: ModeSet, at: list[int], selection: Selection, seats: SeatFile) -> None:
    """Refuse a node without a shape: taken as motionless, it would make the seat too stiff."""
    for row in at:
        left_out = np.isnan(modes.shapes[row]).any(axis=0)
        if left_out.any():
            raise ResourceError(
                f"{seats.path}: {selection.role} {selection.name}: node {modes.node[row]} has no "
                f"shape in mode {int(np.argmax(left_out)) + 1} of {modes.source['file']}; export "
                "shapes at all nodes of seats and sensors"
            )


def node_rows(rows: Mapping[int, int], selection: Selection, seats: SeatFile) -> list[int]:
    """Row of each node of a selection; raises ResourceError if one is not there."""
    if missing := [n for n in selection.nodes if n not in rows]:
        raise ResourceError(
            f"{seats.path}: {selection.role} {selection.name}: the model has no node {missing[0]}"
        )
    return [rows[n] for n in selection.nodes]


def make_point(selection: Selection, position: np.ndarray, seats: SeatFile) -> Point:
    """A point in the gearbox frame, from a position in the file's coordinates and unit."""
    moved = seats.length * (seats.rotation @ (position - seats.origin))
    return Point(
        selection.name,
        selection.role,
        tuple(moved.tolist()),
        selection.dofs,
        selection.coupling,
    )


def make_frame(seats: SeatFile) -> Frame:
    """The frame of a seat file in SI units."""
    return Frame(
        tuple((seats.length * seats.origin).tolist()),
        tuple(tuple(row) for row in seats.rotation.tolist()),
    )
