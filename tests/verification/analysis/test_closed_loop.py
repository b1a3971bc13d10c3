"""Two gearboxes in a closed loop whose ratios do not fit: no shaft can turn steadily."""

import re

import pytest

from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.rigid_rotation import opposed_speed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import EquilibriumError
from herringbone.running.prepared import Wishes, prepared

LONGER = 1.03
"""Base radius of one wheel over that of the other."""


@pytest.fixture(scope="module")
def loop():
    """One that fits, as it starts."""
    return prepared("back_to_back", "loaded", Wishes()).system


def test_ratios_that_do_not_fit(loop):
    """A coupling's twist rate is the difference of the wheels' speeds, r_p / r_w of each."""
    mesh = next(x for x in Twin(loop).instances if x.name == "second.gear_mesh")
    pinion, wheel = mesh["pinion.base_radius"], mesh["wheel.base_radius"]
    system = loop.with_values({"second.gear_mesh.wheel.base_radius": LONGER * wheel})
    with pytest.raises(EquilibriumError, match="ratios around a closed loop") as caught:
        equilibrium(system)
    told = re.search(r"load_clutch\.w_rel is (\S+) rad/s where all else turns", str(caught.value))
    assert told is not None
    ratio = pinion / wheel
    assert float(told[1]) == pytest.approx(ratio * (1.0 - 1.0 / LONGER), rel=5e-3)


def test_ratios_that_fit(loop):
    twin = Twin(loop)
    assert opposed_speed(twin, twin.state, "load_clutch.w_rel") is None
