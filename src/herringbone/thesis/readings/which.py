"""Which reading explains the thesis: its sentences about trends over what it does not publish."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Outcome, Tables, table
from herringbone.thesis.readings.findings import ABOUT, ALL, of_sentences, simplest, together
from herringbone.thesis.readings.grid import Case
from herringbone.thesis.readings.judging import (
    excluding,
    fewest_changes,
    judged,
    satisfied,
    tried,
    whole_words,
)
from herringbone.thesis.readings.sentences import SENTENCES

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def compute() -> Outcome:
    """All cases, what holds in each, and what follows."""
    found, margins, points, runs, failed = judged(tried())
    holds = satisfied(margins)
    smallest = _smallest(found, holds)
    return Outcome(
        {
            "margins": _margins(found, margins, holds),
            "sentences": _sentences(found, margins, holds),
            "smallest_sets": smallest,
            "excluding_pairs": excluding(holds),
            "effort": table({"points": [points], "by_runs": [runs], "cases": [len(found)]}),
            "not_computed": table({"assumptions": list(failed), "why": list(failed.values())}),
        },
        (*of_sentences(found, margins, holds), *together(found, holds, smallest)),
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


def _smallest(found: Sequence[Case], holds: np.ndarray) -> pd.DataFrame:
    """See `fewest_changes`, of all sentences, of the computed and of the measured ones."""
    parts = []
    for about in ABOUT:
        inside = [about in {ALL, s.about} for s in SENTENCES]
        part = fewest_changes(found, holds[:, inside])
        part.insert(0, "about", about)
        part.insert(3, "of", int(sum(inside)))
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
    source="chapters 2.3, 3.4, 3.5, 4.3, 5.3 and 6",
    shows="22 sentences about trends, without the axial stiffness that holds the pinion, the parts "
    "and phases of the symmetry deviation, the stagger of the halves, the accuracy of the teeth, "
    "and whose torque is stated. Each sentence is a test with a margin here. Combinations of "
    "foundation, restraint of the pinion, parts of the symmetry deviation and stagger, and further "
    "assumptions one at a time, are computed at the thesis' operating points, each evaluated over "
    "whole periods and over windows of 20 ms, at 10 and 20 µm, and with the sensors' angles "
    "counted either way.",
    compute=compute,
    draw=draw,
    seconds=95.0,
)
