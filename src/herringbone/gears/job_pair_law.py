"""The force law of one pair of teeth of a job: out of the cache, or computed and put there."""

from dataclasses import replace

import numpy as np

from herringbone.core.process.activity import activity
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.finite_elements import FiniteElementMesh
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.stiffness.methods import METHODS, chosen_method
from herringbone.gears.stiffness.pair_law import PairLaw, pair_law
from herringbone.gears.stiffness.point_mesh import silent
from herringbone.gears.stiffness.slices import SliceMesh
from herringbone.gears.stored import Arrays, content_key, stored_arrays

_POINTS = 60
"""Points across the face; the mean stiffness of a line is within 0.01 % of that of many."""
_SHARE = 0.2
"""D over the deflection at the largest load of the stiffness table."""


def pair_law_for(job: GearJob) -> PairLaw:
    """Law of one pair of teeth, by the method of the job.

    Args:
        job: pair, modification, load and table.

    Raises:
        ParameterError, ResourceError: see `stiffness_for`.
    """
    unit = _SHARE * float(stiffness_for(job).deflection[-1].min())
    name, task = chosen_method(job.method), job.task()
    chosen = METHODS[name]

    def make() -> Arrays:
        what = f"making the force law of a pair of teeth by {chosen.title}"
        with (
            activity(what, "once for each pair", takes=chosen.takes),
            one_blas_thread(),
        ):
            mesh = chosen.mesh(task, silent)
            if isinstance(mesh, SliceMesh | FiniteElementMesh):  # coupled ones know what they need
                mesh = replace(mesh, slices=_POINTS)
            law = pair_law(mesh, unit)
        numbers = np.array([law.per_period, law.first])
        return {"method": np.array(law.method), "nodes": numbers, "stiffness": law.stiffness}

    calibration = task.calibration_of(name) if chosen.calibrated else None
    key = content_key(
        __name__, name, job.pair, job.modification, calibration, job.corner_contact, unit
    )
    arrays = stored_arrays("pair_laws", key, make)
    per_period, first = (int(number) for number in arrays["nodes"])
    return PairLaw(job.pair, str(arrays["method"]), per_period, first, unit, arrays["stiffness"])
