"""Finite-element model of the welded housing: matrices, seats, sensors, surface, plates.

The faces of the bolt holes are held. A seat's force is a uniform traction over the bore, its motion
the area mean over the bore: one is the transpose of the other, so the seats are reciprocal and
passive. Were the traction spread over 120 degrees of the default housing's bores only, they would
be up to some 13 % softer radially.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from herringbone.core import HerringboneError
from herringbone.core.declaring.roles import HALVES
from herringbone.housing.modal_model import Point
from herringbone.housing.welded.design import HousingDesign, Sensors
from herringbone.housing.welded.dimensions import Dimensions
from herringbone.housing.welded.elasticity import Solid
from herringbone.housing.welded.mesher import Mesh

SENSORS = ("A", "B", "C")
_SENSOR_STEP_DEG = 90.0
_ON_FACE = 1e-7
"""Corners closer to a face than this [m] lie on it."""
_BEHIND = 1.0 - 1e-8
"""z of a point some nm behind a boss face, over that of the face."""
PLATES = (
    "base plate", "feet", "floor", "side walls", "end walls", "cover", "flange", "bosses and ribs",
)  # fmt: skip


@dataclass(frozen=True)
class _Seat:
    """A bore: its point, and the weights (n,) of the nodes in its area mean."""

    point: Point
    weights: np.ndarray


class FiniteElements:
    """Finite-element model of a housing; unknowns are the free ones of `Solid`.

    Attributes:
        solid: all elements.
        free: indices of the free unknowns (f,).
        stiffness, mass: (f, f) [N/m], [kg].
        seat_input: (f, 12) nodal forces of unit resultants, by seat and axis; its transpose takes
            displacements to the motions of the seats.
    """

    def __init__(self, design: HousingDesign, mesh: Mesh) -> None:
        """Assemble."""
        self._dimensions, self._sensors = design.dimensions, design.sensors
        self.solid = Solid(mesh, design.material)
        facets = self.solid.boundary()
        self._facets, self._corners = facets, self.solid.corners(facets)
        held = self.solid.nodes_on(self._facets_where(self._on_bolts))
        count = len(self.solid.nodes)
        free = np.setdiff1d(np.arange(count), held)
        self.free = np.concatenate([axis * count + free for axis in range(3)])
        self.stiffness = self._of_free(self.solid.stiffness())
        self.mass = self._of_free(self.solid.mass())
        self._seats = [self._seat(half) for half in HALVES]
        eye = np.eye(3)
        columns = [np.kron(eye[axis], s.weights) for s in self._seats for axis in range(3)]
        self.seat_input = np.array(columns).T[self.free]

    @property
    def total_mass(self) -> float:
        """[kg]."""
        return self.solid.volume * self.solid.material.density

    @property
    def points(self) -> tuple[Point, ...]:
        """The four seats and the sensors."""
        positions = sensor_positions(self._dimensions, self._sensors)
        sensors = [
            Point(name, "sensor", (x, y, z), coupling="node")
            for name, (x, y, z) in zip(SENSORS, positions.tolist(), strict=True)
        ]
        return (*(seat.point for seat in self._seats), *sensors)

    def sensor_output(self) -> sp.csr_array:
        """Displacements (9, f) of the sensors, by sensor and axis.

        Raises:
            HerringboneError: one lies outside of the mesh.
        """
        positions = sensor_positions(self._dimensions, self._sensors)
        try:
            by_axis = self.solid.interpolation(positions)
        except ValueError:  # by rounding they may lie before the face
            by_axis = self._interpolation_behind(positions)
        rows = np.arange(3 * len(SENSORS)).reshape(3, len(SENSORS)).T.ravel()
        return by_axis[rows][:, self.free]

    def _interpolation_behind(self, positions: np.ndarray) -> sp.csr_array:
        try:
            return self.solid.interpolation(positions * (1.0, 1.0, _BEHIND))
        except ValueError as error:
            raise HerringboneError(
                f"a sensor on the boss face lies outside of the mesh: boss_wall = "
                f"{1e3 * self._dimensions.boss_wall:g} mm is too thin for its edges around the "
                "boss; take a smaller mesh size or a thicker boss_wall"
            ) from error

    def radiating_form(self) -> sp.csr_array:
        """Form (f, f) of the outer surface: integral of the products of normal components [m2]."""
        return self._of_free(self.solid.normal_form(self.radiating_facets))

    @cached_property
    def radiating_facets(self) -> np.ndarray:
        """The outer surface: without the cavity, bores, bolt holes and the base's underside."""
        inner = self._on_cavity | self._on_bolts | self._on_underside
        for gear in self._dimensions.bores:
            inner |= self._on_bore(gear)
        return self._facets[~inner.all(axis=1)]

    def full(self, shapes: np.ndarray) -> np.ndarray:
        """Displacements (3 n, m) of all nodes from those of the free unknowns (f, m)."""
        found = np.zeros((3 * len(self.solid.nodes), shapes.shape[1]))
        found[self.free] = shapes
        return found

    def plates(self) -> dict[str, np.ndarray]:
        """Elements by the plate in which their middle lies."""
        middles = self.solid.mesh.p.T[self.solid.mesh.t.T].mean(axis=1)
        names = plate_of(self._dimensions, middles)
        return {name: np.flatnonzero(names == k) for k, name in enumerate(PLATES)}

    def _of_free(self, matrix: sp.csr_array) -> sp.csr_array:
        return matrix[self.free][:, self.free]

    def _facets_where(self, corners: np.ndarray) -> np.ndarray:
        return self._facets[corners.all(axis=1)]

    def _seat(self, half: str) -> _Seat:
        gear, side = half.split("_")
        z = self._corners[..., 2]
        facets = self._facets_where(self._on_bore(gear) & ((z > 0) == (side == "left")))
        if not facets.size:
            raise HerringboneError(f"the mesh has no faces on the bore {half}: take a smaller size")
        d = self._dimensions
        middle = (d.inner_width + d.side_wall + d.boss_length) / 2
        position = (d.bores[gear][0], 0.0, middle if side == "left" else -middle)
        point = Point(half, "seat", position, area=self.solid.area(facets))
        return _Seat(point, self.solid.mean_weights(facets))

    def _on_bore(self, gear: str) -> np.ndarray:
        x, diameter = self._dimensions.bores[gear]
        return self._on_cylinder(0, 1, x, 0.0, diameter)

    @cached_property
    def _on_bolts(self) -> np.ndarray:
        found = np.zeros(self._corners.shape[:2], dtype=bool)
        for x, z in self._dimensions.bolts:
            found |= self._on_cylinder(0, 2, x, z, self._dimensions.bolt_diameter)
        return found

    @property
    def _on_underside(self) -> np.ndarray:
        bottom = self._dimensions.base_top - self._dimensions.base_plate
        return np.abs(self._corners[..., 1] - bottom) < _ON_FACE

    @property
    def _on_cavity(self) -> np.ndarray:
        """Corners in or on the hollow box."""
        d = self._dimensions
        low = np.array([d.box_x[0] + d.end_wall, -d.axis_height, -d.inner_width / 2])
        high = np.array([d.box_x[1] - d.end_wall, d.cover_height, d.inner_width / 2])
        inside = (self._corners > low - _ON_FACE) & (self._corners < high + _ON_FACE)
        return np.all(inside, axis=2)

    def _on_cylinder(self, a: int, b: int, at_a: float, at_b: float, diameter: float) -> np.ndarray:
        radius = np.hypot(self._corners[..., a] - at_a, self._corners[..., b] - at_b)
        return np.abs(radius - diameter / 2) < _ON_FACE


def sensor_positions(d: Dimensions, sensors: Sensors) -> np.ndarray:
    """Positions (3, 3) [m] of A, B, C on the boss face, in the middle of the boss wall."""
    side = 1 if sensors.end == "left" else -1
    radius = d.pinion_bore / 2 + d.boss_wall / 2
    angles = [
        math.radians(sensors.zero_deg + _SENSOR_STEP_DEG * k) for k in range(1, len(SENSORS) + 1)
    ]
    z = side * (d.half_width + d.boss_length)
    return np.array([[radius * math.cos(a), radius * math.sin(a), z] for a in angles])


def plate_of(d: Dimensions, points: np.ndarray) -> np.ndarray:
    """Index in `PLATES` (p,) of the plate in which points (p, 3) [m] lie."""
    x, y, z = points[:, 0], points[:, 1], np.abs(points[:, 2])
    in_x = (x > d.box_x[0]) & (x < d.box_x[1])
    in_box = in_x & (z < d.half_width)
    radii = [np.hypot(x - at, y) - bore / 2 - d.boss_wall for at, bore in d.bores.values()]
    boss = (np.minimum(*radii) < 0) & (z > d.inner_width / 2)
    end = (x < d.box_x[0] + d.end_wall) | (x > d.box_x[1] - d.end_wall)
    floor_bottom = -d.axis_height - d.floor
    tests = {
        "base plate": y < d.base_top,
        "feet": y < floor_bottom,
        "floor": y < -d.axis_height,
        "bosses and ribs": boss,
        "flange": (np.abs(y) < d.flange_thickness) & ~in_box,
        "cover": in_box & (y > d.cover_height),
        "end walls": in_box & end,
        "side walls": in_box,
    }
    otherwise = PLATES.index("bosses and ribs")  # what sticks out of the side walls: ribs
    return np.select(list(tests.values()), [PLATES.index(name) for name in tests], otherwise)
