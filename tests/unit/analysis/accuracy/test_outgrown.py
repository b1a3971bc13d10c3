"""Runs that have grown beyond those with half their step, and those that have not."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from support.result import make_foreign_result

from herringbone.analysis.accuracy.apart import outgrown
from herringbone.result.result import TIME

T = np.linspace(0.0, 1.0, 101)
VIBRATION = np.sin(40.0 * T)


def made(**values):
    """A run with outputs by their first letters: torques "t", angles "p"."""
    units = {name: {"t": "N.m", "p": "rad"}[name[0]] for name in values}
    data = pd.DataFrame({TIME: T} | values)
    return replace(make_foreign_result(), data=data, units={TIME: "s"} | units, channels={})


@pytest.mark.parametrize(("rate", "found"), [(20.0, True), (12.0, True), (3.0, False)])
def test_exponential_growth(rate, found):
    """By exp(rate) in all; at exp(3) it is 20 times, which is not beyond."""
    grown = outgrown(made(t=VIBRATION * np.exp(rate * T), p=T), made(t=VIBRATION, p=T))
    assert (grown is not None) == found
    if grown:
        assert grown.output == "t"
        assert grown.value == pytest.approx(np.exp(rate), rel=0.3)
        assert grown.times < grown.value


@pytest.mark.parametrize(
    ("own", "finer"),
    [
        (1e6 * T**2, 1e6 * T**2 * 0.99),  # free acceleration
        (np.exp(20.0 * T), 0.1 * np.exp(20.0 * T)),  # the model itself, by other seeds
        (np.where(T > 0.6, 1e4, 0.0), np.where(T > 0.6, 9e3, 0.0)),  # a load that sets in late
        (T * VIBRATION, 0.5 * T * VIBRATION),  # resonance
        (T**3, 1e-3 * VIBRATION),  # drifts, which is wrong, and not unstable
        (1e6 * np.exp(-20.0 * T) * VIBRATION, VIBRATION),  # a blow at the start
        (np.exp(20.0 * T) * 1e-17, np.zeros_like(T)),  # rounding
    ],
)
def test_what_is_not_unstable(own, finer):
    assert outgrown(made(p=own), made(p=finer)) is None
    assert outgrown(made(p=own), made(p=own)) is None
