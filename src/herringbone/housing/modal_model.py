"""Modal model of a housing: oscillators with shapes at bearing seats and sensors."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from herringbone.core.declaring.roles import HALVES
from herringbone.core.facts import Facts

AXES = ("x", "y", "z")
SEAT_DOFS = tuple((seat, axis) for seat in HALVES for axis in AXES)
"""The 12 directions in which bearings act: (seat, axis)."""


@dataclass(frozen=True)
class Point:
    """A named place of the housing.

    Attributes:
        name: a seat by its fixed name (pinion_left, ...), or a sensor (A, B, C).
        role: "seat" or "sensor".
        position: in the gearbox frame [m].
        dofs: directions in which shapes are given.
        coupling: how the motion is taken: rbe3 (area mean), rbe2 (rigid) or node.
        area: of the face that it stands for [m2]; 0 if unknown.
    """

    name: str
    role: str
    position: tuple[float, float, float]
    dofs: tuple[str, ...] = AXES
    coupling: str = "rbe3"
    area: float = 0.0


@dataclass(frozen=True)
class Frame:
    """Where the gearbox frame lies in the coordinates of the source.

    Attributes:
        origin: of the gearbox frame, in the source's coordinates [m].
        rotation: rows are the gearbox axes x, y, z in the source's coordinates.
    """

    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[tuple[float, float, float], ...] = (
        (1.0, 0.0, 0.0),
        (0.0, 1.0, 0.0),
        (0.0, 0.0, 1.0),
    )


@dataclass(frozen=True, eq=False, repr=False)
class ModalHousing(Facts):
    """A housing as n oscillators; d directions at its points. SI units, gearbox frame.

    Attributes:
        kind: of each oscillator: "normal", "residual" (pseudo mode) or "rigid".
        frequency_hz: (n,) [Hz].
        damping_ratio: (n,) [1].
        points: seats and sensors.
        shapes: (d, n), mass-normalised [kg^-1/2]; rows as `dofs`.
        valid_to_hz: up to where the receptance at the seats is good [Hz].
        damping: model and source of the damping.
        boundary: how the housing is held.
        source: what made the data, such as tool, mesh, date.
        frame: of the gearbox in the source's coordinates.
        static: (12, 12) static compliance at the seats [m/N], for the check; or None.
        residual: (12, 12) compliance that the modes miss [m/N], from tests; or None.
        gram: (n, n) integral of the shapes' normal parts over the surface [kg^-1 m2]; or None.
        certificate: what a reduction has certified.
    """

    kind: tuple[str, ...]
    frequency_hz: np.ndarray
    damping_ratio: np.ndarray
    points: tuple[Point, ...]
    shapes: np.ndarray
    valid_to_hz: float
    damping: Mapping[str, Any]
    boundary: str = ""
    source: Mapping[str, Any] = field(default_factory=dict)
    frame: Frame = field(default_factory=Frame)
    static: np.ndarray | None = None
    residual: np.ndarray | None = None
    gram: np.ndarray | None = None
    certificate: Mapping[str, Any] = field(default_factory=dict)

    @property
    def dofs(self) -> tuple[tuple[str, str], ...]:
        """(point, direction) of each row of the shapes."""
        return tuple((point.name, dof) for point in self.points for dof in point.dofs)

    @property
    def seats(self) -> tuple[str, ...]:
        """Names of the bearing seats."""
        return tuple(point.name for point in self.points if point.role == "seat")

    @property
    def seat_shapes(self) -> np.ndarray:
        """(12, n) shapes at the seats, in the order of `SEAT_DOFS` [kg^-1/2]."""
        dofs = self.dofs
        return self.shapes[[dofs.index(dof) for dof in SEAT_DOFS]]

    def shape(self, point: str, dof: str) -> np.ndarray:
        """(n,) shapes at one point in one direction [kg^-1/2]."""
        return self.shapes[self.dofs.index((point, dof))]

    def static_compliance(self) -> np.ndarray:
        """(12, 12) compliance of the oscillators at the seats at 0 Hz [m/N]; without rigid ones."""
        elastic = self.frequency_hz > 0.0
        scaled = self.seat_shapes[:, elastic] / (2.0 * math.pi * self.frequency_hz[elastic])
        return scaled @ scaled.T

    def receptance(self, frequency_hz: np.ndarray) -> np.ndarray:
        """(f, 12, 12) displacement over force at the seats [m/N], complex.

        Source: D. J. Ewins, Modal Testing, section 2.4 (viscous modal damping).
        """
        w = 2.0 * math.pi * np.asarray(frequency_hz)[:, None]
        w_mode = 2.0 * math.pi * self.frequency_hz
        stiffness = w_mode**2 - w**2 + 2j * self.damping_ratio * w_mode * w
        return np.einsum("ik,fk,jk->fij", self.seat_shapes, 1.0 / stiffness, self.seat_shapes)

    def _facts(self) -> dict[str, str]:
        kinds = ", ".join(f"{self.kind.count(kind)} {kind}" for kind in dict.fromkeys(self.kind))
        elastic = self.frequency_hz[self.frequency_hz > 0.0]
        sensors = [point.name for point in self.points if point.role == "sensor"]
        return {
            "oscillators": kinds,
            "frequencies": f"{elastic.min():.4g} to {elastic.max():.4g} Hz" if elastic.size else "",
            "valid to": f"{self.valid_to_hz:.4g} Hz",
            "seats": ", ".join(self.seats),
            "sensors": ", ".join(sensors),
            "held": self.boundary,
            "source": ", ".join(f"{k} {v}" for k, v in self.source.items()),
        }
