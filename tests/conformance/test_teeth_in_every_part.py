"""Teeth that deviate: Python and native FMUs have the bits of the part in the process."""

import math

import numpy as np
import pytest
from support.fmus import H, outputs
from support.gearing.deviating_teeth import PAIR, write_law, write_teeth

from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.core import Instance
from herringbone.core.declaring.roles import HALVES
from herringbone.gears.stiffness.slices import SliceMesh

STEPS = 100
LOAD = {
    "pinion.tau": 200.0,
    "wheel.tau": -600.0,
    **{f"{half}.f_y": -1988.0 if half.startswith("wheel") else 1988.0 for half in HALVES},
}
"""Torque and what the bearings would bear of it."""
START = {"approach": 4e-6, "der(angle)": 100.0, "ramp_turns": 0.02, "impact_force": 50.0, **LOAD}

_DEFAULTS = Instance(GEAR_MESH, "defaults")
_CLOSED = -_DEFAULTS["backlash"] / math.cos(_DEFAULTS["base_helix_angle"])
COAST = {
    **START,
    **{name: -value for name, value in LOAD.items()},
    "approach": _CLOSED - START["approach"],
    "flank": -1.0,
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("teeth")
    law = write_law(folder / "law.csv", SliceMesh(PAIR, slices=60))
    teeth = write_teeth(folder / "teeth.csv", 6, coast=True)
    return {"pair_law": str(law), "tooth_deviations": str(teeth)}


def in_process(values):
    part, names = Instance(GEAR_MESH, "part"), outputs("gear_mesh")
    for name, value in values.items():
        part.set(name, value)
    part.initialise()
    rows = []
    for n in range(STEPS):
        assert part.step(n * H, H) == 0
        rows.append([part[name] for name in names])
    return np.array(rows)


@pytest.mark.parametrize("flank", [1.0, -1.0])
def test_same_bits_in_every_kind_of_part(started, files, flank):
    """On the coast flank loads and depths are the other way round."""
    start = START if flank > 0.0 else COAST
    host, rows = started("gear_mesh", **start, **files), []
    for n in range(STEPS):
        host.step(n * H, H)
        rows.append(host.values(*outputs("gear_mesh")))
    wanted = in_process(start | files)
    np.testing.assert_array_equal(rows, wanted)
    force = outputs("gear_mesh").index("mesh_left.force")
    assert (flank * wanted[:, force]).min() > 100.0
    assert np.abs(wanted[:, force] - in_process(start)[:, force]).max() > 100.0
