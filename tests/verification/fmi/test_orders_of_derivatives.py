"""A gearbox FMU along derivatives of its inputs, of any order and in long steps."""

import math

import pytest
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host

from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.running.exporting.system_fmu import export_fmu

pytestmark = needs_compiler
SPEED, RATIO = 100.0 * math.pi / 3.0, 3.0
STEP, STEPS = 1e-3, 20


@pytest.fixture(scope="module")
def turned(tmp_path_factory):
    file = tmp_path_factory.mktemp("turned") / "gearbox.fmu"
    wanted = Wanted(given={"pinion": Given.SPEED, "wheel": Given.MOTION})
    return export_fmu("gearbox", file, wanted=wanted)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_even_speed_along_derivatives_is_even_speed(turned, tmp_path, order):
    """Four nodes are 0.25 ms, ten pieces of 25 us but for rounding: of that a step had been made.

    What a step errs is told by its curvature over that of the one before, of 4e-19 s there: no
    step of the next piece was short enough, and the communication step was refused. The highest
    derivative is 1e-9 of its unit, as none is passed on that is zero.
    """
    found = {}
    for highest in (0, order):
        host = Fmi2Host(turned, tmp_path / str(highest))
        for k in range(STEPS):
            now = {
                "pinion.w": SPEED,
                "wheel.w": SPEED / RATIO,
                "wheel.phi": SPEED / RATIO * k * STEP,
            }
            host.set(now)
            for n in range(1, highest + 1):
                slope = SPEED / RATIO if n == 1 else 1e-9
                host.slave.setRealInputDerivatives([host.reference["wheel.phi"]], [n], [slope])
            host.step(k * STEP, STEP)
        found[highest] = host.get("mesh_left.force", "wheel.tau")
    assert found[order] == pytest.approx(found[0], rel=1e-3)  # the tolerance
