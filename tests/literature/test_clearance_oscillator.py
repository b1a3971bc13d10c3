"""Oscillator with clearance under mean and alternating load (physics 4, row c).

    x'' + g(x, x') (2 zeta x' + x) = 1 + r cos(W t),   time in 1 / w, x in static deflections

The teeth carry no tension: they part where the force x + 2 zeta x' of the linear response touches
zero. Its amplitude r sqrt((1 + 4 zeta^2 W^2) / ((1 - W^2)^2 + 4 zeta^2 W^2)) is 1 at the roots of

    W^4 - 2 (1 - 2 zeta^2 + 2 zeta^2 r^2) W^2 + 1 - r^2 = 0

Separation softens: the resonance bends to lower frequencies, so that a sweep upwards jumps at the
lower root, while a sweep downwards stays separated beyond it (A. Kahraman and R. Singh, J. Sound
Vib. 142, 1990, 49-75). Contact is lost and regained at the upper root in both directions.
"""

import math

import numpy as np
import pytest
from support.gearing.gear_mesh import constant_table, gear_pair

ZETA, RATIO = 0.03, 0.15
STIFFNESS, MEAN = 1e9, 2e-6
STEP = 2e-3
"""Of the sweeps, and their resolution."""
PERIODS, PARTS = 60, 24
_B = 1 - 2 * ZETA**2 + 2 * (ZETA * RATIO) ** 2
LOWER, UPPER = (math.sqrt(_B + s * math.sqrt(_B**2 - 1 + RATIO**2)) for s in (-1, 1))


def linear_amplitude(w: float) -> float:
    return RATIO / math.hypot(1 - w**2, 2 * ZETA * w)


def sweep(
    table,
    frequencies: np.ndarray,
    *,
    zeta: float = ZETA,
    ratio: float = RATIO,
    rising: int = 0,
    **changed: float,
) -> tuple[np.ndarray, np.ndarray]:
    """Amplitude (in mean deflections) and smallest force at each frequency.

    The alternating force grows with the power `rising` of the frequency.
    """
    parameters = {
        "pinion.inertia": 1e6,  # keeps its speed
        **{f"{gear}.mass": 1e15 for gear in ("pinion", "wheel")},
        "base_helix_angle": 0.0,
        "mesh_damping_ratio": zeta,
        "damping_transition": 1e-10,
        "backlash": 1e-3,
        "interface_degree": 4,
        "micro_step": 1e-4,
        **changed,
    }
    gear = gear_pair(table, parameters)
    pinion, radius = gear["pinion.base_radius"], gear["wheel.base_radius"]
    omega = math.sqrt(STIFFNESS * radius**2 / gear["wheel.inertia"])
    load = 2 * STIFFNESS * MEAN
    gear.set("pinion.tau", load * pinion)
    gear.set("approach", MEAN)
    results = []
    names = ["wheel.tau", *(f"wheel.tau.node{n}" for n in range(1, 5))]
    angles = 2 * math.pi * (np.arange(PARTS)[:, None] + np.arange(5) / 4) / PARTS
    torques = ratio * np.cos(angles)
    at = [gear.component.declaration.index[name] for name in names]
    for w in frequencies:
        h = 2 * math.pi / (w * omega) / PARTS
        gear.set("micro_step", h / 4)
        path, force = [], []
        for n in range(PERIODS * PARTS):
            gear.block[at] = -load * radius * (1 + w**rising * torques[n % PARTS])
            gear.step(0.0, h)
            if n >= (PERIODS - 2) * PARTS:
                path += [
                    pinion * gear[f"pinion.phi.node{k}"] - radius * gear[f"wheel.phi.node{k}"]
                    for k in (1, 2, 3, 4)
                ]
                force.append(gear["mesh_left.force"])
        path = np.array(path)
        results.append((np.ptp(path) / 2 / MEAN, min(force)))
    return tuple(np.array(results).T)


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return constant_table(tmp_path_factory.mktemp("clearance") / "t.csv", STIFFNESS)


@pytest.fixture(scope="module")
def upwards(table):
    frequencies = np.arange(0.90, 1.10, STEP)
    return frequencies, *sweep(table, frequencies)


@pytest.fixture(scope="module")
def downwards(table):
    frequencies = np.arange(1.10, 0.90, -STEP)
    return frequencies, *sweep(table, frequencies)


def test_linear_while_the_teeth_are_in_contact(upwards):
    frequencies, amplitude, force = upwards
    outside = (frequencies < LOWER - STEP) | (frequencies > UPPER + STEP)
    assert force[outside].min() > 0.0
    expected = [linear_amplitude(w) for w in frequencies[outside]]
    # Start: exp(-60 * 2 pi * 0.03) = 1e-5. Peaks between 96 points: (pi / 96)**2 / 2 = 5e-4.
    np.testing.assert_allclose(amplitude[outside], expected, rtol=2e-3)


def test_upward_sweep_jumps_at_the_lower_root(upwards):
    frequencies, amplitude, force = upwards
    first = int(np.argmax(force == 0.0))
    assert frequencies[first] == pytest.approx(LOWER, abs=1.5 * STEP)
    assert amplitude[first + 1] > 1.5 * amplitude[first - 1]


def test_contact_is_regained_at_the_upper_root(upwards, downwards):
    for frequencies, _, force in (upwards, downwards):
        separated = frequencies[force == 0.0]
        assert separated.max() == pytest.approx(UPPER, abs=1.5 * STEP)


def test_hysteresis_below_the_lower_root(upwards, downwards):
    """At the same frequency two responses: linear on the way up, separated on the way down."""
    up, down = (dict(zip(np.rint(f / STEP), a, strict=True)) for f, a, _ in (upwards, downwards))
    for w in (LOWER - 0.005, LOWER - 0.015):
        n = np.rint(w / STEP)
        assert up[n] == pytest.approx(linear_amplitude(n * STEP), rel=2e-3)
        assert down[n] > 1.5 * up[n]


PUBLISHED = {"zeta": 0.05, "ratio": 0.5, "rising": 2}
"""A. Kahraman and R. Singh (1990): F_m = 0.1, F_ah = 0.05, so an excitation of 0.5 W**2."""


@pytest.mark.parametrize(
    ("gate", "transition", "expected"), [(0.0, 5e-7, 0.71), (1.0, 1e-10, 0.58), (1.0, 5e-7, 0.58)]
)
def test_drop_of_the_published_oscillator(table, gate, transition, expected):
    """Swept downwards: its damping acts on open teeth, too, and separation ends at 0.71.

    With damping in contact only nothing is lost in free flight, and it goes on to 0.58.
    """
    frequencies = np.arange(0.90, 0.54, -0.01)
    changed = {"damping_gate": gate, "damping_transition": transition}
    amplitude, force = sweep(table, frequencies, **PUBLISHED, **changed)
    last = int(np.argmax(amplitude[1:] < 0.5 * amplitude[:-1]))
    assert amplitude[last + 1] < 0.5 * amplitude[last]
    assert frequencies[last] == pytest.approx(expected, abs=0.015)  # two digits, and a step
    free = force[:last].max()
    assert free == 0.0 if gate else free < 0.0  # ungated damping pulls
