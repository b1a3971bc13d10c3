"""Strangers' parts in C of FMI 3.0 in a mechanical loop: they are coupled as those of FMI 2.0 are.

Events, early return and inputs within a step are used at once there, in steps that are repeated.
"""

import math

import numpy as np
import pytest
from support.foreign.c_housing import c_housing_fmu
from support.foreign.drivetrain import EVENTS, VALUES, WITHIN, drivetrain, error, exact, turned

import herringbone as hb

STEP = 2.5e-4
BEGINS = 3.21e-3
"""When the motor's own torque comes, within a step [s]."""
NEVER = 1.0
STATED = {"fourth order in the step": 4.0, "falls from order 4 to 3 in the step": 3.0}
"""What lines on parts say of the order."""


def missed_kink() -> float:
    """Most that polynomials over a step may miss of a torque that bends within it, of the twist.

    The damper's torque bends by d T / J1, so that it is off by d T H / J1 for H at most.
    """
    one, two = VALUES["motor.inertia"], VALUES["load.inertia"]
    together = 1.0 / one + 1.0 / two
    frequency = math.sqrt(VALUES["shaft.stiffness"] * together)
    bend = VALUES["shaft.damping"] * VALUES["motor.own"] / one
    twist = np.ptp(exact(np.linspace(0.0, 0.02, 201), BEGINS)[:, [0, 2]], axis=1).max()
    return bend * STEP**2 * together / frequency / twist


@pytest.mark.parametrize(
    ("versions", "saves"),
    [
        ({"two": (2, ""), "three": (3, ""), "events": (3, EVENTS)}, True),
        ({"two": (2, ""), "events": (3, EVENTS)}, False),
        ({"within": (3, WITHIN), "events": (3, f"{WITHIN} {EVENTS}")}, True),
    ],
    ids=["restores", "plain", "within"],
)
def test_an_event_within_a_step(tmp_path, versions, saves):
    """Whoever stops for it, the FMU or the master, the same bits, and one event, also where steps
    are repeated; a torque that came with the next step would be off by a hundredth."""
    runs = {
        name: turned(drivetrain(tmp_path / name, fmi, abilities, saves=saves), STEP, BEGINS)
        for name, (fmi, abilities) in versions.items()
    }
    first, *others = runs.values()
    for run in runs.values():
        assert run.outcome.completed
        assert set(run["motor.events"]) == {0.0, 1.0}
        assert (run.info.passes["motor"] > run.info.macro_steps) == saves
    for other in others:
        np.testing.assert_array_equal(other.data.to_numpy(), first.data.to_numpy())
    if saves and "within" not in versions:
        assert error(first, BEGINS) < missed_kink() < 1e-3


@pytest.mark.parametrize("abilities", [EVENTS, WITHIN], ids=["held", "within"])
def test_order_of_the_coupling(tmp_path, abilities):
    """The slope that lines on the parts state, from 0.5 to 0.25 ms."""
    system = drivetrain(tmp_path, 3, abilities)
    runs = [turned(system, step, NEVER) for step in (2.0 * STEP, STEP)]
    order = min(n for text, n in STATED.items() if text in " ".join(runs[0].info.notes))
    errors = [error(run, NEVER) for run in runs]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


def test_who_declares_to_ask_within_a_step_and_never_does_is_told(tmp_path):
    """Its inputs are held at their means: second order, where nothing passes them directly."""
    system = drivetrain(tmp_path, 3, WITHIN, asks=False)
    coarse, fine = (turned(system, step, NEVER) for step in (2.0 * STEP, STEP))
    said = "says: it declares intermediate update, and asked for no input in"
    told = [note for note in fine.info.notes if said in note]
    assert len(told) == 2
    assert all("makes the coupling second order in the step; what a line" in note for note in told)
    assert math.log2(error(coarse, NEVER) / error(fine, NEVER)) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("saves", [True, False], ids=["restores", "plain"])
def test_a_housing_moves_as_the_same_one_of_fmi2(tmp_path, saves):
    """On the rig, by the default algorithm."""
    runs = []
    for fmi in (2, 3):
        place = tmp_path / str(fmi)
        place.mkdir()
        housing = c_housing_fmu(place, ("SAVES",) if saves else (), fmi=fmi, saves=saves)
        runs.append(
            hb.run(
                "test_rig", replace_parts={"modal_housing": housing}, start="ramp", t_end=5e-4,
                step=2e-5, record_step=2e-5,
            )
        )  # fmt: skip
    two, three = runs
    assert np.ptp(two.data[two.columns("modal_housing.*.v_y")].to_numpy()) > 0.0
    np.testing.assert_array_equal(three.data.to_numpy(), two.data.to_numpy())
    assert three.info.passes == two.info.passes
    repeated = two.info.passes["gearbox.modal_housing"] > two.info.macro_steps
    assert repeated == saves
    assert not [note for note in three.info.notes if "contract" in note]
