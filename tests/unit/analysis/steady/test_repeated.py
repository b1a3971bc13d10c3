"""Marches that go on by steps of half the length, until they repeat again."""

from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.analysis.steady.marching import repeated as module
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.parting import Parting
from herringbone.analysis.steady.marching.repeated import Repeated, with_halved_steps

PLACES = 16
SHAPE = np.sin(2.0 * np.pi * np.arange(PLACES) / PLACES)
OFF = 1e-2


class Way:
    """A motion that comes `factor` times as near to that of its shorter steps in each period."""

    places, period, time = PLACES, 1.0, 0.0

    def __init__(self, factor: float) -> None:
        self.factor, self.periods, self.off = factor, 0, 0.0

    def halve(self) -> None:
        self.off = OFF

    def on(self, places: int, kept: int, inside: int = 1) -> March:
        assert places == kept == PLACES
        self.periods += 1
        self.off *= self.factor
        return March((1.0 + self.off) * SHAPE[None], PLACES, 0.0, 1.0, 1.0, np.zeros(1))


def halved(factor: float, close: float) -> tuple[Way, Repeated]:
    way = Way(factor)
    structure = SimpleNamespace(meshes=1)
    return way, with_halved_steps(structure, None, Repeated(way, None, 1, 0.0), close)


@pytest.mark.parametrize("close", [1e-3, 1e-5])
def test_it_goes_on_until_periods_are_the_same(close):
    """After n periods the change is OFF (1 - f) f^(n - 1), here with f = 1/4."""
    way, found = halved(0.25, close)
    changes = OFF * 0.75 * 0.25 ** np.arange(1, 9)  # of the second period, and of later ones
    fewest = int(np.argmax(changes <= close))
    assert way.periods == fewest + 2
    assert found.change == pytest.approx(changes[fewest], rel=2.0 * OFF)
    assert found.parting is None


def test_what_no_longer_repeats_is_told_with_how_it_parts(monkeypatch):
    monkeypatch.setattr(module, "parting", lambda *_: Parting(0.1, 0.01))
    _, found = halved(1.0001, 1e-7)
    assert found.change > 1e-7
    assert found.parting == (0.1, 0.01)
    assert found.march.values.shape == (1, 2 * PLACES)


class Left(Way):
    """A motion that is left slowly, and not come to from the beginning."""

    def anew(self) -> "Left":
        found = Left(0.25)
        found.off = OFF
        return found

    def settle(self, time: float) -> None:
        self.on(PLACES, PLACES)


@pytest.mark.parametrize("rate", [0.0, 0.1])
def test_a_motion_of_longer_steps_alone_is_left(monkeypatch, rate):
    """Where it is left so slowly that neighbours hardly part; levels were those of its own."""
    monkeypatch.setattr(module, "parting", lambda *_: Parting(rate, 0.01))
    way = Left(1.1)
    found = with_halved_steps(SimpleNamespace(meshes=1), None, Repeated(way, None, 1, 0.0), 1e-3)
    assert way.periods == 9
    assert (found.way is way) == (rate > 0.0)
    if rate > 0.0:
        assert found.change > 1e-3
        assert found.parting == (rate, 0.01)
    else:  # by n periods after the beginning the change is OFF (1 - f) f^n, here with f = 1/4
        assert found.change == pytest.approx(OFF * 0.75 * 0.25**2, rel=2.0 * OFF)
        assert found.parting is None
