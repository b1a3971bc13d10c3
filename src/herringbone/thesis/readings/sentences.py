"""The thesis' sentences about trends, each as a number that says by how much it holds.

A margin is positive where a sentence holds: of a growth, the least relative step of its series; of
"larger than", the ratio less one. A sentence agrees if its margin is at least `needs`: growths and
differences that a printed figure shows (5 %), but for stiffness, whose changes are small by nature.
"""

from herringbone.thesis.readings.measures import LEVEL, SWING
from herringbone.thesis.readings.points import MEASURED_SPEEDS, SPEEDS, THEORY_TORQUES, TORQUES
from herringbone.thesis.readings.sentence import RATIO, SPREAD, Sentence
from herringbone.thesis.readings.trends import (
    KINDS,
    amplified_when_fast,
    both,
    larger,
    over_deviations,
    over_speeds,
    over_torques,
    positions_alike,
    positions_grow,
    sides_differ,
    stiffness_falls,
)

_STIFFER = 0.001
SENTENCES = (
    Sentence(
        "stiffness_falls",
        "mesh stiffness, left plus right, falls as the symmetry deviation grows",
        "2.3",
        stiffness_falls,
        _STIFFER,
    ),
    Sentence(
        "sides_differ",
        "the halves' stiffnesses grow apart with it; the loaded one is stiffer",
        "2.3",
        sides_differ,
        _STIFFER,
    ),
    Sentence(
        "axial_with_deviation",
        "axial vibration of pinion and wheel grows with it",
        "3.4",
        over_deviations(both("z", ("pinion", "wheel"))),
    ),
    Sentence(
        "radial_with_deviation",
        "radial vibration of pinion and wheel grows with it",
        "3.4",
        over_deviations(both("y", ("pinion", "wheel"))),
    ),
    Sentence(
        "pinion_axial_larger",
        "the pinion vibrates more than the wheel, axially",
        "3.4",
        larger([(f"pinion.{k}_z", f"wheel.{k}_z") for k in KINDS]),
        kind=RATIO,
    ),
    Sentence(
        "pinion_radial_larger",
        "the pinion vibrates more than the wheel, radially",
        "3.4",
        larger([(f"pinion.{k}_y", f"wheel.{k}_y") for k in KINDS]),
        kind=RATIO,
    ),
    Sentence(
        "axial_with_torque",
        "axial velocity of the pinion grows from 200 over 250 to 300 N m",
        "3.5",
        over_torques(["pinion.v_z"], LEVEL, THEORY_TORQUES),
    ),
    Sentence(
        "swing_with_torque",
        "so do its fluctuations",
        "3.5",
        over_torques(["pinion.v_z"], SWING, THEORY_TORQUES),
    ),
    Sentence(
        "axial_with_speed",
        "axial velocity of the pinion grows from 800 to 1500 r/min",
        "3.5",
        over_speeds(["pinion.v_z"], LEVEL, SPEEDS),
    ),
    Sentence(
        "swing_with_speed",
        "so do its fluctuations",
        "3.5",
        over_speeds(["pinion.v_z"], SWING, SPEEDS),
    ),
    Sentence(
        "active_bearing_larger",
        "bearing forces of the active shaft exceed those of the driven one",
        "4.3",
        larger([("pinion.f_y", "wheel.f_y")]),
        kind=RATIO,
    ),
    Sentence(
        "active_seat_larger",
        "the active shaft's bearing seat vibrates more than the driven one's",
        "4.3",
        larger([(f"pinion.seat_{k}", f"wheel.seat_{k}") for k in ("radial", "axial")]),
        kind=RATIO,
    ),
    Sentence(
        "seats_radial_larger",
        "seats vibrate more radially than axially",
        "4.3",
        larger([(f"{g}.seat_radial", f"{g}.seat_axial") for g in ("pinion", "wheel")]),
        kind=RATIO,
    ),
    Sentence(
        "seats_axial_significant",
        "their axial vibration exceeds a tenth of the radial",
        "4.3",
        larger([(f"{g}.seat_axial", f"{g}.seat_radial") for g in ("pinion", "wheel")], 0.1),
        kind=RATIO,
    ),
    Sentence(
        "positions_alike",
        "at 800 and 1200 r/min sensors A, B, C show about the same",
        "5.3.1",
        positions_alike,
        0.0,
        SPREAD,
    ),
    Sentence(
        "positions_differ",
        "at 1500 r/min the velocity grows noticeably from A over B to C",
        "5.3.1",
        positions_grow,
    ),
    Sentence(
        "housing_with_speed",
        "axial velocity of the housing grows over 800, 1200, 1500 r/min",
        "5.3.2",
        over_speeds("ABC", LEVEL, MEASURED_SPEEDS),
    ),
    Sentence(
        "housing_swing_with_speed",
        "its fluctuation is largest at 1500 r/min",
        "5.3.2",
        over_speeds("ABC", SWING, MEASURED_SPEEDS[::2]),
    ),
    Sentence(
        "housing_with_torque",
        "it grows monotonically with torque from 100 to 400 N m",
        "5.3.3",
        over_torques("ABC", LEVEL, TORQUES),
    ),
    Sentence(
        "housing_swing_with_torque",
        "so does its fluctuation",
        "5.3.3",
        over_torques("ABC", SWING, TORQUES),
    ),
    Sentence(
        "housing_with_deviation",
        "symmetry deviation amplifies the axial vibration of the housing",
        "6",
        over_deviations("ABC"),
    ),
    Sentence(
        "housing_when_fast",
        "especially at high speeds (1500 against 800 r/min)",
        "6",
        amplified_when_fast,
    ),
)
"""In the order of the thesis."""
