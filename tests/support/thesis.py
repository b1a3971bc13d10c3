"""Entries of the thesis' report, computed once for all tests."""

from functools import cache

from herringbone.thesis.entry import Finding, Outcome
from herringbone.thesis.study import study
from support.alone import alone


@cache
def outcome(name: str) -> Outcome:
    """What an entry computes; out of the cache if it is there."""
    with alone(f"thesis_{name}"):
        (done,) = study("thesis", [name], workers=1).done
    assert not done.error, done.error
    assert done.outcome is not None
    return done.outcome


def finding(name: str, words: str) -> Finding:
    """The finding whose sentence has these words."""
    (found,) = [f for f in outcome(name).findings if words in f.sentence]
    return found
