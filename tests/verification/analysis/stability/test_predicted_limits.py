"""Predicted limits against runs of the same linear parts, on the rig and on random variants.

A frozen gearbox is affine while its meshes stay closed. A run just beyond a predicted limit must
grow, and one just below it decay, by the predicted factor in every macro step, whatever the
prediction is made of: the runs step the parts themselves, thousands of times, and know no matrix.
"""

from itertools import pairwise

import numpy as np
import pytest
from support.rig.limits import predicted, rig

from herringbone.analysis.stability.instability import warn_if_unstable
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.components.in_process import InProcessPart
from herringbone.cosim.algorithms import LI, FixedPoint
from herringbone.cosim.simulation import make_grid, simulate

SEATS = "gearbox.modal_housing."
MARGIN = 0.02
TRIED = np.linspace(0.0625 * MARGIN, MARGIN, 16)
FAST = 1e-3
"""Growth per step that needs no step farther beyond a limit."""
RATE = 0.01
"""Relative deviation of a measured rate: what other motions leave in the part that is measured."""
FOLDS = 8.0
"""Powers of e by which a run is to grow or decay: a motion decays to 3e-4, far from rounding."""
LARGEST = 2e-4
"""Largest velocity [m/s] of a run: at the mesh frequencies less than a tenth of a deflection."""
KICKED = {"y_1": 1.0, "y_2": -0.5, "y_3": 0.5, "z_3": 1.0, "z_4": 0.5, "approach": 0.5}
FEWEST, MOST = 200, 40000
VARIANTS = 3


def measured(number, algorithm, step, expected, frequency):
    """Growth per macro step of a linear run at a frequency, over its last half, or quarter.

    Slow motions need the longer part; where one grows or decays as far as it is to, others have
    had to give way to it by then.
    """
    _, instances = linear_network(rig(number))
    gear = next(i for i in instances if i.name == "gearbox.gear_mesh")
    count = int(np.clip(FOLDS / abs(expected), FEWEST, MOST))
    start_velocity = LARGEST * np.exp(-max(np.sign(expected), 0.0) * FOLDS)
    for name, part in KICKED.items():
        gear.set(f"der({name})", gear[f"der({name})"] + part * start_velocity)
    parts = [InProcessPart(i) for i in instances]
    run = simulate(rig(number), parts, algorithm, make_grid(count * step, step, step))
    assert run.outcome.reached_end
    seats = [i for i, n in enumerate(run.names) if n.startswith(SEATS) and ".v_" in n]
    fast = np.diff(run.values[:, seats], n=2, axis=0)
    apart = count // 4 if count < MOST else count // 2
    window = apart // 2
    turn = np.exp(-2j * np.pi * frequency * step * np.arange(window)) * np.hanning(window)
    middle, end = (turn @ rows for rows in (fast[-window - apart : -apart], fast[-window:]))
    return float(np.log(np.linalg.norm(end) / np.linalg.norm(middle)) / apart)


def rate(growth, step):
    """Predicted growth per macro step, as a natural logarithm."""
    return float(np.log(growth(step).radius))


def fast_or_fastest(growth, steps):
    """The first of these steps that grows fast, else that which grows fastest."""
    fast = next((step for step in steps if rate(growth, step) >= FAST), None)
    return max(steps, key=lambda step: rate(growth, step)) if fast is None else fast


def assert_as_predicted(number, algorithm, step):
    """The run at a step grows or decays by the predicted factor."""
    growth, _ = predicted(number, algorithm)
    expected, frequency = rate(growth, step), growth(step).frequency
    found = measured(number, algorithm, step, expected, frequency)
    assert found == pytest.approx(expected, rel=RATE)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(VARIANTS + 1))
@pytest.mark.parametrize("algorithm", default_algorithms(), ids=str)
def test_linear_run_changes_sides_at_the_predicted_limit(algorithm, number):
    """Decay 2 % below the limit, growth at most 2 % beyond it, both at the predicted rates."""
    growth, bands = predicted(number, algorithm)
    limit = bands[0][0]
    below = (1.0 - MARGIN) * limit
    beyond = fast_or_fastest(growth, (1.0 + TRIED) * limit)
    assert rate(growth, below) < 0.0 < rate(growth, beyond)
    assert_as_predicted(number, algorithm, below)
    assert_as_predicted(number, algorithm, beyond)


@pytest.mark.slow
def test_narrow_bands_around_a_limit():
    """0.7 % and 0.3 % wide, before the last one; a scan by 2.5 % jumps over the second one."""
    number, algorithm = 3, FixedPoint()
    growth, bands = predicted(number, algorithm)
    (low, high), (second, end) = bands[:2]
    assert high < 1.01 * low
    assert second > 1.015 * high
    assert end < 1.01 * second
    middle = np.sqrt(low * high)
    assert growth(middle).frequency == pytest.approx(0.5 / middle, rel=1e-3)
    for step, sign in ((middle, 1), (np.sqrt(high * second), -1), (np.sqrt(second * end), 1)):
        assert sign * rate(growth, step) > 0.0
        assert_as_predicted(number, algorithm, step)


@pytest.mark.slow
def test_run_is_warned_inside_a_band_and_not_outside():
    """Where bands of li on the rig begin, between them, and below the first."""
    _, bands = predicted(0, LI())
    inside = [1.01 * low for low, _ in bands[:3]]
    stable = [np.sqrt(high * low) for (_, high), (low, _) in pairwise(bands) if low > 1.02 * high]
    assert len(inside) == 3
    assert stable
    for step in (0.98 * bands[0][0], *stable):
        assert warn_if_unstable(rig(0), LI(), step) is None
    for step in inside:
        assert f"unstable at a step of {step:g} s" in (warn_if_unstable(rig(0), LI(), step) or "")
