"""What fused runs show where teeth part, and of what rises from zero."""

import pytest

import herringbone as hb


@pytest.mark.parametrize("step", [5e-6, 2.5e-6])
def test_errors_fall_with_the_step_where_teeth_meet(step):
    """By the default tolerance: from the first blow on single precision would err as a force does.

    Steps of 25 us err 2.6e-4 (a contact as short as that is not seen); shorter ones follow at least
    their square.
    """
    run = hb.run(
        "e_axle", scene="tip_out", fuse=True, t_end=0.02, record_step=1e-4, step=step,
        reference=True,
    )  # fmt: skip
    assert max(run.error.values()) < 4e-4 * (step / 2.5e-5) ** 2
    assert run.verification is not None
    assert max(run.error.values()) < 5.0 * max(run.verification.groups.values())


def test_power_of_a_torque_that_begins_at_zero():
    """The torque of an order rises over `ramp_time`: at the start no output shows what it does."""
    names = ("order_1.order", "order_1.amplitude", "constant_share")
    values = {f"booster_machine.{n}": v for n, v in zip(names, (1.0, 80.0, 0.0), strict=True)}
    run = hb.run("boosted_axle", fuse=True, values=values, t_end=0.03, record_step=1e-4)
    part = "booster_machine"
    power = run[f"{part}.torque"] * run["booster.flange_a.w"]
    assert power.abs().max() > 1e3
    assert run[f"{part}.power"].to_numpy() == pytest.approx(power.to_numpy(), rel=1e-9, abs=1e-6)
