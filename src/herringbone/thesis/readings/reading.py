"""A reading of the thesis: values of what it does not publish, and the system that has them."""

from dataclasses import dataclass, fields, replace
from functools import cache
from typing import Self

from herringbone.analysis.anatomy import value_at
from herringbone.core.declaring.roles import GEARS
from herringbone.cosim.structure.system import System
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.job import GearJob
from herringbone.running.loading import load_system
from herringbone.thesis.names import BEARINGS, GEAR, GEARBOX, RIG
from herringbone.thesis.names import HOUSING as BODY
from herringbone.thesis.pair.given import JOB

HOUSING, GROUND = "housing", "ground"
"""On what the bearings stand: the elastic housing of the test rig, or rigid ground."""
PARTS = {"still": (1.0, 0.0, 0.0), "mixed": (0.4, 0.3, 0.3), "turning": (0.0, 0.5, 0.5)}
"""Shares of the symmetry deviation that stand still, turn with the pinion, turn with the wheel."""


_METHOD, _SEED = "coupled-slices", 1
"""Of teeth that are not perfect: their force law without finite elements, and random numbers."""


@dataclass(frozen=True)
class Reading:
    """Values of what the thesis does not publish, SI units.

    Attributes:
        foundation: HOUSING or GROUND, as in the equations of its chapter 3.
        restraint: axial stiffness that holds the pinion against ground; 0: it floats.
        run_out: key of `PARTS`.
        stagger: right half ahead of the left one, mesh periods.
        deviation: symmetry deviation at which torque and speed are varied.
        thrust: axial stiffness of a bearing that holds the pinion in the housing, per half.
        damping: mesh damping ratio; the thesis' formula makes 0.035 of its 0.1.
        wheel_thrust: axial bearing stiffness of the wheel, per half.
        gear_ratio: torque at the pinion is the stated one over it: 3 if the wheel's is stated.
        phase: of the wheel's run-out [rad].
        bearing_damping: damping of the bearings over that which is shipped, 2 % of each.
        grade: ISO 1328-1 class of the teeth, 0 for perfect ones.
    """

    foundation: str = HOUSING
    restraint: float = 0.0
    run_out: str = "mixed"
    stagger: float = 0.0
    deviation: float = 10e-6
    thrust: float = 0.0
    damping: float = 0.1
    wheel_thrust: float = 2.03e8
    gear_ratio: float = 1.0
    phase: float = 1.0
    bearing_damping: float = 1.0
    grade: int = 0

    def but(self, **changes: float | str) -> Self:
        """The same with other values."""
        return replace(self, **changes)  # type: ignore[arg-type]

    def changes(self, other: "Reading") -> tuple[str, ...]:
        """Names of what differs from another reading."""
        return tuple(
            f.name for f in fields(self) if getattr(self, f.name) != getattr(other, f.name)
        )

    def system(self) -> System:
        """The system, without values."""
        return _system(self.foundation)

    def gear(self) -> GearJob | None:
        """The pair with its teeth; None: the shipped one, whose teeth are perfect."""
        if not self.grade:
            return None
        return replace(JOB, method=_METHOD, deviations=GivenDeviations(self.grade, _SEED))

    def values(self, deviation: float) -> dict[str, float]:
        """Values in the system at a symmetry deviation [m]."""
        constant, pinion, wheel = PARTS[self.run_out]
        return {
            f"{GEAR}.symmetry_deviation": deviation,
            f"{GEAR}.symmetry_constant": constant,
            f"{GEAR}.symmetry_pinion": pinion,
            f"{GEAR}.symmetry_wheel": wheel,
            f"{GEAR}.symmetry_wheel_phase": self.phase,
            f"{GEAR}.pinion_restraint": self.restraint,
            f"{GEAR}.stagger": self.stagger,
            f"{GEAR}.mesh_damping_ratio": self.damping,
            f"{BEARINGS}.pinion.axial_stiffness": self.thrust,
            f"{BEARINGS}.wheel.axial_stiffness": self.wheel_thrust,
            **{name: self.bearing_damping * shipped for name, shipped in _dampings().items()},
        }


@cache
def _dampings() -> dict[str, float]:
    """Of the bearings, as shipped."""
    system, _ = load_system(GEARBOX)
    names = (f"{BEARINGS}.{gear}.{way}_damping" for gear in GEARS for way in ("radial", "axial"))
    return {name: value_at(system, name) for name in names}


@cache
def _system(foundation: str) -> System:
    if foundation == HOUSING:
        return load_system(RIG)[0]
    return load_system(GEARBOX)[0].without(BODY)


AS_SHIPPED = Reading()
"""What the product assumes where the thesis says nothing."""
