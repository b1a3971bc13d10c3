"""Findings about single sentences, and about all of them together."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from herringbone.thesis.entry import Finding, Verdict
from herringbone.thesis.readings.grid import Case
from herringbone.thesis.readings.judging import Changed, whole_words
from herringbone.thesis.readings.measures import AS_PUBLISHED
from herringbone.thesis.readings.relief import RELIEF_SENTENCES, ReliefCase
from herringbone.thesis.readings.sentence import COMPUTED, MEASURED
from herringbone.thesis.readings.sentences import SENTENCES

ALL, RELIEF = "all", "relief"
_WORDS = {
    ALL: "all sentences",
    COMPUTED: "chapters 2 to 4 but for relief",
    RELIEF: "what chapter 2.4 says of relief",
    MEASURED: "chapters 5 and 6",
}
ABOUT = tuple(_WORDS)
_DIGITS = 3
_RATIO_MARGIN = 0.01
"""Of numbers between machines: the solver's tolerance, over a growth."""


def simplest(found: Sequence[Changed], holds: np.ndarray, margins: np.ndarray) -> int | None:
    """Number of the case with fewest changes in which a sentence holds; of these the clearest."""
    inside = np.flatnonzero(holds).tolist()
    if not inside:
        return None
    return int(min(inside, key=lambda k: (len(found[int(k)].changes), -margins[k])))


def of_sentences(found: Sequence[Case], margins: np.ndarray, holds: np.ndarray) -> list[Finding]:
    """One per sentence: as shipped, and with what it holds."""
    findings = []
    for k, sentence in enumerate(SENTENCES):
        number, unit, what = sentence.told(margins[0, k])
        best = simplest(found, holds[:, k], margins[:, k])
        there = "" if best is None else _with_unit(*sentence.told(margins[best, k])[:2])
        findings.append(
            Finding(
                f"{_capital(sentence.text)} ({sentence.source}).",
                Verdict.needing(holds[0, k], best is not None),
                round(number, _DIGITS) + 0.0,
                unit,
                what,
                _where(found, holds[:, k], best, there),
                max(1.0, _RATIO_MARGIN * abs(number)),
            )
        )
    return findings


def of_relief(found: Sequence[ReliefCase], margins: np.ndarray, holds: np.ndarray) -> list[Finding]:
    """One per sentence about relief: as shipped, and with what it holds."""
    findings = []
    for k, sentence in enumerate(RELIEF_SENTENCES):
        best = simplest(found, holds[:, k], margins[:, k])
        there = "" if best is None else _with_unit(sentence.value(found[best]), sentence.unit)
        findings.append(
            Finding(
                f"{_capital(sentence.text)} (2.4).",
                Verdict.needing(holds[0, k], best is not None),
                sentence.value(found[0]),
                sentence.unit,
                f"{sentence.what}, as shipped: 200 N m, at the pinion's tip",
                _where(found, holds[:, k], best, there),
                0.02,
            )
        )
    return findings


def _where(found: Sequence[Changed], holds: np.ndarray, best: int | None, there: str) -> str:
    """In which cases a sentence holds."""
    if best is None:
        return f"It holds in none of {len(found)} cases."
    told = f"It holds in {int(holds.sum())} of {len(found)} cases"
    return (
        f"{told}."
        if holds[0]
        else (f"{told}; with fewest changes: {whole_words(found[best])} ({there}).")
    )


def _with_unit(number: float, unit: str) -> str:
    return f"{number:.3g} {unit}".strip()


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _as_shipped(found: Sequence[Case]) -> tuple[Case, Case]:
    """What is shipped, evaluated over whole periods and over 20 ms."""
    first = found[0]
    return first, first._replace(evaluation=AS_PUBLISHED)


def together(
    found_cases: Sequence[Case], holds: np.ndarray, smallest: pd.DataFrame, pairs: pd.DataFrame
) -> list[Finding]:
    """What sentences say together."""
    found = []
    for about in ABOUT:
        best = smallest[smallest["about"] == about].iloc[-1]
        found.append(
            Finding(
                f"One reading explains {_WORDS[about]}.",
                Verdict.of(best["sentences"] >= best["of"]),
                best["sentences"],
                "",
                f"of {best['of']} sentences hold at most together; as shipped "
                f"{smallest[smallest['about'] == about].iloc[0]['sentences']}",
                f"The fewest changes with which so many hold: {best['assumptions']}.",
                1.0,
            )
        )
    whole, window = (holds[found_cases.index(c)] for c in _as_shipped(found_cases))
    changed = [SENTENCES[k].text for k in np.flatnonzero(whole != window)]
    found.append(
        Finding(
            "The thesis evaluates 20 ms, from 0.02 to 0.04 s (3.4).",
            Verdict.NEEDS_AN_ASSUMPTION,
            len(changed),
            "",
            "sentences change as shipped when 20 ms are evaluated in place of whole periods",
            f"{'; '.join(changed)}." if changed else "",
        )
    )
    found.append(
        Finding(
            "The sentences can be true together.",
            Verdict.of(not len(pairs)),
            len(pairs),
            "",
            f"pairs of {len(SENTENCES) + len(RELIEF_SENTENCES)} sentences never hold in one case, "
            "though each of them does in some",
            "",
            3.0,
        )
    )
    return found
