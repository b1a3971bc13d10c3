"""Steady starts of the gearbox at any torque: on the flank that the load asks for, or refused."""

import math

import numpy as np
import pytest

import herringbone as hb
from herringbone.core import EquilibriumError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.pairs.open_flanges import balanced, unbalanced
from herringbone.running.prepared import Wishes, prepared

RUN = {"t_end": 2e-3, "fmu": "in-process"}
SPEED, BASE_RADIUS, RATIO, HELIX = 1000.0 * math.pi / 30.0, 50.298e-3, 3.0, 0.4891167
COAST = "gear_mesh: the coast flank carries; y is its line of action"
PINION, WHEEL = "gear_mesh.pinion.tau", "gear_mesh.wheel.tau"


def start(**values):
    return prepared("gearbox", None, Wishes(values=values))


@pytest.mark.parametrize("deviation", [0.0, 1e-5])
@pytest.mark.parametrize("torque", [50.0, 1000.0, 4500.0, 6000.0, -50.0, -1000.0, -4500.0])
def test_start_under_any_torque(torque, deviation):
    """The search is caught between the phases where torques balance, from half of all angles.

    The speed stays but for what the search moves it; bearings carry T / r_b. Beyond the table the
    law is a straight line.
    """
    values = {PINION: torque, "gear_mesh.symmetry_deviation": deviation}
    found = start(**values)
    assert (COAST in found.notes) == (torque < 0.0)
    gear = found.system.part("gear_mesh").values
    assert gear["der(angle)"] == pytest.approx(SPEED, rel=1e-4)
    assert gear.get("flank", 1.0) == math.copysign(1.0, torque)
    assert found.system.part("bearing_supports").values.get("flank", 1.0) == gear.get("flank", 1.0)
    result = hb.run("gearbox", values=values, t_end=4e-5, fmu="in-process")
    first = result.data.iloc[0]
    forces = [first[f"bearing_supports.shaft.pinion_{side}.f_y"] for side in ("left", "right")]
    assert abs(sum(forces)) == pytest.approx(abs(torque) / BASE_RADIUS, rel=1e-2)


def test_coast_load_is_quiet_and_its_forces_are_negative():
    """Mean normal force of a half: T / (2 r_b cos(beta_b))."""
    drive, coast = (
        hb.run("gearbox", values={PINION: torque}, **RUN | {"t_end": 0.02})
        for torque in (200.0, -200.0)
    )
    assert COAST in coast.info.notes
    assert not any("flank is loaded" in note for note in coast.info.notes)
    normal = 200.0 / (2.0 * BASE_RADIUS * math.cos(HELIX))
    for side in ("left", "right"):
        force = coast[f"gear_mesh.mesh_{side}.force"]
        assert force.max() < 0.0
        assert force.mean() == pytest.approx(-normal, rel=2e-3)
        rms = [run[f"gear_mesh.mesh_{side}.force"].std() for run in (drive, coast)]
        assert rms[1] == pytest.approx(rms[0], rel=0.5)
    quiet = coast["bearing_supports.shaft.pinion_left.f_y"].to_numpy()
    early, late = np.array_split(np.abs(quiet - quiet.mean()), 2)
    assert early.max() < 2.0 * late.max()


def test_flank_set_by_name_stays():
    """That of the coast flank under coast load is what is found; the other one is refused."""
    both = {"gear_mesh.flank": -1.0, "bearing_supports.flank": -1.0}
    named, found = start(**{PINION: -200.0}, **both), start(**{PINION: -200.0})
    assert COAST not in named.notes
    assert named.system.part("gear_mesh").values == found.system.part("gear_mesh").values
    with pytest.raises(EquilibriumError, match="flank of gear_mesh or of its bearings is set by"):
        start(**{PINION: 200.0}, **both)


# -- torques that are given -----------------------------------------------------------------------


@pytest.mark.parametrize(("gear", "other"), [("pinion", "wheel"), ("wheel", "pinion")])
def test_torque_left_out_balances_the_other(gear, other):
    system = read_system("gearbox").with_values({f"gear_mesh.{gear}.tau": 90.0})
    given = balanced(system).part("gear_mesh").values
    ratio = RATIO if gear == "pinion" else 1.0 / RATIO
    assert given[f"{other}.tau"] == pytest.approx(-90.0 * ratio, rel=1e-12)
    assert unbalanced(balanced(system)) == ()
    joined = read_system("test_rig").with_values({f"gear_mesh.{gear}.tau": 90.0})
    assert balanced(joined) == joined


@pytest.mark.parametrize("wheel", [-200.0, 600.0, 0.0])
def test_torques_that_do_not_balance_are_named(wheel):
    said = f"{PINION} = 200 N m is balanced by -600 N m at the wheel, {WHEEL} is {wheel:g} N m"
    with pytest.raises(EquilibriumError, match=said):
        start(**{PINION: 200.0, WHEEL: wheel})
    notes = hb.run("gearbox", values={PINION: 200.0, WHEEL: wheel}, start="rest", **RUN).info.notes
    assert any(note.startswith(said) for note in notes)
