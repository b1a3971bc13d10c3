"""A system as what is known of its coupling before a run is predicted from it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.stability.linear_parts import Strangers
from herringbone.core.process.telling import Tell
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.linear_start import turned_back, under_load
from herringbone.running.foreign.speeding_up import speeding_up
from herringbone.running.foreign.surrogates import opened_surrogates, without_missing
from herringbone.running.known_limits import KnownLimits
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Scene


class Predictable(NamedTuple):
    """A system under load, without parts for which nothing stands.

    Attributes:
        system: at angles where differences are exact; for matrices.
        started: the same as runs start.
        scene: its name.
        strangers: what stands for foreign parts.
        missing: lines on parts for which nothing stands.
        known: its limits that were found before.
        left_out: names of these parts.
    """

    system: System
    started: System
    scene: str
    strangers: Strangers
    missing: tuple[str, ...]
    known: KnownLimits
    left_out: tuple[str, ...]


@contextmanager
def predictable(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    wishes: Wishes,
    tell: Tell,
) -> Iterator[Predictable]:
    """A system that predictions can be made of, as long as the context lasts.

    Args:
        system, scene, wishes: see `prepared`.
        tell: called with lines on how it came about.

    Raises:
        HerringboneError: something about the input is wrong, or nothing is left to be predicted.
    """
    trials = LI().start_step
    started, chosen, notes = prepared(system, scene, wishes, trial_step=trials)
    for note in notes:
        tell(note)
    started = under_load(started)
    exact = turned_back(started)
    same = exact is started  # as without parts that are brought to the start
    with opened_surrogates(exact, trials) as foreign:
        exact, missing = without_missing(exact, foreign)
        for line in missing:
            tell(line)
        exact = speeding_up(exact, foreign.strangers)
        if same:
            started = exact
        else:
            started = speeding_up(without_missing(started, foreign)[0], foreign.strangers)
        known = KnownLimits(started, trials)
        left_out = tuple(foreign.missing)
        yield Predictable(exact, started, chosen.name, foreign.strangers, missing, known, left_out)
