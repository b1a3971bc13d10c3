"""All figures of a loaded pair under given conditions."""

from collections.abc import Sequence
from dataclasses import dataclass

from herringbone.core import ParameterError
from herringbone.core.declaring.units import RAD_S
from herringbone.gears.job import GearJob
from herringbone.gears.load.deviating_teeth import DeviatingLoad, deviating_load
from herringbone.gears.load.dynamic_factor import (
    DynamicFactor,
    dynamic_factor,
    effective_deviations,
)
from herringbone.gears.load.flank_load import FlankLoad, LoadedLines, flank_load
from herringbone.gears.load.loaded_pair import LoadedPair, Symmetry, loaded_pair, over_torque
from herringbone.gears.stiffness.load_sharing import check_held
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness

_USUAL_CLASS = 6
_FLANK_PHASES = 32
"""Phases of the load on the flanks; of all of them only some if there are more."""


@dataclass(frozen=True)
class Conditions:
    """Conditions of the load that are not in the gear file.

    Attributes:
        speed: of the pinion [rad/s].
        accuracy: ISO 1328-1 tolerance class; None: 6.
        load_factor: K_A.
        symmetry: deviation of a double-helical pair; None: none.
    """

    speed: float = 1000.0 * RAD_S
    accuracy: int | None = None
    load_factor: float = 1.0
    symmetry: Symmetry | None = None

    @property
    def grade(self) -> int:
        """Tolerance class, given or usual."""
        return _USUAL_CLASS if self.accuracy is None else self.accuracy


@dataclass(frozen=True)
class Loaded:
    """Figures of a loaded pair.

    Attributes:
        conditions: of the load.
        pair: at the job's torque.
        torques: the pair over the torques of its table.
        flanks: of the left and the right half, or of the only one.
        factor: N and K_v; or why not.
        teeth: of teeth that deviate; None: the job has none.
    """

    conditions: Conditions
    pair: LoadedPair
    torques: Sequence[LoadedPair]
    flanks: tuple[FlankLoad, ...]
    factor: DynamicFactor | str
    teeth: DeviatingLoad | None = None


def check_conditions(job: GearJob, conditions: Conditions) -> None:
    """Check conditions before anything long is computed; raises ParameterError."""
    job.task()
    _dynamic_factor(job, conditions)
    if (symmetry := conditions.symmetry) is not None:
        check_held(
            job.pair,
            job.pinion_torque,
            symmetry.pinion_axial_stiffness,
            symmetry.wheel_axial_stiffness,
        )


def loaded_figures(
    job: GearJob, mesh: LoadedLines, stiffness: MeshStiffness, conditions: Conditions
) -> Loaded:
    """Figures of a job's pair.

    Args:
        job: pair, torque, modification.
        mesh: of the pair.
        stiffness: of the mesh at loads from zero, at as many phases as the curves shall have.
        conditions: of the load.

    Raises:
        ParameterError: see `loaded_pair`, `dynamic_factor`; or an accuracy class is given and no
            tolerance follows from it.
    """
    at_load = loaded_pair(stiffness, job.pinion_torque, conditions.symmetry)
    unequal = at_load.halves if conditions.symmetry else at_load.halves[:1]
    every = max(1, stiffness.phases.size // _FLANK_PHASES)
    flanks = tuple(
        flank_load(mesh, job.pair, half.phases[::every], half.force[::every]) for half in unequal
    )
    return Loaded(
        conditions,
        at_load,
        over_torque(stiffness, conditions.symmetry),
        flanks if conditions.symmetry else flanks * job.pair.halves,
        _dynamic_factor(job, conditions),
        deviating_load(job, job.deviations) if job.deviations else None,
    )


def _dynamic_factor(job: GearJob, conditions: Conditions) -> DynamicFactor | str:
    try:
        deviations = effective_deviations(
            job.pair, conditions.grade, min(job.modification.tip_relief)
        )
    except ParameterError as error:
        if conditions.accuracy is not None:
            raise
        return str(error)
    return dynamic_factor(
        job.pair,
        job.pinion_torque,
        conditions.speed,
        deviations,
        load_factor=conditions.load_factor,
    )
