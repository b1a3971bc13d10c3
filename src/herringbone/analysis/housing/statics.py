"""The static compliance of a housing from step responses, told apart from slow vibration.

Under a Hann window the mean of a step response is free of vibration of more than two periods. A
housing on soft mounts has fewer in the usual time: where the test does not hold, single forces are
applied for longer. Vibration drops out then; what drifts goes on.
"""

import numpy as np

from herringbone.analysis.finding import Finding, judged, remark
from herringbone.analysis.housing.runs import FORCES, Runs
from herringbone.core.wording import percent

_ERROR = 0.02
_ROUNDING = 1e-9
_TEST = "static compliance"
_LONGER = 4, 16
"""Lengths of further responses, over that of the first."""
_FALLEN = 0.5
"""Share of the first difference that slow vibration leaves at most: a drift as of a damper leaves
all, one that begins as that of a mass two thirds."""


def mean_response(responses: np.ndarray) -> np.ndarray:
    """Mean over time (..., n, 12) -> (..., 12) under a Hann window."""
    window = np.hanning(responses.shape[-2])
    return np.einsum("n,...ns->...s", window / window.sum(), responses)


def judge_statics(
    runs: Runs, responses: np.ndarray, force: float, static: np.ndarray | None
) -> Finding:
    """The mean of the step responses, against what is known or their mean later on.

    Args:
        runs: of the housing, for longer responses.
        responses: (12, n + 1, 12) positions after a step of 1 N at each force [m].
        force: of longer responses [N].
        static: (12, 12) compliance that it should be [m/N], if it is known.

    Raises:
        Refused: a longer run breaks off.
    """
    found = mean_response(responses)
    reference = _reference(responses, static)
    size = float(np.abs(reference).max())
    errors = np.abs(found - reference).max(axis=1) / size
    lowest, *_, highest = np.linalg.eigvalsh((found + found.T) / 2.0)
    positive = highest > 0.0 and lowest >= -_ROUNDING * highest  # directions may be rigid
    sign = "" if positive else ", not positive" if highest > 0.0 else ", forces backwards"
    what, limit = "drifts by" if static is None else "off by", f"{100 * _ERROR:g} %, positive"
    shown = f"{what} {percent(errors.max())}{sign}"
    if not positive or errors.max() <= _ERROR:
        return judged(_TEST, positive, shown, limit)
    left, steps = 0.0, responses.shape[1] - 1
    for at in np.argsort(-errors)[: np.count_nonzero(errors > _ERROR)]:
        row = None if static is None else static[at]
        error, taken = _over_longer(runs, int(at), force, responses.shape[1] - 1, row, size)
        if error > max(_ERROR, _FALLEN * errors[at]):
            return judged(_TEST, False, shown, limit)
        left, steps = max(left, error), max(steps, taken)
    shown = f"{what} {percent(left)} in {1e3 * steps * runs.step:.3g} ms"
    if left > _ERROR:
        return remark(_TEST, f"slow vibration: {shown}, which are too short to tell", limit)
    return judged(_TEST, True, shown, limit)


def _over_longer(
    runs: Runs, at: int, force: float, steps: int, static: np.ndarray | None, size: float
) -> tuple[float, int]:
    """Difference in the longest response to one force that is needed and allowed, and its steps.

    Infinite if no longer response is allowed.
    """
    error, taken = np.inf, steps
    for factor in _LONGER:
        forces = np.zeros((factor * steps, len(FORCES)))
        forces[:, at] = force
        if not runs.allows(len(forces)):
            break
        response = runs.positions(forces) / force
        reference = _reference(response, static)
        apart = float(np.abs(mean_response(response) - reference).max())
        error, taken = apart / max(size, float(np.abs(reference).max())), len(forces)
        if error <= _ERROR:
            break
    return error, taken


def _reference(responses: np.ndarray, static: np.ndarray | None) -> np.ndarray:
    """(..., 12) what the mean of responses (..., n, 12) should be."""
    later = responses[..., responses.shape[-2] // 4 :, :]
    return mean_response(later) if static is None else static
