"""Whether an output will settle in time, told by two trials of known answers."""

import numpy as np
import pytest

from herringbone.running.settling.settled import CHANGES, LONGEST, Settled, why_not


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
