"""Parametric resonance of a gear mesh with stiffness 1 + kap cos(W t) (physics 4, row b).

The principal instability, at twice the natural frequency (W = 2), exists iff kap > 4 zeta: first
order averaging of the damped Mathieu equation (A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations,
1979, chapter 5). The gear pair is reduced to that oscillator by its parameters: no helix, heavy
bodies, a pinion that keeps its speed, both halves alike.
"""

import math

import numpy as np
import pytest
from support.gearing.gear_mesh import gear_pair, write_table

from herringbone.core import Instance

ZETA = 0.05
STIFFNESS = 1e9
RATIOS = np.linspace(1.96, 2.04, 17)
"""The instability at kap = 0.21 is sqrt(kap**2 / 4 - 4 zeta**2) = 0.03 wide, about 2."""


def oscillator(tmp_path, kap: float, ratio: float) -> tuple[Instance, float]:
    """The pair turning with mesh frequency `ratio` times the natural one; and its period [s]."""
    table = write_table(
        tmp_path / "t.csv",
        lambda p, f: STIFFNESS * (1 + kap * math.cos(2 * math.pi * p)),
        phases=64,
    )
    heavy = {f"{gear}.mass": 1e15 for gear in ("pinion", "wheel")}
    gear = gear_pair(
        table,
        {
            **heavy,
            "base_helix_angle": 0.0,
            "mesh_damping_ratio": ZETA,
            "pinion.inertia": 1e6,
            "damping_transition": 1e-9,
            "backlash": 1e-3,
        },
    )
    radius = gear["wheel.base_radius"]
    omega = math.sqrt(STIFFNESS * radius**2 / gear["wheel.inertia"])
    period = 2 * math.pi / (ratio * omega)
    gear.set("wheel.tau", -2 * radius * STIFFNESS * 2e-6)  # mean deflection 2 um
    gear.set("pinion.tau", 2 * gear["pinion.base_radius"] * STIFFNESS * 2e-6)
    gear.set("approach", 2e-6)
    gear.set("der(angle)", 2 * math.pi / (27 * period))
    gear.set("micro_step", period / 60)
    return gear, period


def growth(tmp_path, kap: float, ratio: float) -> float:
    """Largest Floquet multiplier, from runs over one mesh period that differ in their start."""
    ends = []
    for position, rate in ((0.0, 0.0), (1e-8, 0.0), (0.0, 1e-4)):
        gear, period = oscillator(tmp_path, kap, ratio)
        gear.set("approach", gear["approach"] + position)
        gear.set("der(approach)", rate)
        gear.step(0.0, period)
        assert gear["mesh_left.force"] == gear["mesh_right.force"] > 0.0
        ends.append((gear["approach"], gear["der(approach)"]))
    origin, first, second = np.array(ends)
    monodromy = np.array([(first - origin) / 1e-8, (second - origin) / 1e-4]).T
    return float(np.abs(np.linalg.eigvals(monodromy)).max())


def test_damping_ratio_of_the_reduced_oscillator(tmp_path):
    """Without parametric excitation the multipliers are exp(-zeta w T)."""
    expected = math.exp(-ZETA * 2 * math.pi / 1.7)
    # The pinion's inertia of 1e6 leaves 1e-7 of its motion; Runge-Kutta: 1e-6.
    assert growth(tmp_path, 0.0, 1.7) == pytest.approx(expected, rel=1e-5)


def test_stable_below_the_threshold(tmp_path):
    assert max(growth(tmp_path, 0.19, ratio) for ratio in RATIOS) < 1.0


def test_unstable_above_the_threshold(tmp_path):
    assert max(growth(tmp_path, 0.21, ratio) for ratio in RATIOS) > 1.0


def test_growth_rate_at_resonance(tmp_path):
    """Averaging: exp((kap / 4 - zeta) w T) at W = 2; the next order is kap**2."""
    for kap in (0.1, 0.3):
        expected = math.exp((kap / 4 - ZETA) * math.pi)
        assert growth(tmp_path, kap, 2.0) == pytest.approx(expected, rel=kap**2 / 8 + ZETA**2)


@pytest.mark.parametrize(("kap", "separates"), [(0.19, False), (0.21, True)])
def test_teeth_separate_above_the_threshold_only(tmp_path, kap, separates):
    """A disturbance of a tenth of the mean deflection grows until the teeth separate, or decays."""
    gear, period = oscillator(tmp_path, kap, 2.0)
    gear.set("approach", 2.2e-6)
    apart = False
    for n in range(60 * 800):
        gear.step(n * period / 60, period / 60)
        apart = apart or gear["mesh_left.force"] == 0.0
    assert apart is separates
