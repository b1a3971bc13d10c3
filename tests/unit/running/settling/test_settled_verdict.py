"""Whether an output will settle in time, told by two trials of known answers."""

import numpy as np
import pytest

from herringbone.running.settling.settled import CHANGES, LONGEST, Settled, dies_out, why_not


def trial(answer, duration):
    """What a trial of an answer (function of the time since the input is steady) comes to."""

    def over(begin, end):
        path = answer(np.linspace(begin, end, 201) * duration)
        line = np.linspace(-1.0, 1.0, len(path))
        return path, np.ptp(path - line * (line @ path) / (line @ line))

    (third, _), (last, bend) = over(0.0, 0.25), over(0.25, 0.5)
    size, moved = np.abs(last).max(), np.ptp(last)
    return Settled(last[-1:], moved / size, bend / size, "tau", last, moved, np.ptp(third) / size)


def told(answer, duration):
    return why_not(trial(answer, duration), trial(answer, 0.5 * duration), duration, "N.m")


def test_an_integral():
    """At the first trial that tells: 0.16 s in place of seconds. Rate and offset are its own."""
    assert told(lambda t: 3.0 + 20.0 * t, 0.16) == (
        "goes on evenly, by 20 N.m a second, in the steady motion: it integrates"
    )
    assert told(lambda t: 3.0 + 20.0 * t, 0.08) == ""


@pytest.mark.parametrize("rate", [3.0, 10.0, 40.0])
def test_a_lag_that_settles_in_time(rate):
    """1 - exp(-rate t): of half of the longest trial the last quarter changes by less than 5e-4."""
    answer = lambda t: 1.0 - np.exp(-rate * t)  # noqa: E731
    assert rate < 10.0 or trial(answer, LONGEST).change < CHANGES
    for duration in (0.16, 0.32, 0.64, 1.28, 2.56):
        if trial(answer, duration).change > CHANGES:
            assert told(answer, duration) == ""


def test_oscillations():
    """Undamped; and of a decay of 1/s, the time it takes."""
    assert told(lambda t: 1.0 + 0.1 * np.cos(200.0 * t), 1.28) == "does not die out in 1.28 s"
    slow = told(lambda t: 1.0 + 0.1 * np.exp(-t) * np.cos(500.0 * t), 1.28)
    seconds = float(slow.split("some ")[1].split()[0])
    # Of the last quarter of a trial T: 0.2 exp(-T/4) < 5e-4.
    assert seconds == pytest.approx(4.0 * np.log(0.2 / CHANGES), rel=0.4)


def test_an_oscillation_slower_than_a_quarter_of_a_trial():
    """A car on its side shaft: 3.3/s, 1.4 Hz. Quarters hold parts of a period: nothing is told."""
    answer = lambda t: np.exp(-3.3 * t) * np.cos(9.0 * t)  # noqa: E731
    for duration in (0.16, 0.32, 0.64, 1.28, 2.56):
        assert told(answer, duration) == ""


@pytest.mark.parametrize("rate", [20.0, 60.0])
def test_what_dies_out_evenly_is_settled_by_what_would_be_left(rate):
    """The quarter after a trial T changes it by 1 - exp(-rate T/4) of its value at the end of T/2
    times exp(-rate T/4): within `CHANGES` of its size when it is called settled, and not before."""
    answer = lambda t: 1.0 + np.exp(-rate * t)  # noqa: E731
    durations = [0.02 * 2.0**n for n in range(9)]

    def settled(duration):
        return dies_out(trial(answer, duration), trial(answer, 0.5 * duration), duration)

    first = next(duration for duration in durations if settled(duration))
    left = np.exp(-0.5 * rate * first)
    assert left < CHANGES / (1.0 - np.exp(-0.25 * rate * first)) * 1.1
    assert np.exp(-0.25 * rate * first) > CHANGES  # a trial of half the time leaves too much


def test_what_dies_out_in_two_ways_is_not_settled_by_the_first():
    """The slow part, 10/s, is left when the quick one has gone: the rates of two trials differ."""
    answer = lambda t: 1.0 + np.exp(-200.0 * t) + 0.1 * np.exp(-10.0 * t)  # noqa: E731
    for duration in (0.02, 0.04, 0.08, 0.16, 0.32):
        assert not dies_out(trial(answer, duration), trial(answer, 0.5 * duration), duration)


@pytest.mark.parametrize(("speed", "refused"), [(0.0, True), (2.0, True), (60.0, False)])
def test_what_may_pulsate_with_a_shaft_is_given_a_turn(speed, refused):
    """Not a shaft that makes no turn in a quarter of the longest trial: 2 rad/s, 0.4 turns."""
    answer = lambda t: 1.0 + 0.1 * np.exp(-0.01 * t) * np.cos(200.0 * np.pi * t)  # noqa: E731
    turns = 0.04 * speed / (2.0 * np.pi) if speed else np.inf
    trials = (trial(answer, T)._replace(turns=turns) for T in (0.16, 0.08))
    assert bool(why_not(*trials, 0.16, "N.m")) == refused
