"""Natural modes: two rotors against the closed form, and the shipped rig."""

import math

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.anatomy import value_at
from herringbone.analysis.modes import mean_tangents
from herringbone.analysis.modes.skeleton import skeleton
from herringbone.commands.main import main
from herringbone.core import HerringboneError, ParameterError
from herringbone.plotting.modes.campbell import campbell
from herringbone.plotting.modes.mode_shapes import animate_mode, mode_shapes

TWO = """
connections = [["one.flange_b", "shaft.flange_a"], ["other.flange_a", "shaft.flange_b"]]
[parts.one]
component = "rotating_inertia"
set = {{ inertia = {one} }}
[parts.shaft]
component = "shaft_coupling"
set = {{ stiffness = {stiffness}, damping = {damping} }}
[parts.other]
component = "rotating_inertia"
set = {{ inertia = {other} }}
"""
RIG_ORDERS = (1, 2, 3)


def two_rotors(folder, **values):
    (folder / "system.toml").write_text(TWO.format(**values))
    (folder / "scenes").mkdir()
    (folder / "scenes" / "loaded.toml").write_text('t_end = 0.1\nstart = "rest"\n')
    return folder


@pytest.fixture(scope="module")
def rig():
    return hb.modes("test_rig")


@pytest.mark.parametrize(
    "values",
    [
        {"one": 0.5, "other": 2.0, "stiffness": 6e4, "damping": 5.0},
        {"one": 3e-3, "other": 0.7, "stiffness": 2.1e3, "damping": 0.01},
    ],
)
def test_two_rotors(tmp_path, values):
    """w0^2 = k (1/J1 + 1/J2), zeta = d/2 sqrt((1/J1 + 1/J2)/k); kinetic energy goes with 1/J.

    Participation is a share of energy where damping is small: it errs by about zeta^2.
    """
    found = hb.modes(two_rotors(tmp_path, **values))
    inverse = 1.0 / values["one"] + 1.0 / values["other"]
    assert found.rates.size == 1
    assert found.frequency_hz[0] == pytest.approx(
        math.sqrt(values["stiffness"] * inverse) / (2.0 * math.pi), rel=1e-9
    )
    zeta = 0.5 * values["damping"] * math.sqrt(inverse / values["stiffness"])
    assert found.damping_ratio[0] == pytest.approx(zeta, rel=1e-6)
    share = (1.0 / values["one"]) / inverse
    assert found.participation["one"][0] == pytest.approx(share, rel=1e-6)
    assert found.mesh_answer[0].tolist() == [0.0, 0.0]
    ratio = found.motion("one.flange_a.phi")[0] / found.motion("other.flange_a.phi")[0]
    assert ratio == pytest.approx(-values["other"] / values["one"], rel=1e-6)
    with pytest.raises(ParameterError, match="neither a gear pair nor a housing"):
        mode_shapes(found)
    assert campbell(found).axes


def test_shares_of_all_parts_add_up(rig):
    assert rig.participation.sum(axis=1).to_numpy() == pytest.approx(1.0, abs=1e-9)
    assert (np.diff(rig.frequency_hz) >= 0.0).all()
    assert (rig.damping_ratio > 0.0).all()


def test_vectors_are_those_of_the_matrix(rig):
    """|a r - lambda r| over |a| |r|: rounding of the balanced problem, 1e-13, times its scale."""
    a, r = rig.linear.a, rig.shapes
    off = np.abs(a @ r - r * rig.rates).max(axis=0)
    assert (off <= 1e-9 * (np.abs(a) @ np.abs(r)).max(axis=0)).all()


def test_mesh_mode_of_the_rig(rig):
    """It answers most, and the gear pair has most of it.

    Twelve degrees of freedom on ground have it at 3432 Hz at 2.011e9 N/m (an independent model of
    the thesis' pair); the table's stiffness is 8 % less at 200 N m, the mode's 4 %.
    """
    mode = int(rig.mesh_answer[:, 0].argmax())
    assert rig.frequency_hz[mode] == pytest.approx(3432.0, rel=0.05)
    assert rig.participation["gearbox.gear_mesh"][mode] > 0.9
    assert (rig.mesh_answer[:, 0] <= rig.mesh_answer[:, 1] * (1.0 + 1e-12)).all()


def test_crossings_lie_on_modes_and_orders(rig):
    found = rig.crossings(RIG_ORDERS, 3000.0)
    frequency = found["speed"] / 60.0 * 27.0 * found["order"]
    assert frequency.to_numpy() == pytest.approx(rig.frequency_hz[found["mode"] - 1], rel=1e-12)
    assert found["speed"].max() <= 3000.0


def test_campbell_says_what_it_leaves_out(rig):
    figure = campbell(rig, highest=2000.0, speed=1500.0)
    axes = figure.axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("pinion speed [r/min]", "frequency [Hz]")
    above = int((rig.frequency_hz > 2000.0).sum())
    assert f"{above} modes above 2000 Hz not shown" in figure.get_suptitle()


@pytest.mark.parametrize(
    ("end", "told"),
    [
        ({"highest": math.inf}, "highest=inf: it must be positive and finite, in Hz"),
        ({"highest": math.nan}, "highest=nan: it must be positive and finite, in Hz"),
        ({"highest": "1 kHz"}, 'highest="1 kHz": it must be positive and finite, in Hz'),
        ({"speed": -1.0}, "speed=-1: it must be positive and finite, in r/min"),
        ({"orders": (1, 0)}, "orders=0: it must be positive and finite"),
    ],
)
def test_ends_of_the_campbell_diagram(rig, end, told):
    with pytest.raises(ParameterError, match=f"^{told}$"):
        campbell(rig, **end)


def test_of_several_pairs_orders_of_the_first_are_told():
    found = hb.modes("back_to_back")
    said = "mesh frequency and orders of first.gear_mesh"
    assert f"{said}, over the speed of its pinion; other pairs have their own" in found.notes
    assert f"back_to_back, {said}" in campbell(found).get_suptitle()


def test_shapes_and_animation(rig, tmp_path):
    titles = [a.get_title(loc="left") for a in mode_shapes(rig, (9, 16)).axes]
    assert titles[0].startswith(f"9: {rig.frequency_hz[8]:.1f} Hz, damping ")
    assert "gear_mesh" in titles[0]
    with pytest.raises(HerringboneError, match="there is no mode 99"):
        mode_shapes(rig, (99,))
    animate_mode(rig, 9, tmp_path / "m.gif")
    assert (tmp_path / "m.gif").read_bytes().startswith(b"GIF8")


@pytest.mark.parametrize(("system", "flank"), [("test_rig", 1.0), ("turbine", -1.0)])
def test_gears_move_along_the_line_of_action_of_the_flank_that_carries(system, flank):
    """n = (flank sin a, cos a), as the bearings have it; the turbine's teeth carry in coast."""
    found = hb.modes(system)
    gears = skeleton(found).gears
    y = found.motion("gearbox.gear_mesh.pinion_left.s_y")
    angle = value_at(found.system, "gearbox.bearing_supports.pressure_angle")
    n = np.array([flank * math.sin(angle), math.cos(angle)])
    np.testing.assert_allclose(gears[0, :2], n[:, None] * y, rtol=1e-12)


def test_command(tmp_path, capsys):
    assert main(["modes", "test_rig", "--highest", "1000", "-o", str(tmp_path / "out")]) == 0
    text = capsys.readouterr().out
    assert "up to 1000 Hz" in text
    assert {f.name for f in (tmp_path / "out").iterdir()} == {
        "modes.csv", "critical_speeds.csv", "campbell.png", "shapes.png"
    }  # fmt: skip
    assert main(["modes", "test_rig", "--shapes", "3"]) == 2


@pytest.mark.parametrize(("option", "wrong"), [("--animate", "0"), ("--shapes", "999")])
def test_a_wrong_mode_is_told_before_files_are_written(tmp_path, capsys, option, wrong):
    assert main(["modes", "on_ground", option, "1", wrong, "-o", str(tmp_path)]) != 0
    told = capsys.readouterr().err
    assert f"there is no mode {wrong}: system 'on_ground' has 1 to 11" in told
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("end", ["nan", "inf", "0", "-5"])
@pytest.mark.parametrize(("option", "unit"), [("--highest", "Hz"), ("--speed", "r/min")])
def test_ends_of_the_diagram_are_positive_and_finite(capsys, option, unit, end):
    assert main(["modes", "test_rig", option, end]) == 2
    told = capsys.readouterr().err
    assert f"{option} {end}: it must be positive and finite, in {unit}" in told


def test_modes_without_damping_answer_without_bound(tmp_path):
    """Those that the mesh excites; decay that is rounding orders nothing, and is told as 0.

    Without damping the mesh mode answers most, at one damping ratio for all, as it does with it.
    """
    parts = [f"gear_mesh.{gear}.shaft_damping_{axis}"
             for gear in ("pinion", "wheel") for axis in "yzt"]  # fmt: skip
    parts += [f"bearing_supports.{gear}.{axis}_damping"
              for gear in ("pinion", "wheel") for axis in ("radial", "axial")]  # fmt: skip
    parts += [f"gear_mesh.{name}" for name in ("mesh_damping_ratio", "pinion_axial_drag",
                                               "symmetry_deviation")]  # fmt: skip
    found = hb.modes("on_ground", values=dict.fromkeys(parts, 0.0))
    damped = hb.modes("on_ground")
    assert found.damping_ratio.tolist() == [0.0] * 11
    assert set(np.unique(found.mesh_answer)) == {0.0, math.inf}
    assert found.largest(1, math.inf) == damped.largest(1, math.inf)
    assert found.notes[0].startswith("5 of 11 modes answer to the mesh without bound")
    assert np.isfinite(found.mesh_weight).all()
    assert campbell(found).axes
    free = {"one": 0.5, "other": 2.0, "stiffness": 6e4, "damping": 0.0}
    alone = hb.modes(two_rotors(tmp_path, **free))
    assert alone.mesh_answer.tolist() == [[0.0, 0.0]]
    assert not alone.notes


def test_a_run_out_changes_no_frequency():
    """A floating pinion follows it, so that the meshes keep their load and their stiffness."""
    still, turning = (
        hb.modes("on_ground", values={"gear_mesh.symmetry_deviation": deviation}).frequency_hz
        for deviation in (0.0, 10e-6)
    )
    np.testing.assert_allclose(turning, still, rtol=1e-7)


def test_teeth_that_carry_nothing_count_as_closed(rig):
    """Both halves, whatever run-out: not as rounding of their force has it.

    Without load they are a fifth softer, and have few thousandths of the elastic energy of the
    rig's second mode, so that its frequency differs by less than 1e-3.
    """
    still, turning = (
        hb.modes("test_rig", scene="runup", values={"gear_mesh.symmetry_deviation": deviation})
        for deviation in (0.0, 30e-6)
    )
    np.testing.assert_allclose(turning.frequency_hz, still.frequency_hz, rtol=1e-6)
    assert turning.frequency_hz[1] == pytest.approx(rig.frequency_hz[1], rel=1e-3)
    (note,) = turning.notes
    assert note.startswith("the teeth of gearbox.gear_mesh carry nothing in this scene")
    assert not rig.notes


def test_a_light_load_opens_no_teeth():
    """Its modes lie between those of closed teeth without load and those under load.

    Closed teeth are at most a fifth softer than under load, a frequency at most a ninth lower.
    """
    none, light, full = (
        hb.modes("on_ground", values={"pinion_torque.torque_factor": t,
                                      "wheel_torque.torque_factor": -t})
        for t in (0.0, 0.01, 1.0)
    )  # fmt: skip
    assert not light.notes
    assert (none.frequency_hz[:5] < light.frequency_hz[:5]).all()
    assert (light.frequency_hz[:5] < full.frequency_hz[:5]).all()
    np.testing.assert_allclose(light.frequency_hz[:5], full.frequency_hz[:5], rtol=0.11)


def test_a_half_without_load_beside_one_that_carries_is_open():
    values = {"gear_mesh.pinion_restraint": 1e9, "gear_mesh.symmetry_deviation": 80e-6}
    found = hb.modes("on_ground", values=values)
    assert [bool(x.any()) for x in found.linear.mesh_in.T] == [True, False]
    assert found.notes == (
        "gear_mesh: a half without load beside one that carries counts as open",
    )  # fmt: skip


def test_teeth_that_do_not_come_back_to_their_force_are_told(monkeypatch):
    monkeypatch.setattr(mean_tangents, "_MOST", 1)
    (note,) = hb.modes("on_ground").notes
    assert "gear_mesh: over a turn its teeth do not keep their force (off by up to" in note


def test_places_for_modes_that_a_housing_has_not_are_no_eigenvalues(rig):
    """The thesis' housing has four modes, the rig's sixty, and places are for more."""
    files = {"modes": "thesis_modes.csv", "shapes": "thesis_shapes.csv"}
    few = hb.modes("test_rig", values={f"modal_housing.{k}": v for k, v in files.items()})
    assert rig.rates.size - few.rates.size == 60 - 4
    assert few.others == rig.others == 3  # the turn of all, and two lags of the motors
    assert f"{few.frequency_hz.min():.4g} to" in repr(few)
