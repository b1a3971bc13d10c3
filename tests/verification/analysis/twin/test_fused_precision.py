"""What fused runs show where teeth part, and of what rises from zero."""

import pytest

import herringbone as hb


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


def test_power_of_a_torque_that_begins_at_zero():
    """The torque of an order rises over `ramp_time`: at the start no output shows what it does."""
    names = ("order_1.order", "order_1.amplitude", "constant_share")
    values = {f"booster_machine.{n}": v for n, v in zip(names, (1.0, 80.0, 0.0), strict=True)}
    run = hb.run("boosted_axle", fuse=True, values=values, t_end=0.03, record_step=1e-4)
    part = "booster_machine"
    power = run[f"{part}.torque"] * run["booster.flange_a.w"]
    assert power.abs().max() > 1e3
    assert run[f"{part}.power"].to_numpy() == pytest.approx(power.to_numpy(), rel=1e-9, abs=1e-6)
