"""What sensors show on the plateaus of a test cycle: so many samples of each, and how they scatter.

A plateau is a stretch of a run over which the set points of speed and torque do not change. A test
records some samples at its end. How far these stand for the plateau is told by all stretches of as
many samples in its second half.
"""

from typing import NamedTuple

import numpy as np
import pandas as pd

from herringbone.analysis.asked import signal
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import TIME, Result

SAMPLES = 50
_SAME = 1e-9
_SETTLED = 0.5
"""Share of a plateau that is left out of what stands for it."""


class Plateau(NamedTuple):
    """A stretch of constant set points.

    Attributes:
        begin, end: [s].
        speed: of the driving motor [rad/s].
        torque: that the load is told [N m].
    """

    begin: float
    end: float
    speed: float
    torque: float


def plateaus(result: Result) -> list[Plateau]:
    """Stretches of a run whose set points are constant, from the first to the last row of each.

    Raises:
        ParameterError: the run records no set points.
    """
    found = [
        signal(result, Role.CONTROLLER, quantity)
        for quantity in (Quantity.SPEED_SETPOINT, Quantity.TORQUE_SETPOINT)
    ]
    if any(values is None for values in found):
        raise ParameterError(
            f"system '{result.info.system}' records no set points of speed and torque"
        )
    told = np.array([np.asarray(values, dtype=float) for values in found])
    time = result.data[TIME].to_numpy()
    size = np.abs(told).max(axis=1, keepdims=True)
    still = (np.abs(np.diff(told, axis=1)) <= _SAME * size).all(axis=0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], still, [False]]).astype(int)))
    return [
        Plateau(float(time[first]), float(time[last]), *told[:, first].tolist())
        for first, last in edges.reshape(-1, 2)
    ]


def plateau_statistics(result: Result, samples: int = SAMPLES) -> pd.DataFrame:
    """Figures of the samples of sensors on the plateaus of a run.

    Args:
        result: of a run of a system with sensors and a test cycle.
        samples: that are taken at the end of each plateau.

    Returns:
        A row per plateau and sensor: plateau (from 1), begin, end [s], speed [rad/s], torque [N m],
        sensor; `rms` without mean, `peak_to_peak` and `mean` of the samples [m/s]; `rms_settled` of
        the second half; `lowest`, `highest` rms of as many samples there; `clipped` samples of the
        run.

    Raises:
        ParameterError: no set points, no sensors, or no plateau of twice as many samples.
    """
    if samples < 2:
        raise ParameterError(f"samples = {samples}: a plateau takes two or more")
    found, refused = sensor_figures(result)
    if not found:
        why = "; ".join(dict.fromkeys(refused.values())) or "the system declares none"
        raise ParameterError(f"system '{result.info.system}' records no sensors: {why}")
    rows = []
    for number, plateau in enumerate(plateaus(result), 1):
        for name, one in found.items():
            inside = (one.time >= plateau.begin) & (one.time <= plateau.end)
            values = one.velocity[inside]
            if values.size < 2 * samples:
                continue
            settled = values[int(_SETTLED * values.size) :]
            windows = np.lib.stride_tricks.sliding_window_view(settled, samples).std(axis=1)
            taken = values[-samples:]
            rows.append(
                {
                    "plateau": number,
                    **plateau._asdict(),
                    "sensor": name,
                    "rms": float(taken.std()),
                    "peak_to_peak": float(np.ptp(taken)),
                    "mean": float(taken.mean()),
                    "rms_settled": float(settled.std()),
                    "lowest": float(windows.min()),
                    "highest": float(windows.max()),
                    "clipped": one.saturated,
                }
            )
    if not rows:
        raise ParameterError(
            f"system '{result.info.system}': no plateau lasts for {2 * samples} samples"
        )
    return pd.DataFrame(rows)
