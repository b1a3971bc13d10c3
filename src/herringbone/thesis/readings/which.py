"""Which reading explains the thesis: its sentences about trends over what it does not publish."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Entry, Finding, Outcome, Tables, Verdict, table
from herringbone.thesis.readings.grid import Case
from herringbone.thesis.readings.judging import (
    excluding,
    fewest_changes,
    judged,
    satisfied,
    tried,
    whole_words,
)
from herringbone.thesis.readings.sentence import COMPUTED, MEASURED
from herringbone.thesis.readings.sentences import SENTENCES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_ALL = "all"
_ABOUT = (_ALL, COMPUTED, MEASURED)
_WORDS = {_ALL: "all sentences", COMPUTED: "chapters 2 to 4", MEASURED: "chapters 5 and 6"}
_RATIO_MARGIN = 0.01
"""Of numbers between machines: the solver's tolerance, over a growth."""


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
        (*_of_sentences(found, margins, holds), *_together(holds, smallest)),
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
    simplest = [_simplest(found, holds[:, k], margins[:, k]) for k in range(len(SENTENCES))]
    return table(
        {
            "sentence": [s.name for s in SENTENCES],
            "text": [s.text for s in SENTENCES],
            "chapter": [s.source for s in SENTENCES],
            "needs": [s.needs for s in SENTENCES],
            "as_shipped": margins[0],
            "cases": holds.sum(axis=0),
            "holds_if": ["" if k is None else whole_words(found[k]) for k in simplest],
        }
    )


def _simplest(found: Sequence[Case], holds: np.ndarray, margins: np.ndarray) -> int | None:
    """Number of the case with fewest changes in which a sentence holds; of these the clearest."""
    inside = np.flatnonzero(holds)
    if not inside.size:
        return None
    return int(min(inside, key=lambda k: (len(found[int(k)].changes), -margins[k])))


def _smallest(found: Sequence[Case], holds: np.ndarray) -> pd.DataFrame:
    """See `fewest_changes`, of all sentences, of the computed and of the measured ones."""
    parts = []
    for about in _ABOUT:
        inside = [about in {_ALL, s.about} for s in SENTENCES]
        part = fewest_changes(found, holds[:, inside])
        part.insert(0, "about", about)
        part.insert(3, "of", int(sum(inside)))
        parts.append(part)
    return pd.concat(parts, ignore_index=True)


def _of_sentences(found: Sequence[Case], margins: np.ndarray, holds: np.ndarray) -> list[Finding]:
    findings = []
    for k, sentence in enumerate(SENTENCES):
        number, unit, what = sentence.told(margins[0, k])
        simplest = _simplest(found, holds[:, k], margins[:, k])
        count = f"{int(holds[:, k].sum())} of {len(found)} cases"
        if holds[0, k]:
            verdict, why = Verdict.AGREES, f"It holds in {count}."
        elif simplest is None:
            verdict, why = Verdict.CONTRADICTS, f"It holds in none of {len(found)} cases."
        else:
            verdict = Verdict.NEEDS_AN_ASSUMPTION
            there = "{:.3g} {}".format(*sentence.told(margins[simplest, k])[:2]).strip()
            words = whole_words(found[simplest])
            why = f"It holds in {count}; with fewest changes: {words} ({there})."
        text = sentence.text[0].upper() + sentence.text[1:]
        findings.append(
            Finding(f"{text} ({sentence.source}).", verdict, number, unit, what, why,
                    max(1.0, _RATIO_MARGIN * abs(number)))
        )  # fmt: skip
    return findings


def _together(holds: np.ndarray, smallest: pd.DataFrame) -> list[Finding]:
    """What sentences say together."""
    pairs = excluding(holds)
    found = []
    for about in _ABOUT:
        best = smallest[smallest["about"] == about].iloc[-1]
        found.append(
            Finding(
                f"One reading explains {_WORDS[about]}.",
                Verdict.CONTRADICTS if best["sentences"] < best["of"] else Verdict.AGREES,
                best["sentences"],
                "",
                f"of {best['of']} sentences hold at most together; as shipped "
                f"{smallest[smallest['about'] == about].iloc[0]['sentences']}",
                f"The fewest changes with which so many hold: {best['assumptions']}.",
                1.0,
            )
        )
    found.append(
        Finding(
            "The sentences can be true together.",
            Verdict.CONTRADICTS if len(pairs) else Verdict.AGREES,
            len(pairs),
            "",
            f"pairs of {len(SENTENCES)} sentences never hold in one case, though each of them does "
            "in some",
            "",
            3.0,
        )
    )
    return found


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
