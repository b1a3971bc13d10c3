"""What is asked about a pair: its gears, modification, load, and how the table is made."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from herringbone.core import ParameterError
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.geometry.modification import Modification
from herringbone.gears.mesh_assumptions import MeshAssumptions
from herringbone.gears.stiffness.calibration import full_torque
from herringbone.gears.stiffness.contact_slices import SLICES
from herringbone.gears.stiffness.methods import (
    AUTO,
    METHODS,
    Task,
    check_calibration,
    chosen_method,
)
from herringbone.gears.stiffness.slices import PHASES

OVERLOAD = 25.0
"""Largest load of a table over that of the torque."""
_SHARES = (0.0, 0.001, 0.004, 0.01, 0.02, 0.04, 0.08, 0.2, 0.4, 1.0)
"""Loads of a table over its largest."""


@dataclass(frozen=True)
class GearJob:
    """A pair and what to compute.

    Attributes:
        pair: gear pair.
        modification: of its flanks.
        torque: of the pinion [N m]; None: at 100 N/mm of tangential load per face width.
        loads: normal forces of one half [N]; None: ten from zero to 25 times that of the torque.
        phases: of the table.
        method: of the mesh stiffness: "fe", "coupled-slices", "slices"; "auto": the best there is.
        calibration: factors on the compliance of the teeth, by slice method; of one that is not
            named: its own, see `stiffness.calibration`.
        slices: across the face, of the slice method.
        corner_contact: follow tip corners outside the path of contact.
        mesh: what geometry does not tell, see `MeshAssumptions`; no table depends on it.
        deviations: of the teeth, for runs; None: perfect teeth. No table depends on them.
        unread: lines on what its file has and this does not, or the other way round.
    """

    pair: GearPair
    modification: Modification = field(default_factory=Modification)
    torque: float | None = None
    loads: Sequence[float] | None = None
    phases: int = PHASES
    method: str = AUTO
    calibration: Mapping[str, float] = field(default_factory=dict)
    slices: int = SLICES
    corner_contact: bool = False
    mesh: MeshAssumptions = field(default_factory=MeshAssumptions)
    deviations: GivenDeviations | None = None
    unread: tuple[str, ...] = ()

    @property
    def pinion_torque(self) -> float:
        """Torque of the pinion [N m], given or by the specific load."""
        if self.torque is not None:
            return self.torque
        return full_torque(self.pair)

    def unused(self, method: str | None = None) -> tuple[str, ...]:
        """Lines on what is given for another method than that of the table; the job's if None."""
        name = chosen_method(self.method if method is None else method)
        if self.slices == SLICES or name == "slices":
            return ()
        title = METHODS[name].title
        return (f"slices = {self.slices} is of the method 'slices'; the table is made by {title}",)

    def task(self) -> Task:
        """The task of a method.

        Raises:
            ParameterError: torque not positive; loads that do not begin at zero, or do not reach
                the load of the torque; too few phases; a calibration of no method.
        """
        check_calibration(self.calibration)
        if not self.pinion_torque > 0.0:
            raise ParameterError(f"torque {self.pinion_torque:g} N m must be positive")
        if not 4 <= self.slices <= 1000:
            raise ParameterError(f"slices = {self.slices} must lie between 4 and 1000")
        if not 4 <= self.phases <= 128:
            raise ParameterError(f"phases = {self.phases} must lie between 4 and 128")
        needed = self.pair.tooth_forces(self.pinion_torque).normal
        loads = self.loads
        if loads is None:
            loads = [share * OVERLOAD * needed for share in _SHARES]
        if len(loads) < 2 or loads[0] != 0.0:
            raise ParameterError(
                "loads of the stiffness table must begin with zero and go on, in N per half; "
                f"they begin with {loads[0] if loads else 'nothing'}"
            )
        if loads[-1] < needed:
            raise ParameterError(
                f"largest load {loads[-1]:g} N of the stiffness table is below the {needed:.6g} N "
                f"per half of {self.pinion_torque:g} N m; give larger loads or none"
            )
        return Task(
            self.pair,
            loads,
            self.modification,
            self.phases,
            self.calibration,
            self.slices,
            self.corner_contact,
        )
