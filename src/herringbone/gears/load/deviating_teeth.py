"""Transmission error and load of a pair whose teeth deviate, over a turn of the wheel.

Each half carries half of the load. The model is that of coupled slices, whatever the method of the
job's table: finite elements would take minutes for hundreds of phases.
"""

import math
from dataclasses import dataclass

import numpy as np

from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.job import GearJob
from herringbone.gears.load.flank_load import contact_pressure
from herringbone.gears.stiffness.coupled_slices import CoupledSliceMesh
from herringbone.gears.stiffness.deviating_teeth import DeviatingTeeth

_PHASES = 4
"""Phases of a mesh period."""


@dataclass(frozen=True)
class DeviatingLoad:
    """Figures of teeth that deviate, of each half.

    Attributes:
        deviations: of the teeth.
        phases: (n,) over a turn of the wheel [mesh periods].
        transmission_error: (halves, n) on the transverse line of action [m].
        largest_line_load: (halves,) of all points and phases [N/m].
        largest_pressure: (halves,) of all points and phases [Pa].
    """

    deviations: GivenDeviations
    phases: np.ndarray
    transmission_error: np.ndarray
    largest_line_load: np.ndarray
    largest_pressure: np.ndarray


def deviating_load(job: GearJob, deviations: GivenDeviations) -> DeviatingLoad:
    """Figures of a job's pair at its torque.

    Raises:
        ParameterError, ResourceError: see `GivenDeviations.of_halves`; or the load is too large.
    """
    pair = job.pair
    mesh = CoupledSliceMesh(
        pair,
        job.modification,
        calibration=job.task().calibration_of("coupled-slices"),
        corner_contact=job.corner_contact,
    )
    phases = np.arange(_PHASES * pair.number_of_teeth[1]) / _PHASES
    force, normal = pair.tooth_forces(job.pinion_torque).normal, math.cos(pair.base_helix_angle)
    errors, loads, pressures = [], [], []
    with one_blas_thread():
        for half in deviations.of_halves(pair)[: pair.halves]:
            teeth = DeviatingTeeth(mesh, half)
            errors.append(teeth.deflections(phases, force) / normal)
            lines = [teeth.line_load(phase, force) for phase in phases.tolist()]
            path, load = (
                np.concatenate([getattr(at, n) for at in lines]) for n in ("path", "load")
            )
            loads.append(load.max())
            pressures.append(contact_pressure(pair, path, load).max())
    return DeviatingLoad(deviations, phases, np.array(errors), np.array(loads), np.array(pressures))
