"""Declared laws: taken apart and put together, the equations are those of the kernels."""

import numpy as np
import pytest
from support.gearing.deviating_teeth import PAIR, write_law, write_teeth

from herringbone.components.registry import COMPONENTS
from herringbone.core import Instance
from herringbone.gears.stiffness.slices import SliceMesh

WITH_LAWS = [name for name, c in COMPONENTS.items() if c.laws]
TIME = 0.013
"""Inside of the ramp of a torque source's orders [s]."""
MOVING = {
    "gear_mesh": {
        "approach": 7e-6, "angle": 0.4, "pinion_twist": 3e-5, "wheel_twist": -1e-5,
        "z_1": 2e-6, "y_2": -1e-6, "der(angle)": 100.0, "der(approach)": 2e-3, "der(z_3)": 1e-3,
        "symmetry_deviation": 1e-5, "drag_torque": 3.0, "pinion.tau": 200.0,
    },
    "bearing_supports": {
        "shaft.pinion_left.s_y": 3e-5, "shaft.pinion_right.s_y": 2e-6,
        "shaft.wheel_left.s_z": 1e-6, "shaft.wheel_right.v_y": 1e-3,
        "seat.pinion_left.v_x": 2e-3, "pinion.radial_clearance": 2e-5,
    },
    "drive_motor": {
        "speed": 90.0, "speed_reference": 100.0, "speed_setpoint": 150.0, "integral": 1.0,
    },
    "torque_source": {
        "flange.phi": 0.7, "flange.w": 40.0, "torque_setpoint": 5.0, "nominal_torque": -100.0,
        "quadratic_share": 1.0, "linear_share": 0.1, "dry_share": 0.3, "order_1.order": 4.0,
        "order_1.amplitude": 3.0,
    },
    "geared_shaft": {
        "flange_a.phi": 2e-3, "flange_a.w": 60.0, "flange_b.w": 20.0, "ratio": 3.0,
        "efficiency": 0.95,
    },
    "freewheel": {"flange_a.phi": 5e-4, "flange_a.w": 1.0, "flange_b.w": 0.9},
}  # fmt: skip


def moving(name, **more):
    instance = Instance(COMPONENTS[name], name)
    for variable, value in {**MOVING[name], **more}.items():
        instance.set(variable, value)
    instance.initialise()
    return instance


def taken_apart(instance, t=TIME):
    """Arguments, values, tangents, and the block and derivatives that they give."""
    laws = instance.component.laws
    b = instance.block.copy()
    z, f = np.zeros(len(laws.arguments)), np.zeros(len(laws.values))
    k, e = np.zeros(len(laws.stiff)), np.zeros(laws.kinks)
    dx = np.zeros(max(1, instance.component.declaration.state_count))
    laws.prepare(b)
    if laws.clock is not None:
        b[laws.clock] = t
    laws.gather(b, z)
    laws.evaluate(b.copy(), z, f, k, e)
    laws.apply(b, t, f, dx)
    return z, f, k, b, dx


def connected(name):
    """Outputs that other parts take: those of ports."""
    declaration = COMPONENTS[name].declaration
    return [declaration.index[v.name] for v in declaration.outputs if v.name.count(".") > 0
            and not v.name.startswith("mesh_")]  # fmt: skip


@pytest.mark.parametrize("name", WITH_LAWS)
def test_laws_and_rest_are_the_equations(name):
    """Rounding alone, of the sums that are made in another order."""
    instance = moving(name)
    component = instance.component
    rates = np.zeros(max(1, component.declaration.state_count))
    component.kernels.out(instance.block, TIME)
    component.kernels.rhs(instance.block, TIME, rates)
    *_, b, dx = taken_apart(instance)
    assert np.abs(rates).max() > 1.0 or len(rates) == 1
    assert dx == pytest.approx(rates, rel=1e-12, abs=1e-12 * np.abs(rates).max())
    out = connected(name)
    assert np.abs(b[out]).max() > 0.1
    assert b[out] == pytest.approx(instance.block[out], rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("name", WITH_LAWS)
def test_tangents(name):
    """Declared tangents against differences; the slope of the damping's gate is left out."""
    instance = moving(name)
    laws = instance.component.laws
    z, f, k, *_ = taken_apart(instance)
    b = instance.block.copy()
    laws.prepare(b)
    if laws.clock is not None:
        b[laws.clock] = TIME
    directions = laws.directions(b)
    assert (laws.mean(b) * k >= 0.0).all()
    for row, value, tangent in zip(directions, laws.stiff, k, strict=True):
        step = 1e-9 * row / (row @ row)
        found = np.zeros_like(f)
        laws.evaluate(b, z + step, found, np.zeros_like(k), np.zeros(laws.kinks))
        assert (found[value] - f[value]) / 1e-9 == pytest.approx(tangent, rel=2e-3, abs=1e-3)


def test_laws_of_deviating_teeth(tmp_path):
    law = write_law(tmp_path / "law.csv", SliceMesh(PAIR, slices=60))
    teeth = write_teeth(tmp_path / "teeth.csv", 6)
    gear = moving("gear_mesh", pair_law=str(law), tooth_deviations=str(teeth), ramp_turns=0.0)
    rates = np.zeros(24)
    gear.component.kernels.rhs(gear.block, 0.0, rates)
    assert taken_apart(gear)[-1] == pytest.approx(rates, rel=1e-12, abs=1e-9)
    assert abs(taken_apart(gear)[1][4]) > 0.0


def test_tangents_of_teeth_that_touch_by_an_edge(tmp_path):
    """The spline's tangent is below zero in places there; the damping's root has none."""
    law = write_law(tmp_path / "law.csv", SliceMesh(PAIR, slices=60))
    teeth = write_teeth(tmp_path / "teeth.csv", 7)
    gear = moving("gear_mesh", pair_law=str(law), tooth_deviations=str(teeth), ramp_turns=0.0)
    laws, b = gear.component.laws, gear.block.copy()
    laws.prepare(b)
    z, f, e = np.zeros(len(laws.arguments)), np.zeros(len(laws.values)), np.zeros(laws.kinks)
    laws.gather(b, z)
    approach, angle = laws.arguments.index("approach"), laws.arguments.index("angle")
    every = []
    for z[angle] in np.linspace(0.0, 6.0, 61):
        for z[approach] in np.linspace(-3e-5, 1e-5, 41):
            k = np.zeros(len(laws.stiff))
            laws.evaluate(b.copy(), z, f, k, e)
            every.append(k)
    assert np.isfinite(every).all()
    assert np.min(every) < 0.0  # of the elastic force; the damping has none below zero
    assert np.array(every)[:, 2:].min() == 0.0


def test_what_cannot_be_taken_apart():
    gear = moving("gear_mesh")
    assert gear.component.laws.refusal(gear.block) == ""
    heavy = moving("gear_mesh", **{"pinion.unbalance": 1e-4})
    assert "pinion.unbalance = 0.0001 kg.m" in heavy.component.laws.refusal(heavy.block)
    bearing = moving("bearing_supports")
    assert bearing.component.laws.needed(bearing.block)
    assert not bearing.component.laws.needed(
        moving("bearing_supports", **{"pinion.radial_clearance": 0.0}).block
    )


def test_freewheel_that_is_overrun():
    """No torque, and the free angle follows."""
    instance = moving("freewheel", **{"flange_a.phi": -1e-4, "flange_a.w": 0.0})
    rates = np.zeros(1)
    instance.component.kernels.rhs(instance.block, TIME, rates)
    instance.component.kernels.out(instance.block, TIME)
    _, f, k, b, dx = taken_apart(instance)
    assert rates[0] == dx[0] == pytest.approx(-1e-4 / 1e-3)
    assert f[0] == 0.0
    assert k.tolist() == [0.0, 0.0, 1.0]
    assert b[connected("freewheel")] == pytest.approx(instance.block[connected("freewheel")])
