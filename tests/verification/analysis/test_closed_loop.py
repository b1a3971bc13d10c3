"""Two shafts that are joined twice, by ratios that do not fit: they cannot turn together."""

import re

import pytest

from herringbone.analysis.rigid_rotation import names_of_states, opposed_speed
from herringbone.analysis.rotation_search import steady_rotation
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.cosim.structure.system_file import read_system

SYSTEM = """
name = "loop"
connections = [
  ["first.flange_a", "coupling.flange_a"],
  ["second.flange_a", "coupling.flange_b"],
  ["first.flange_b", "gears.flange_a"],
  ["second.flange_b", "gears.flange_b"],
]
[parts]
first = {{ component = "rotating_inertia" }}
second = {{ component = "rotating_inertia" }}
coupling = {{ component = "shaft_coupling" }}
gears = {{ component = "geared_shaft", set = {{ ratio = {ratio} }} }}
"""


def loop(folder, ratio):
    (folder / "system.toml").write_text(SYSTEM.format(ratio=ratio), encoding="utf-8")
    system = read_system(folder)
    return system, Twin(system)


def test_what_is_left_where_ratios_do_not_fit(tmp_path):
    """Coupling: 1 - 1/r of the first shaft's speed, gears: r - 1, each where the other holds."""
    ratio = 1.03
    system, twin = loop(tmp_path, ratio)
    told = {
        path: abs(opposed_speed(twin, twin.state, path))
        for path in ("coupling.w_rel", "gears.w_rel")
    }
    assert told == pytest.approx(
        {"coupling.w_rel": 1.0 - 1.0 / ratio, "gears.w_rel": ratio - 1.0}, rel=1e-6
    )
    speed, x = names_of_states(twin).index("first.speed"), twin.state.copy()
    x[speed] = 100.0
    with pytest.raises(EquilibriumError, match="ratios around a closed loop") as caught:
        steady_rotation(system, twin, [speed], x)
    path, share = re.search(
        r"(\S+) is (\S+) rad/s where all else turns", str(caught.value)
    ).groups()
    assert float(share) == pytest.approx(told[path], rel=5e-3)


def test_ratios_that_fit(tmp_path):
    _, twin = loop(tmp_path, 1.0)
    assert opposed_speed(twin, twin.state, "coupling.w_rel") is None
