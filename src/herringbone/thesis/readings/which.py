"""Which reading explains the thesis: its sentences about trends over what it does not publish."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Outcome, Tables, table
from herringbone.thesis.readings.findings import (
    ABOUT,
    ALL,
    RELIEF,
    of_relief,
    of_sentences,
    simplest,
    together,
)
from herringbone.thesis.readings.grid import Case
from herringbone.thesis.readings.judging import (
    excluding,
    fewest_changes,
    joined,
    judged,
    satisfied,
    tried,
    whole_words,
)
from herringbone.thesis.readings.relief import RELIEF_SENTENCES, ReliefCase, relief_cases
from herringbone.thesis.readings.sentences import SENTENCES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def compute() -> Outcome:
    """All cases, what holds in each, and what follows."""
    found, margins, points, runs, failed = judged(tried())
    holds = satisfied(margins)
    relief = list(relief_cases())
    own = np.array([[s.margin(case) for s in RELIEF_SENTENCES] for case in relief])
    smallest = _smallest(found, holds, fewest_changes(relief, own >= 0.0))
    pairs = pd.concat(
        [
            excluding(holds, [s.name for s in SENTENCES]),
            excluding(own >= 0.0, [s.name for s in RELIEF_SENTENCES]),
        ],
        ignore_index=True,
    )
    return Outcome(
        {
            "margins": _margins(found, margins, holds),
            "sentences": _sentences(found, margins, holds),
            "relief": _relief(relief, own >= 0.0),
            "smallest_sets": smallest,
            "excluding_pairs": pairs,
            "effort": table({"points": [points], "by_runs": [runs], "cases": [len(found)]}),
            "not_computed": table({"assumptions": list(failed), "why": list(failed.values())}),
        },
        (
            *of_relief(relief, own, own >= 0.0),
            *of_sentences(found, margins, holds),
            *together(found, holds, smallest, pairs),
        ),
    )


def _margins(found: Sequence[Case], margins: np.ndarray, holds: np.ndarray) -> pd.DataFrame:
    """A row per case: assumptions in words, how many differ, sentences that hold, margins."""
    return table(
        {
            "assumptions": [whole_words(case) for case in found],
            "changes": [len(case.changes) for case in found],
            "sentences": holds.sum(axis=1),
            **{s.name: margins[:, k] for k, s in enumerate(SENTENCES)},
        }
    )


def _sentences(found: Sequence[Case], margins: np.ndarray, holds: np.ndarray) -> pd.DataFrame:
    """A row per sentence: as shipped, in how many cases it holds, and with which fewest changes."""
    best = [simplest(found, holds[:, k], margins[:, k]) for k in range(len(SENTENCES))]
    return table(
        {
            "sentence": [s.name for s in SENTENCES],
            "text": [s.text for s in SENTENCES],
            "chapter": [s.source for s in SENTENCES],
            "needs": [s.needs for s in SENTENCES],
            "as_shipped": margins[0],
            "cases": holds.sum(axis=0),
            "holds_if": ["" if k is None else whole_words(found[k]) for k in best],
        }
    )


def _relief(cases: Sequence[ReliefCase], holds: np.ndarray) -> pd.DataFrame:
    """A row per reading of the figure of relief: torque, values of its sentences, how many hold."""
    values = {s.name: [s.value(case) for case in cases] for s in RELIEF_SENTENCES}
    return table(
        {
            "assumptions": [whole_words(case) for case in cases],
            "torque": [case.torque for case in cases],
            **values,
            "sentences": holds.sum(axis=1),
        },
        {"torque": "N m", **{s.name: s.unit for s in RELIEF_SENTENCES}},
    )


def _smallest(found: Sequence[Case], holds: np.ndarray, of_figure: pd.DataFrame) -> pd.DataFrame:
    """See `fewest_changes`, of all sentences, the computed ones, those of relief, the measured."""
    parts = []
    for about in ABOUT:
        inside = [about in {ALL, s.about} for s in SENTENCES]
        part = of_figure.copy() if about == RELIEF else fewest_changes(found, holds[:, inside])
        if about == ALL:
            part = joined(part, of_figure)
        count = sum(inside) + len(RELIEF_SENTENCES) * (about in {ALL, RELIEF})
        part.insert(0, "about", about)
        part.insert(3, "of", count)
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def draw(tables: Tables) -> dict[str, "Figure"]:
    """Sentences over assumptions, and pairs that exclude each other."""
    from herringbone.thesis.readings.drawing import exclusions, over_assumptions  # noqa: PLC0415

    return {"assumptions": over_assumptions(tables), "exclusions": exclusions(tables)}


ENTRY = Entry(
    name="which_reading",
    group="readings",
    title="Which reading explains the thesis",
    source="chapters 2.3, 2.4, 3.4, 3.5, 4.3, 5.3 and 6",
    shows="26 sentences about trends, without the axial stiffness that holds the pinion, the parts "
    "and phases of the symmetry deviation, the stagger of the halves, the accuracy of the teeth, "
    "the torque of the figure of relief, and whose torque is stated. Each sentence is a test with "
    "a margin here. Combinations of foundation, restraint of the pinion, parts of the symmetry "
    "deviation and stagger, teeth of class 6 with some of these, and further assumptions one at a "
    "time, are computed at the thesis' operating points, each evaluated over whole periods and "
    "over windows of 20 ms, at 10 and 20 µm, and with the sensors' angles counted either way. "
    "What is said of relief depends on its figure's torque, tips and meaning alone.",
    compute=compute,
    draw=draw,
    seconds=105.0,
)
