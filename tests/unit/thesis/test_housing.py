"""Numbers of the entries on the housing, against closed forms and independent solutions."""

import math

import numpy as np
import pytest
from support.thesis import outcome

from herringbone import modes
from herringbone.components.registry import component
from herringbone.housing import SEAT_DOFS, read_housing
from herringbone.thesis import names
from herringbone.thesis.entry import Verdict
from herringbone.thesis.ground import settled
from herringbone.thesis.housing.response import (
    ACROSS,
    FORCES,
    SEATS,
    four_modes,
    seat_levels,
)
from herringbone.thesis.pair.given import JOB


def test_frequencies_and_labels():
    found = outcome("housing_modes")
    assert np.abs(found.tables["modes"]["deviation"]).max() < 1.0
    verdicts = [f.verdict for f in found.findings]
    agrees, contradicts = Verdict.AGREES, Verdict.CONTRADICTS
    needs = [Verdict.NEEDS_AN_ASSUMPTION] * 4
    assert verdicts == [agrees, *needs, agrees, contradicts, agrees, contradicts]
    shares = [f.number for f in found.findings[5:]]
    assert shares == pytest.approx([71.2, 35.2, 60.0, 0.0], abs=1.0)


def test_shares_are_those_of_the_shipped_mesh():
    """The coarse mesh of the pictures against HOUSING.md, and its shapes at seats and sensors."""
    shares = outcome("housing_modes").tables["energy shares"]
    text = (component(names.HOUSING).folder / "HOUSING.md").read_text(encoding="utf-8")
    rows = [r.split("|")[2:8] for r in text.splitlines() if r.startswith(("| 249.", "| 447.1 ",
            "| 611.4", "| 619.4")) and r.count("|") > 12]  # fmt: skip
    fine = np.array(rows, dtype=float)
    coarse = 100.0 * shares[["Tx", "Ty", "Tz", "Rx", "Ry", "Rz"]].to_numpy()
    np.testing.assert_allclose(coarse, fine, atol=3.0)
    assert shares["agreement"].min() > 0.99


def test_surface_has_the_shapes_of_the_seats():
    """Near a bore the surface moves as its seat does."""
    housing = read_housing(component(names.HOUSING).resources)
    nodes = outcome("housing_modes").tables["surface nodes"]
    seat = next(p for p in housing.points if p.name == "wheel_left")
    at = nodes[["x", "y", "z"]].to_numpy() - np.array(seat.position)
    near = (np.hypot(at[:, 0], at[:, 1]) < 0.062) & (np.abs(at[:, 2]) < 0.04)
    own = housing.seat_shapes[[SEAT_DOFS.index(("wheel_left", a)) for a in "xyz"], :4]
    for mode, (axis, k) in enumerate((("z", 2), ("x", 0), ("y", 1), ("z", 2)), 1):
        mean = nodes[near][f"m{mode}_{axis}"].mean()
        assert abs(mean) == pytest.approx(abs(own[k, mode - 1]), rel=0.1)


def test_mean_forces():
    """Both bearings of a shaft carry the force of the line of action."""
    means = outcome("bearing_forces").tables["means"].set_index("seen")
    carried = 200.0 / (2.0 * JOB.pair.base_radius[0])
    ground = means.loc["settled, rigid ground"]
    assert ground["pinion radial force"] == pytest.approx(carried, rel=1e-5)
    assert -ground["wheel radial force"] == pytest.approx(carried, rel=1e-5)
    levels = outcome("bearing_forces").tables["levels"]
    assert (levels["pinion axial force"] == 0.0).all()


@pytest.mark.parametrize("modes", ["all", "four"])
def test_one_way_is_modal_superposition(modes):
    """Seats move by H(w) F of the housing's own modes, with forces of bearings on the ground."""
    values = None
    housing = read_housing(component(names.HOUSING).resources)
    if modes == "four":
        from herringbone.thesis.housing.response import FOUR_MODES

        values, housing = FOUR_MODES, four_modes()
    (state,) = settled(deviation=0.0, values=values)
    columns = [f"bearing_supports.seat.{seat}.f_{axis}" for seat, axis in SEAT_DOFS]
    force = state.amplitudes(*columns)
    w, own = 2.0 * math.pi * state.frequencies, 2.0 * math.pi * housing.frequency_hz
    answer = 1.0 / (
        own[:, None] ** 2 - w**2 + 2j * housing.damping_ratio[:, None] * own[:, None] * w
    )
    moved = housing.seat_shapes @ (answer * (housing.seat_shapes.T @ force))
    seats = [f"modal_housing.{seat}.s_{axis}" for seat, axis in SEAT_DOFS]
    found = state.amplitudes(*seats)
    np.testing.assert_allclose(found, moved, atol=1e-9 * np.abs(moved).max())


def test_seat_levels():
    """Radial is along the line of action; velocity is the derivative of displacement."""
    (state,) = settled(deviation=0.0)
    found = seat_levels(state)
    assert set(found) == {*SEATS, *ACROSS}
    angle = JOB.pair.transverse_pressure_angle  # no profile shift
    x, y = state.amplitudes("modal_housing.pinion_left.v_x", "modal_housing.pinion_left.v_y")
    own = math.sin(angle) * x + math.cos(angle) * y
    rms = math.sqrt(0.5 * float(np.sum(np.abs(own[1:]) ** 2)))
    assert found["pinion seat radial velocity"] == pytest.approx(1e3 * rms, rel=1e-9)


def test_seats_of_the_entry():
    levels = outcome("seat_response").tables["levels"].set_index(["how", "f_A"])
    (state,) = settled(deviation=10e-6, seats_move=True)
    for name, level in seat_levels(state).items():
        assert levels.loc[("settled, two-way", 10.0), name] == pytest.approx(level, rel=1e-9)
    window = levels.loc[("procedure of the thesis", 10.0)]
    assert window["pinion seat radial velocity"] == pytest.approx(3.27, rel=0.02)
    verdicts = {f.sentence: f.verdict for f in outcome("seat_response").findings}
    sentence = "The active shaft's seat vibrates more than the driven one's: "
    assert verdicts[sentence + "settled, one way."] is Verdict.AGREES
    assert verdicts[sentence + "settled, two-way."] is Verdict.CONTRADICTS
    assert verdicts[sentence + "procedure of the thesis."] is Verdict.CONTRADICTS


def test_radial_may_be_read_in_two_ways():
    """Along the line of action, and with what is across it: the latter as x and y have it."""
    levels = outcome("seat_response").tables["levels"].set_index(["how", "f_A"])
    rows = levels.loc[("settled, two-way", 10.0)]
    (state,) = settled(deviation=10e-6, seats_move=True)
    least = math.inf
    for gear in ("pinion", "wheel"):
        x, y, z = (state.level(f"modal_housing.{gear}_left.v_{axis}") for axis in "xyz")
        both = math.hypot(
            rows[f"{gear} seat radial velocity"], rows[f"{gear} seat velocity across"]
        )
        assert both == pytest.approx(1e3 * math.hypot(x, y), rel=1e-9)
        least = min(least, both / (1e3 * z))
    found = {f.sentence: f for f in outcome("seat_response").findings}
    settled_one = found["Radial vibration of the seats is larger than axial: settled, two-way."]
    assert settled_one.verdict is Verdict.NEEDS_AN_ASSUMPTION
    assert settled_one.number == pytest.approx(0.69, abs=0.05)
    assert f"it is {least:.2f}" in settled_one.why


def test_forces_of_both_shafts():
    found = {f.sentence.rpartition(": ")[2]: f for f in outcome("bearing_forces").findings}
    for seen, number, verdict in (
        ("radial, alternating, window of the thesis.", 0.57, Verdict.CONTRADICTS),
        ("radial, alternating, settled, rigid ground.", 8.28, Verdict.AGREES),
        ("radial, alternating, settled, two-way.", 1.38, Verdict.AGREES),
        ("radial, mean.", 1.0, Verdict.CONTRADICTS),
    ):
        assert found[seen].number == pytest.approx(number, abs=0.05), seen
        assert found[seen].verdict is verdict, seen


def test_factors_on_the_rig():
    """As the housing's README has them."""
    force = {}
    for moving in (True, False):
        (state,) = settled(seats_move=moving, system=names.RIG)
        force[moving] = {name: state.level(column) for name, column in FORCES.items()}
    factors = {n: force[True][n] / force[False][n] for n in FORCES if n != "pinion axial force"}
    assert list(factors.values()) == pytest.approx([0.676, 2.055, 9.18], rel=1e-3)


def test_modes_of_the_rig():
    """As the housing's README has them: [Hz], and the part that has most of their energy."""
    found = {}
    for seats in (0.0, 1.0):
        table = modes(names.RIG, values={"gearbox.bearing_supports.seat_motion": seats}).table
        shares = table.filter(like="share.").rename(columns=lambda name: name.rpartition(".")[2])
        rows = zip(table["frequency"].round(1), shares.idxmax(axis=1), strict=True)
        found[seats] = [row for row in rows if 100.0 < row[0] < 310.0]
    wheel, own, torsion = (305.0, "gear_mesh"), (249.3, "modal_housing"), "drive_motor"
    assert found[0.0] == [(174.1, torsion), own, wheel]
    assert found[1.0] == [(170.1, "gear_mesh"), (173.3, torsion)]
