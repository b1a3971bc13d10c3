"""Operating points of a reading, and the table of figures there."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import pandas as pd

from herringbone.thesis.readings.measures import EVALUATIONS, measures
from herringbone.thesis.readings.motion import Moving
from herringbone.thesis.readings.reading import Reading

SPEED, TORQUE = 1000.0, 200.0
"""At which the others are varied [r/min, N m]."""
SPEEDS = 800.0, 1000.0, 1200.0, 1500.0
MEASURED_SPEEDS = 800.0, 1200.0, 1500.0
TORQUES = 100.0, 200.0, 270.0, 300.0, 350.0, 400.0
THEORY_TORQUES = 200.0, 250.0, 300.0
DEVIATIONS = 0.0, 10e-6, 20e-6


class At(NamedTuple):
    """An operating point: symmetry deviation [m], torque [N m], speed [r/min]."""

    deviation: float
    torque: float
    speed: float


def points(deviations: Sequence[float]) -> list[At]:
    """Points at which sentences are judged, neighbours after each other.

    Args:
        deviations: at which torque and speed are varied [m].
    """
    found: dict[At, None] = {}
    for deviation in DEVIATIONS:
        if deviation in deviations:
            rising = sorted({*TORQUES, *THEORY_TORQUES})
            found |= dict.fromkeys(At(deviation, t, SPEED) for t in rising)
        whole = deviation in deviations or deviation == 0.0
        speeds = SPEEDS if whole else (SPEED,)
        found |= dict.fromkeys(At(deviation, TORQUE, n) for n in speeds)
    return list(found)


Figures = Callable[[str, str, At], float]
"""A figure: what, kind, point."""
Known = Mapping[tuple[str, str, str, At], float]
"""Values by what, kind, evaluation and point."""


def computed(reading: Reading, at: Sequence[At]) -> pd.DataFrame:
    """A row per point and figure: deviation, torque, speed, how, what, kind, evaluation, value."""
    return pd.DataFrame(list(_rows(reading, at)))


def _rows(reading: Reading, at: Sequence[At]) -> Iterator[dict[str, object]]:
    moving = Moving(reading)
    for point in at:
        motion = moving.at(point.deviation, point.torque, point.speed * math.pi / 30.0)
        for (what, kind, evaluation), value in measures(motion).items():
            yield {
                **point._asdict(),
                "how": motion.how,
                "what": what,
                "kind": kind,
                "evaluation": evaluation,
                "value": value,
            }


AS_DRAWN, MIRRORED = "A, B, C", "C, B, A"
"""Positions of the sensors: at 90, 180 and 270 degrees, or counted the other way."""
_SWAPPED = {"A": "C", "C": "A"}


def by_point(table: pd.DataFrame) -> Known:
    """Values of a table, see `computed`."""
    return {
        (row.what, row.kind, row.evaluation, At(row.deviation, row.torque, row.speed)): row.value
        for row in table.itertuples()
    }


def looked_up(known: Known, evaluation: str, positions: str = AS_DRAWN) -> Figures:
    """Figures by one evaluation; means are the same by all.

    Args:
        known: see `by_point`.
        evaluation: of `EVALUATIONS`.
        positions: AS_DRAWN or MIRRORED.
    """

    def figure(what: str, kind: str, point: At) -> float:
        how = EVALUATIONS[0] if kind == "mean" else evaluation
        what = _SWAPPED.get(what, what) if positions == MIRRORED else what
        return float(known[what, kind, how, point])

    return figure
