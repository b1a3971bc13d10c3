"""A foreign part with play: its feedthrough D is 0 at the start, and that of a spring in contact.

Two masses, a spring of 4e4 N/m between them beyond 5 mm of play; contact after 12 ms, or sooner.
"""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from support.foreign.strangers import write_system

import herringbone as hb

PLAY, CONTACT, GROUND = 5e-3, 4e4, np.array([100.0, 1000.0])
T_END, RECORD = 0.04, 2e-3
SPEEDS = np.linspace(0.45, 0.55, 8)
"""Of the first mass [m/s]: contact begins at other places of a step."""
KINK = CONTACT * SPEEDS[-1] / 8.0 * T_END / PLAY
"""Error over h^2 [1/s2]: a force that begins to rise by k v inside a step errs by k v h^2 / 8 of
impulse at most, which moves a mass of 1 kg until the end, over displacements like the play."""
STEPS = np.array([1e-3, 5e-4, 2.5e-4, 1.25e-4])


@pytest.fixture(scope="module")
def system(kinds, tmp_path_factory):
    files = {
        name: kinds / f"oscillator_{kind}.fmu" for name, kind in (("one", "play"), ("two", "mass"))
    }
    joined = [["one.fo", "two.f"], ["two.x", "one.xo"]]
    return write_system(tmp_path_factory.mktemp("play"), "play", joined, files)


def run(system, speed, step):
    values = {"one.k": GROUND[0], "two.k": GROUND[1], "one.ko": CONTACT, "one.gap": PLAY}
    return hb.run(
        system, algorithm="li:degree=3", step=step, record_step=RECORD, t_end=T_END, start="rest",
        values=values | {"one.v0": speed},
    )  # fmt: skip


def exact(speed):
    def rate(_t, y):
        apart = y[0] - y[1]
        force = CONTACT * np.sign(apart) * max(0.0, abs(apart) - PLAY)
        return [y[2], y[3], -GROUND[0] * y[0] - force, -GROUND[1] * y[1] + force]

    times = np.arange(0.0, T_END + RECORD / 2, RECORD)
    found = solve_ivp(
        rate, (0.0, T_END), [0.0, 0.0, speed, 0.0], method="DOP853", t_eval=times, rtol=1e-11,
        atol=1e-13, max_step=2e-5,
    )  # fmt: skip
    return found.y[:2].T


def test_second_order_with_contact(system):
    """The kink of the force inside a step costs h^2, by chance of its place: a mean over eight.

    With the feedthrough of the start the coupling is of first order, and errs 2.6 % at 0.5 ms.
    """
    wanted = [exact(speed) for speed in SPEEDS]
    off = np.empty((STEPS.size, SPEEDS.size))
    for i, step in enumerate(STEPS):
        for k, speed in enumerate(SPEEDS):
            found = run(system, speed, step).data[["one.x", "two.x"]].to_numpy()
            off[i, k] = np.linalg.norm(found - wanted[k]) / np.linalg.norm(wanted[k])
    rms = np.sqrt((off**2).mean(axis=1))
    assert np.polyfit(np.log(STEPS), np.log(rms), 1)[0] == pytest.approx(2.0, abs=0.3)
    assert (rms < KINK * STEPS**2).all()


def test_fourth_order_before_contact(system):
    """Nothing that is measured anew disturbs: without contact both masses are exact."""
    data = hb.run(
        system, algorithm="li:degree=3", step=1e-3, record_step=1e-3, t_end=0.008, start="rest",
        values={"one.k": GROUND[0], "two.k": GROUND[1], "one.ko": CONTACT, "one.gap": PLAY,
                "one.v0": 0.5},
    ).data  # fmt: skip
    time, w = data["time"].to_numpy(), np.sqrt(GROUND[0])
    assert data["one.x"].to_numpy() == pytest.approx(0.5 / w * np.sin(w * time), rel=1e-10)
    assert (data["two.x"] == 0.0).all()
