"""The error of a run by another one with half the macro step and half the inner steps.

Where the error falls with the power p of the step, the difference d of both runs is the error of
the first one less that of the second, which is 2^p times smaller: d / (1 - 2^-p). 4/3 d is taken,
which is right for p = 2, too small by a third for p = 1, and too large for more. What both runs
have in common, such as an FMU's own integration, does not show.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.core import ParameterError
from herringbone.core.roles import Quantity
from herringbone.cosim.algorithms import AUTO, Algorithm
from herringbone.cosim.structure.system import System
from herringbone.result.result import TIME, Result
from herringbone.result.verification import Verification
from herringbone.running.coupled import Asked, Coupled, coupled
from herringbone.running.progress import Progress
from herringbone.running.run_result import with_coupling_row
from herringbone.scenes import Scene

_WHOLE = 4.0 / 3.0
_CONSTANT = 1e-9
"""Alternating part over the size of a channel below which it is rounding."""
_ALL = "outputs"


def check_fixed_step(algorithm: Algorithm | None, tolerance: float | None) -> None:
    """Check, before anything runs, that a step can be halved.

    Args:
        algorithm: that was asked for; None: chosen by what the parts are.
        tolerance: that was asked for.

    Raises:
        ParameterError: the step adapts itself.
    """
    if tolerance is not None or (algorithm is not None and algorithm.adaptive):
        raise ParameterError(
            f"verify: {algorithm or AUTO} adapts its step to the tolerance; give a fixed --step"
        )


def verified(
    result: Result,
    system: System,
    scene: Scene,
    found: Coupled,
    asked: Asked,
    progress: bool | Progress,
) -> Result:
    """The result with its error by half the step.

    Args:
        result: of the run.
        system, scene: of the run.
        found: the run.
        asked: how it was asked for.
        progress: see `api.run`.

    Raises:
        HerringboneError: see `coupled`.
    """
    step = 0.5 * found.recording.step
    finer = coupled(
        with_half_inner_steps(system),
        scene,
        replace(asked, algorithm=found.algorithm, step=step, all_points=False, notes=()),
        progress,
    ).result
    return with_coupling_row(replace(result, verification=compared_with(result, finer.data, step)))


def with_half_inner_steps(system: System) -> System:
    """The system, with half the inner step of each part that has one to set."""
    known = anatomy(system)
    paths = [known.column(part, Quantity.MICRO_STEP) for part in known.parts]
    own = [path for path in paths if path and not system.part(system.split(path)[0]).foreign]
    return system.with_values({path: 0.5 * value_at(system, path) for path in own})


def compared_with(result: Result, finer: pd.DataFrame, step: float) -> Verification:
    """What separates a result from a finer one, at the records of both.

    Args:
        result: of the run.
        finer: data of the run with half the step.
        step: of that run [s].
    """
    groups: Mapping[str, list[str]] = {n: result.channel(n) for n in result.channels}
    groups = groups or {_ALL: result.signals}
    ours, theirs = _common(result.data, finer)
    pooled = {
        name: _WHOLE * relative_error(ours[names].to_numpy(), theirs[names].to_numpy())
        for name, names in groups.items()
        if names and len(ours) > 1
    }
    worst, value = "", 0.0
    for column in [c for names in groups.values() for c in names]:
        true = theirs[column].to_numpy()
        if np.std(true) <= _CONSTANT * np.abs(true).max(initial=0.0):
            continue
        error = _WHOLE * relative_error(ours[[column]].to_numpy(), true[:, None])
        if error > value:
            worst, value = column, error
    return Verification(pooled, worst, value, step)


def _common(ours: pd.DataFrame, theirs: pd.DataFrame) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Rows of both at the times that both have."""
    first, second = ours[TIME].to_numpy(), theirs[TIME].to_numpy()
    near = np.clip(np.searchsorted(second, first), 1, max(1, second.size - 1))
    near = np.where(np.abs(second[near - 1] - first) < np.abs(second[near] - first), near - 1, near)
    same = np.abs(second[near] - first) <= 1e-9 * max(1.0, float(first[-1]))
    return ours[same].reset_index(drop=True), theirs.iloc[near[same]].reset_index(drop=True)
