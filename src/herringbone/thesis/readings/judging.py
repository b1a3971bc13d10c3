"""Margins of the sentences by case, and what they say together."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import pandas as pd

from herringbone.core import HerringboneError
from herringbone.thesis.readings.grid import Case, cases, combined, single
from herringbone.thesis.readings.motion import RUN
from herringbone.thesis.readings.points import DEVIATIONS, by_point, computed, looked_up, points
from herringbone.thesis.readings.reading import Reading
from herringbone.thesis.readings.sentences import SENTENCES

SHIPPED = "as shipped"
MOST = 1e3
"""Larger margins are cut: a sentence holds by far."""


class Judged(NamedTuple):
    """Margins of readings.

    Attributes:
        cases: ways to look at readings.
        margins: (cases, sentences).
        points: that were computed.
        runs: of these, by runs.
        failed: why readings could not be computed, by what they change.
    """

    cases: list[Case]
    margins: np.ndarray
    points: int
    runs: int
    failed: dict[str, str]


def judged(readings: Sequence[Reading]) -> Judged:
    """Margins of all cases of readings."""
    found: list[Case] = []
    margins: list[list[float]] = []
    count = runs = 0
    failed: dict[str, str] = {}
    for reading in readings:
        first = next(cases(reading))
        try:
            table = computed(reading, points(DEVIATIONS[1:]))
        except HerringboneError as error:
            failed[whole_words(first)] = str(error)
            continue
        own = table.drop_duplicates(["deviation", "torque", "speed"])
        count, runs = count + len(own), runs + int((own["how"] == RUN).sum())
        known = by_point(table)
        for case in cases(reading):
            figures = looked_up(known, case.evaluation, case.positions)
            found.append(case)
            margins.append([_cut(s.margin(figures, case.deviation)) for s in SENTENCES])
    return Judged(found, np.array(margins), count, runs, failed)


def _cut(margin: float) -> float:
    return float(np.clip(margin, -MOST, MOST))


def tried() -> list[Reading]:
    """All readings."""
    return [*combined(), *single()]


def satisfied(margins: np.ndarray) -> np.ndarray:
    """Which sentences hold in which cases (cases, sentences)."""
    return margins >= np.array([s.needs for s in SENTENCES])


class Changed(Protocol):
    """A case that can tell what it changes."""

    @property
    def changes(self) -> tuple[str, ...]:
        """What differs from what is shipped, in words."""


def fewest_changes(found: Sequence[Changed], holds: np.ndarray) -> pd.DataFrame:
    """The best case for each number of changes from what is shipped, while it gets better.

    Args:
        found: cases.
        holds: (cases, sentences).

    Returns:
        Columns: changes, sentences (that hold), assumptions (in words), ways (cases that are as
        good with as many changes), case (its number).
    """
    counts = holds.sum(axis=1)
    changes = np.array([len(case.changes) for case in found])
    rows, best = [], -1
    for number in range(int(changes.max()) + 1):
        inside = np.flatnonzero(changes == number)
        if not inside.size or counts[inside].max() <= best:
            continue
        k = int(inside[np.argmax(counts[inside])])
        best = int(counts[k])
        rows.append(
            {
                "changes": number,
                "sentences": best,
                "assumptions": whole_words(found[k]),
                "ways": int((counts[inside] == best).sum()),
                "case": k,
            }
        )
    return pd.DataFrame(rows)


def joined(one: pd.DataFrame, other: pd.DataFrame) -> pd.DataFrame:
    """The best for each number of changes of two sets of cases that do not touch each other.

    Args:
        one: of `fewest_changes`; the number of a case is that of this set.
        other: of another set of sentences.
    """
    rows: list[dict[str, object]] = []
    both = itertools.product(one.to_dict("records"), other.to_dict("records"))

    def order(pair: tuple[dict, dict]) -> tuple[int, int]:
        return sum(r["changes"] for r in pair), -sum(r["sentences"] for r in pair)

    for first, second in sorted(both, key=order):
        count = first["sentences"] + second["sentences"]
        if rows and count <= rows[-1]["sentences"]:
            continue
        words = [r["assumptions"] for r in (first, second) if r["changes"]]
        rows.append(
            {
                "changes": first["changes"] + second["changes"],
                "sentences": count,
                "assumptions": "; ".join(words) or SHIPPED,
                "ways": first["ways"] * second["ways"],
                "case": first["case"],
            }
        )
    return pd.DataFrame(rows)


def whole_words(case: Changed) -> str:
    """What a case changes, in words."""
    return "; ".join(case.changes) or SHIPPED


def excluding(holds: np.ndarray, names: Sequence[str]) -> pd.DataFrame:
    """Pairs of sentences that never hold in one case, although each holds in some.

    Args:
        holds: (cases, sentences).
        names: of the sentences.

    Returns:
        Columns: one, other, cases_of_one, cases_of_other (in how many cases each holds).
    """
    rows = []
    for one, other in itertools.combinations(range(len(names)), 2):
        alone, too = int(holds[:, one].sum()), int(holds[:, other].sum())
        if alone and too and not (holds[:, one] & holds[:, other]).any():
            rows.append(
                {
                    "one": names[one],
                    "other": names[other],
                    "cases_of_one": alone,
                    "cases_of_other": too,
                }
            )
    return pd.DataFrame(rows, columns=["one", "other", "cases_of_one", "cases_of_other"])
