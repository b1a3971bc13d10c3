"""The stiffness table of a job: out of the cache, or computed and put there."""

import logging
from functools import cache

import numpy as np

from herringbone.core import ParameterError
from herringbone.core.process.activity import activity
from herringbone.gears.job import GearJob
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness, Uncertainty
from herringbone.gears.stiffness.methods import (
    AUTO,
    METHODS,
    Accuracy,
    Task,
    accuracy_of,
    chosen_method,
    has_finite_elements,
    mesh_stiffness,
)
from herringbone.gears.stiffness.point_mesh import Progress
from herringbone.gears.stored import Arrays, content_key, stored_arrays

_LOG = logging.getLogger("herringbone")
_ARRAYS = ("loads", "phases", "deflection", "tangent", "zero_load_secant")
_BOUNDS = ("mean", "harmonics")


@cache
def _tell_missing(pinion_teeth: int, wheel_teeth: int, title: str, accuracy: Accuracy) -> None:
    """Say once for each pair of teeth what is taken without the best method."""
    _LOG.warning(
        "the stiffness table of z %d/%d is made by %s, its mean within %g %% and its harmonics "
        "within %g %%, because the extra 'fe' is missing: pip install 'herringbone[fe]'",
        pinion_teeth,
        wheel_teeth,
        title,
        100.0 * accuracy.mean,
        100.0 * accuracy.share,
    )


def stiffness_for(
    job: GearJob, method: str | None = None, progress: Progress | None = None
) -> MeshStiffness:
    """Mesh stiffness of one half of a pair, as a job asks for it.

    A line says what takes long, and what is missing for the best method.

    Args:
        job: pair, modification, load and table.
        method: other than the job's.
        progress: called with what is done and the share of the work, 0 to 1.

    Raises:
        ParameterError: see `GearJob.task` and the method.
        ResourceError: the cache folder cannot be made.
    """
    asked = job.method if method is None else method
    name, task = chosen_method(asked), job.task()
    chosen = METHODS[name]
    if asked == AUTO and name != "fe":
        _tell_missing(*job.pair.number_of_teeth, chosen.title, accuracy_of(name, job.pair))

    def make() -> Arrays:
        if name == "fe" and not has_finite_elements():
            raise ParameterError(
                "the method 'fe' takes the extra of that name, which is missing: pip install "
                "'herringbone[fe]', or take the method 'auto', which does without"
            )
        what = f"making the stiffness table by {chosen.title}"
        with activity(what, "once for each pair and load", takes=chosen.takes):
            found = mesh_stiffness(task, name, progress)
        return {
            "method": np.array(found.method),
            **{name: getattr(found, name) for name in _ARRAYS},
            **{name: np.asarray(getattr(found.uncertainty, name)) for name in _BOUNDS},
        }

    arrays = stored_arrays("mesh_stiffness", _key(task, name), make)
    return MeshStiffness(
        job.pair,
        job.modification,
        str(arrays["method"]),
        uncertainty=Uncertainty(float(arrays["mean"]), arrays["harmonics"]),
        **{name: arrays[name] for name in _ARRAYS},
    )


def _key(task: Task, method: str) -> str:
    calibration = task.calibration_of(method) if METHODS[method].calibrated else None
    return content_key(
        "herringbone.gears.stiffness.methods",
        method,
        task.pair,
        [float(load) for load in task.loads],
        task.modification,
        task.phases,
        calibration,
        task.slices,
        task.corner_contact,
    )
