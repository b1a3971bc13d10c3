"""What fused runs show where teeth part, and of what rises from zero."""

from dataclasses import replace

import numpy as np
import pytest
from support.rig.as_one import instance_of

import herringbone as hb
from herringbone.analysis.twin.composite import make_composite
from herringbone.running.loading import load_scene, load_system
from herringbone.running.operating.commanded import operated
from herringbone.running.prepared import Wishes, prepared


@pytest.mark.parametrize("step", [2.5e-5, 5e-6, 2.5e-6])
def test_errors_fall_with_the_step_where_teeth_meet(step):
    """By the default tolerance: from the first blow on single precision would err as a force does.

    Steps of 25 us see a contact that is over at the next node; their error is 2.6e-5, and those of
    shorter ones follow at least their length.
    """
    run = hb.run(
        "e_axle", scene="tip_out", fuse=True, t_end=0.02, record_step=1e-4, step=step,
        reference=True,
    )  # fmt: skip
    assert max(run.error.values()) < 4e-5 * step / 2.5e-5
    assert run.verification is not None
    assert max(run.error.values()) < 5.0 * max(run.verification.groups.values())


def test_a_rattle_that_begins_with_a_short_contact():
    """Half steps missed it as whole ones do: 1.1e-2 was true, of 2.9e-4 told."""
    run = hb.run("test_rig", scene="separation", torque=10.0, fuse=True, t_end=0.03, reference=True)
    assert run.verification is not None
    assert max(run.error.values()) < 2.0 * max(run.verification.groups.values()) < 1e-3


def test_a_short_contact_in_a_system_as_one_component(tmp_path):
    """As its FMU is; looking at nodes alone it erred 3.5e-4, and errs 5.7e-5."""
    offset = {"gear_mesh.der(angle)": 0.3, "gear_mesh.der(approach)": 0.3 * 0.050298}
    _, folder = load_system("test_rig")
    scene = replace(load_scene(folder, "separation"), start_offset=offset)
    asked = operated("test_rig", scene, Wishes(), None, 25.0)
    composite = make_composite(prepared("test_rig", scene, asked).system)
    whole, d = instance_of(composite, tmp_path, "rig"), composite.component.declaration
    whole.initialise()
    whole.block[d.index["tolerance"]] = 1e-3
    true = hb.run(
        "test_rig", scene=scene, torque=25.0, fuse=True, t_end=0.02, step=2.5e-6, record_step=1e-4
    )
    names = true.channel("bearing_force")
    places, rows = [d.index[n] for n in names], []
    for k in range(200):
        assert whole.step(k * 1e-4, 1e-4) == 0
        rows.append(whole.block[places].copy())
    expected = np.column_stack([true[n] for n in names])
    alternating = np.linalg.norm(expected - expected.mean(axis=0))
    assert np.linalg.norm(rows - expected[1:]) < 1.5e-4 * alternating


def test_power_of_a_torque_that_begins_at_zero():
    """The torque of an order rises over `ramp_time`: at the start no output shows what it does."""
    names = ("order_1.order", "order_1.amplitude", "constant_share")
    values = {f"booster_machine.{n}": v for n, v in zip(names, (1.0, 80.0, 0.0), strict=True)}
    run = hb.run("boosted_axle", fuse=True, values=values, t_end=0.03, record_step=1e-4)
    part = "booster_machine"
    power = run[f"{part}.torque"] * run["booster.flange_a.w"]
    assert power.abs().max() > 1e3
    assert run[f"{part}.power"].to_numpy() == pytest.approx(power.to_numpy(), rel=1e-9, abs=1e-6)
