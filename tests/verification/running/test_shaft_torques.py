"""Torques of shafts count from drive to load, whichever flange of a coupling the gear is at."""

from dataclasses import replace

import pytest

import herringbone as hb
from herringbone.analysis.asked import shaft_torques
from herringbone.analysis.figures.operating_point import power_balance
from herringbone.cosim.structure.system_file import read_system

OTHER = {"flange_a": "flange_b", "flange_b": "flange_a"}


def turned_around(path, coupling):
    part, _, port = path.rpartition(".")
    return f"{part}.{OTHER[port]}" if part == coupling else path


def torques(run):
    rows = run.data["time"] > 0.01
    return {
        place: found.sign * run.data[found.column][rows].mean()
        for place, found in shaft_torques(run).items()
    }


@pytest.mark.parametrize("coupling", ["drive_coupling", "load_coupling"])
def test_a_coupling_the_other_way_round(coupling):
    system = read_system("test_rig")
    joined = tuple(
        tuple(turned_around(path, coupling) for path in pair) for pair in system.connections
    )
    run = hb.run(replace(system, connections=joined), fuse=True, t_end=0.03, torque=200.0)
    assert torques(run) == pytest.approx({"pinion": 200.0, "wheel": 600.0}, rel=1e-2)
    balance = power_balance(run)
    assert balance is not None
    assert balance.circulating > 0.0


def test_a_wheel_that_drives_has_negative_torques():
    """As the electric axle, when it coasts."""
    run = hb.run("turbine", fuse=True, t_end=0.03)
    assert max(torques(run).values()) < 0.0
