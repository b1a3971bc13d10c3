"""Limits that runs show where a foreign part has a clock: only steps that go with it are tried."""

import json

from support.foreign.kinds import build_kinds
from support.foreign.strangers import write_system

from herringbone.commands import main as cli

OWN = """
disc = { component = "rotating_inertia", set = { inertia = 0.1 } }
shaft = { component = "shaft_coupling", set = { stiffness = 1e3, damping = 30.0 } }
"""
JOINED = [
    ["shaft.flange_b.tau", "load.tau"],
    ["load.phi", "shaft.flange_b.phi"],
    ["load.w", "shaft.flange_b.w"],
    ["disc.flange_a", "shaft.flange_a"],
]


def test_runs_show_the_predicted_step(tmp_path, capsys):
    """A rotor in inner steps of 0.1 ms at a disc, all linear: the same step of the grid."""
    folder = build_kinds(tmp_path, "c_fixed_step_rotor.c")
    system = write_system(folder, "ticks", JOINED, {"load": folder / "c_fixed_step_rotor.fmu"})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(OWN)
    asked = ["--simulate", "--json", "--algorithm", "jacobi:order=0", "jacobi:order=2"]
    assert cli.main(["stability", str(system), *asked]) == 0
    zero, two = json.loads(capsys.readouterr().out)["algorithms"]
    assert zero["limit"] is zero["simulated_limit"] is None  # stable up to where the scan ends
    assert two["limit"] == two["simulated_limit"] < 2e-3
    ticks = two["limit"] / 1e-4
    assert abs(ticks - round(ticks)) < 1e-9
