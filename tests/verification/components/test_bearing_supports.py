"""Bearings: power balance, directions, clearance, stiffness."""

import math

import numpy as np
import pytest

from herringbone.components.bearing_supports import BEARING_SUPPORTS
from herringbone.components.ports import HALVES
from herringbone.components.shipped_pair import SHIPPED_PAIR
from herringbone.core import Instance

MOTIONS = [v.name for v in BEARING_SUPPORTS.declaration.inputs]
ALPHA = math.radians(22.7959)  # physics 2.1


def bearings(motions: dict[str, float] | None = None, **parameters: float) -> Instance:
    instance = Instance(BEARING_SUPPORTS, "bearings")
    for name, value in {
        **{k.replace("__", "."): v for k, v in parameters.items()},
        **(motions or {}),
    }.items():
        instance.set(name, value)
    instance.initialise()
    return instance


def random_motion(seed: int) -> dict[str, float]:
    random = np.random.default_rng(seed)
    size = {"s": 1e-5, "v": 1e-2}
    return {n: size[n.rsplit(".", 1)[1][0]] * random.standard_normal() for n in MOTIONS}


def power(b: Instance, half: str) -> tuple[float, float]:
    """Power that the bearing of a half takes from both sides, and the sum of its terms' sizes."""
    terms = [b[f"shaft.{half}.f_{a}"] * b[f"shaft.{half}.v_{a}"] for a in "yz"]
    terms += [b[f"seat.{half}.f_{a}"] * b[f"seat.{half}.v_{a}"] for a in "xyz"]
    return -sum(terms), sum(abs(t) for t in terms)


@pytest.mark.parametrize("clearance", [0.0, 5e-6])
@pytest.mark.parametrize("seed", range(10))
def test_power_balance(seed, clearance):
    """What the two sides give is the relative motion's power: nothing is created."""
    b = bearings(
        random_motion(seed),
        pinion__axial_stiffness=1e8,
        pinion__radial_clearance=clearance,
        wheel__radial_clearance=clearance,
        axial_per_shaft=seed % 2,
    )
    n = np.array([math.sin(b["pressure_angle"]), math.cos(b["pressure_angle"])])
    for half in HALVES:
        seat = np.array([b[f"seat.{half}.v_x"], b[f"seat.{half}.v_y"]])
        rate = b[f"shaft.{half}.v_y"] - n @ seat
        axial = b[f"shaft.{half}.v_z"] - b[f"seat.{half}.v_z"]
        expected = -b[f"shaft.{half}.f_y"] * rate - b[f"shaft.{half}.f_z"] * axial
        taken, size = power(b, half)
        assert abs(taken - expected) < 1e-14 * size  # rounding


@pytest.mark.parametrize("seed", range(10))
def test_damping_only_takes_power(seed):
    motion = {n: v for n, v in random_motion(seed).items() if n.rsplit(".", 1)[1][0] == "v"}
    b = bearings(motion, pinion__axial_damping=100.0)
    for half in HALVES:
        taken, size = power(b, half)
        assert taken > 1e-12 * size


def test_common_motion_along_the_line_of_action_gives_no_force():
    b = bearings()
    a = b["pressure_angle"]
    for half in HALVES:
        for q in "sv":
            b.set(f"shaft.{half}.{q}_y", 3e-5)
            b.set(f"seat.{half}.{q}_x", 3e-5 * math.sin(a))
            b.set(f"seat.{half}.{q}_y", 3e-5 * math.cos(a))
            b.set(f"shaft.{half}.{q}_z", 2e-5)
            b.set(f"seat.{half}.{q}_z", 2e-5)
    b.step(0.0, 1e-5)
    for half in HALVES:
        assert abs(b[f"shaft.{half}.f_y"]) < 1e-15 * 6.34e8 * 3e-5 * 10  # rounding
        assert b[f"shaft.{half}.f_z"] == 0.0


def test_direction_of_the_line_of_action():
    """y of the gear is (sin, cos) of the working transverse pressure angle in the housing frame."""
    b = bearings({"shaft.pinion_left.s_y": 1e-6})
    force = 6.34e8 * 1e-6
    assert b["shaft.pinion_left.f_y"] == pytest.approx(-force, rel=1e-14)
    assert b["seat.pinion_left.f_x"] == pytest.approx(force * math.sin(ALPHA), rel=5e-6)
    assert b["seat.pinion_left.f_y"] == pytest.approx(force * math.cos(ALPHA), rel=5e-6)
    assert b["seat.pinion_left.f_z"] == 0.0


def test_line_of_action_of_the_coast_flank():
    """Mirrored at the line of centres; what goes in and out along it stays one direction."""
    b = bearings({"shaft.pinion_left.s_y": 1e-6}, flank=-1)
    force = 6.34e8 * 1e-6
    assert b["shaft.pinion_left.f_y"] == pytest.approx(-force, rel=1e-14)
    assert b["seat.pinion_left.f_x"] == pytest.approx(-force * math.sin(ALPHA), rel=5e-6)
    assert b["seat.pinion_left.f_y"] == pytest.approx(force * math.cos(ALPHA), rel=5e-6)
    along = {
        "seat.wheel_left.s_x": -1e-6 * math.sin(b["pressure_angle"]),
        "seat.wheel_left.s_y": 1e-6 * math.cos(b["pressure_angle"]),
    }
    assert bearings(along, flank=-1)["shaft.wheel_left.f_y"] == pytest.approx(force, rel=1e-12)


def test_motion_across_the_line_of_action_gives_no_force():
    b = bearings()
    a = b["pressure_angle"]
    b.set("seat.wheel_left.s_x", 1e-5 * math.cos(a))
    b.set("seat.wheel_left.s_y", -1e-5 * math.sin(a))
    b.step(0.0, 0.0)
    assert abs(b["shaft.wheel_left.f_y"]) < 1e-15 * 6.34e8 * 1e-5 * 10  # rounding


AXIAL = {"pinion": 0.0, "wheel": 2.03e8}
MASS = {"pinion": 6.499931057137739, "wheel": 47.73887244261097}


@pytest.mark.parametrize("half", HALVES)
def test_stiffness_and_damping_of_the_notes(half):
    """physics 2.3: per half; 2 % of the local critical damping."""
    gear = half.split("_", maxsplit=1)[0]
    for axis, k in (("y", 6.34e8), ("z", AXIAL[gear])):
        b = bearings({f"shaft.{half}.s_{axis}": 2e-6})
        assert b[f"shaft.{half}.f_{axis}"] == pytest.approx(-k * 2e-6, rel=1e-14)
        b = bearings({f"shaft.{half}.v_{axis}": 1e-3})
        c = 2 * 0.02 * math.sqrt(k * MASS[gear])
        assert b[f"shaft.{half}.f_{axis}"] == pytest.approx(-c * 1e-3, rel=1e-14)
        others = [f"shaft.{h}.f_{a}" for h in HALVES for a in "yz" if (h, a) != (half, axis)]
        assert not any(b[name] for name in others)


def test_axial_values_per_shaft_are_halved_at_each_half():
    motion = {
        "shaft.wheel_left.s_z": 1e-6,
        "shaft.wheel_left.v_z": 1e-3,
        "shaft.wheel_left.s_y": 1e-6,
    }
    half, shaft = bearings(motion), bearings(motion, axial_per_shaft=1.0)
    for side in ("shaft", "seat"):
        name = f"{side}.wheel_left.f_z"
        assert shaft[name] == pytest.approx(0.5 * half[name], rel=1e-15)
    assert shaft["shaft.wheel_left.f_y"] == half["shaft.wheel_left.f_y"]


@pytest.mark.parametrize(("per_shaft", "ratio"), [(0.0, 0.02), (1.0, 0.02 / math.sqrt(2.0))])
def test_axial_damping_ratio_of_a_wheel_half(per_shaft, ratio):
    """As the description says: 2 %, and 1.41 % where the values are those of a shaft."""
    stiffness, damping = (
        -bearings({f"shaft.wheel_left.{q}": 1.0}, axial_per_shaft=per_shaft)["shaft.wheel_left.f_z"]
        for q in ("s_z", "v_z")
    )
    critical = 2.0 * math.sqrt(stiffness * SHIPPED_PAIR.half_mass[1])
    assert damping / critical == pytest.approx(ratio, rel=1e-12)


CLEARANCE = 10e-6  # diametral


def with_clearance(d: float, rate: float = 0.0) -> float:
    motion = {"shaft.wheel_right.s_y": d, "shaft.wheel_right.v_y": rate}
    return bearings(motion, wheel__radial_clearance=CLEARANCE)["shaft.wheel_right.f_y"]


@pytest.mark.parametrize("rate", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("d", [-5e-6, -2e-6, 0.0, 4.9e-6, 5e-6])
def test_no_force_inside_the_clearance(d, rate):
    assert with_clearance(d, rate) == 0.0


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_stiffness_beyond_the_clearance(sign):
    found = with_clearance(sign * (5e-6 + 3e-6))
    assert found == pytest.approx(-sign * 6.34e8 * 3e-6, rel=1e-12)  # rounding of 8 um - 5 um


@pytest.mark.parametrize(
    ("depth", "share"), [(1e-12, 0.0), (0.5e-6, 0.5), (1e-6, 1.0), (4e-6, 1.0)]
)
def test_damping_rises_over_a_tenth_of_the_clearance(depth, share):
    damping = (with_clearance(5e-6 + depth) - with_clearance(5e-6 + depth, 1.0)) / 1.0
    full = 0.04 * math.sqrt(6.34e8 * 47.73887244261097)
    assert damping == pytest.approx(share * full, abs=2e-6 * full)  # 1e-12 / 1e-6


def test_every_live_node_is_evaluated():
    b = bearings()
    b.set("interface_degree", 4)
    for node in range(5):
        b.set("shaft.pinion_left.s_y" + (f".node{node}" if node else ""), (1 + node) * 1e-6)
    b.step(0.0, 1e-5)
    found = [b[f"shaft.pinion_left.f_y.node{node}"] for node in range(1, 5)]
    np.testing.assert_allclose(found, [-634.0 * n for n in (2, 3, 4, 5)], rtol=1e-13)
    assert b["shaft.pinion_left.f_y"] == found[-1]
    assert b["shaft.pinion_left.s_y"] == 1e-6
