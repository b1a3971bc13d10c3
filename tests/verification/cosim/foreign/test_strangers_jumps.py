"""A foreign bumper whose force jumps as its gap closes: steps are divided there.

Two masses of 1 kg on springs to ground; the bumper has 4e4 N/m and 40 N s/m beyond a gap of 5 mm.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.foreign.c_fmu import compiled_fmu
from support.foreign.reel import description
from support.foreign.strangers import write_system

import herringbone as hb

FMUS = Path(__file__).parents[3] / "fmus"
STIFFNESS, DAMPING, GAP, GROUND = 4e4, 40.0, 5e-3, (400.0, 2000.0)
T_END, RECORD = 0.1, 1e-3
SPEEDS = np.linspace(0.8, 1.2, 4)
"""Of the first mass [m/s]: contact begins at other places of a step."""
STEP = 2.5e-4
JOINED = [
    ["one.x", "bumper.x1"], ["one.v", "bumper.v1"], ["two.x", "bumper.x2"],
    ["two.v", "bumper.v2"], ["bumper.f1", "one.f"], ["bumper.f2", "two.f"],
]  # fmt: skip


@pytest.fixture(scope="module")
def system(kinds, tmp_path_factory):
    folder = tmp_path_factory.mktemp("bumper")
    told = description("bumper", "x1 v1 x2 v2", "f1 f2", "k d gap", saves=True)
    bumper = compiled_fmu(FMUS / "bumper.c", told.replace('start="150"', 'start="0"'), folder)
    mass = kinds / "oscillator_mass.fmu"
    return write_system(folder, "bump", JOINED, {"one": mass, "two": mass, "bumper": bumper})


def run(system, speed, **more):
    values = {"one.k": GROUND[0], "two.k": GROUND[1], "one.v0": speed}
    values |= {"bumper.k": STIFFNESS, "bumper.d": DAMPING, "bumper.gap": GAP}
    asked = {"record_step": RECORD, "t_end": T_END, "start": "rest", "values": values}
    return hb.run(system, **asked | more)


def exact(speed, times):
    """Displacements and velocities (times, 4), from contact to contact."""

    def push(y):
        return STIFFNESS * (y[0] - y[1] - GAP) + DAMPING * (y[2] - y[3])

    def meets(_t, y, _touches):
        return y[0] - y[1] - GAP

    def parts(_t, y, _touches):
        return -push(y)

    def rate(_t, y, touches):
        force = push(y) if touches else 0.0
        return [y[2], y[3], -GROUND[0] * y[0] - force, -GROUND[1] * y[1] + force]

    y, t, touches, rows = np.array([0.0, 0.0, speed, 0.0]), 0.0, False, []
    for event in (meets, parts):
        event.terminal, event.direction = True, 1
    while t < T_END:
        event = parts if touches else meets
        found = solve_ivp(
            rate, (t, T_END), y, method="DOP853", events=event, rtol=1e-12, atol=1e-14,
            dense_output=True, args=(touches,), max_step=1e-3,
        )  # fmt: skip
        inside = times[(times >= t) & (times <= found.t[-1])]
        rows += list(found.sol(inside).T)
        t, y, touches = found.t[-1], found.y[:, -1], not touches
    return np.array(rows)


def error(found, speed):
    """Of the velocities, rms over rms."""
    data = found.data
    true = exact(speed, data["time"].to_numpy())[:, 2:]
    return np.linalg.norm(data[["one.v", "two.v"]].to_numpy() - true) / np.linalg.norm(true)


def test_steps_with_a_jump_are_divided(system):
    """Where a tolerance is asked for; fixed steps stay as they are, of whose stability is told."""
    for speed in SPEEDS:
        found = run(system, speed, tolerance=1e-2)
        assert any("jump or bend" in note for note in found.info.notes)
        fixed = run(system, speed, algorithm="li:degree=3", step=STEP)
        assert not any("jump or bend" in note for note in fixed.info.notes)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_tolerance_is_kept(system, tolerance):
    """Told are errors of all groups, and forces err most: more than the velocities."""
    for speed in SPEEDS[:2]:
        found = run(system, speed, tolerance=tolerance)
        told = max(found.verification.groups.values())
        assert error(found, speed) < tolerance
        assert told < tolerance
