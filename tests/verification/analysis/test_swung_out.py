"""Even rotation of drivetrains in which Newton's method opens a mesh and leaves it open."""

import numpy as np
import pytest

from herringbone.analysis.equilibrium import even_acceleration
from herringbone.analysis.rigid_rotation import names_of_states, steady_rows
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.registry import COMPONENTS
from herringbone.running.loading import load_system
from herringbone.running.prepared import Wishes, prepared

SPEED, TORQUE, RATIO = 104.7, -1500.0, 3.0
SYSTEM = f"""
name = "stages"
connections = [
  ["first.wheel", "middle.flange_a"], ["middle.flange_b", "second.pinion"],
  ["second.wheel", "shaft.flange_a"], ["shaft.flange_b", "rotor.flange_a"],
  ["rotor.flange_b", "fan.flange"],
]
[parts]
first = {{ system = "gearbox" }}
middle = {{ component = "shaft_coupling" }}
second = {{ system = "gearbox" }}
shaft = {{ component = "shaft_coupling" }}
rotor = {{ component = "rotating_inertia" }}
fan = {{ component = "torque_source", set = {{ nominal_torque = {TORQUE}, constant_share = 1.0 }} }}
"""


def inertia_of(component, name="inertia"):
    return COMPONENTS[component].declaration.variable(name).start


def test_two_stages_that_a_load_stops(tmp_path):
    """Newton's law of the whole: what drives is a foreign part, which has not answered yet."""
    (tmp_path / "system.toml").write_text(SYSTEM, encoding="utf-8")
    system = load_system(tmp_path)[0].with_values({"first.gear_mesh.der(angle)": SPEED})
    twin = Twin(system.with_values(even_acceleration(system)))
    rates = dict(zip(names_of_states(twin), twin.rhs(0.0, twin.state), strict=True))
    pinion, wheel = (2.0 * inertia_of("gear_mesh", f"{g}.inertia") for g in ("pinion", "wheel"))
    stage = pinion + wheel / RATIO**2
    inertia = stage + stage / RATIO**2 + inertia_of("rotating_inertia") / RATIO**4
    # Half of the squared deflection, 1e-5 m, times the slope of the mesh stiffness, 3e9 N/m a rad.
    slope = 2.0 * 0.5 * 3e9 * (1e-5) ** 2
    found = rates["first.gear_mesh.der(angle)"]
    assert found == pytest.approx(TORQUE / RATIO**2 / inertia, abs=slope / inertia)
    for path, ratio in (("second.gear_mesh.der(angle)", RATIO), ("rotor.speed", RATIO**2)):
        assert rates[path] == pytest.approx(found / ratio, rel=1e-6), path
    forces = [f"{box}.gear_mesh.mesh_left.force" for box in ("first", "second")]
    assert (twin.observe(np.zeros(1), twin.state[:, None], forces)[0] > 0.0).all()


@pytest.mark.parametrize("clearance", [1e-5, 1e-4])
@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_a_shaft_within_its_clearance_whose_speed_is_held(gear, clearance):
    """A controller holds the speed; the shaft hangs free at the start, and nothing holds its teeth.

    Both bearings carry the mesh force, whose torque is that of the rig, in the mean over a mesh:
    its energy changes by less than 1e-4 of the torque.
    """
    values = {f"gearbox.bearing_supports.{gear}.radial_clearance": clearance}
    start = prepared("test_rig", None, Wishes(values=values)).system
    twin = Twin(start)
    rates = np.delete(twin.rhs(0.0, twin.state), steady_rows(twin)[0])
    assert np.abs(rates).max() < 1e-4
    columns = [f"gearbox.gear_mesh.mesh_{side}.force" for side in ("left", "right")]
    force = twin.observe(np.zeros(1), twin.state[:, None], columns)[0].sum()
    mesh = COMPONENTS["gear_mesh"].declaration
    arm = mesh.variable("pinion.base_radius").start * np.cos(
        mesh.variable("base_helix_angle").start
    )
    assert force * arm == pytest.approx(200.0, rel=1e-3)
