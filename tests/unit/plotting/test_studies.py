"""Pictures of studies: axes, peaks, what is missing; sensitivities of a level that is known."""

import itertools

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

from herringbone.analysis.figures.sensitivity import sensitivities
from herringbone.analysis.steady.sensitivities.sensitivity import Sensitivity
from herringbone.core import ParameterError
from herringbone.plotting.studies import pictures
from herringbone.plotting.studies.levels import levels, peaks
from herringbone.plotting.studies.maps import is_map, level_map
from herringbone.plotting.studies.pictures import (
    _uncertain,
    write_steady_pictures,
    write_study_pictures,
)
from herringbone.plotting.studies.sensitivities import band, changes, tornado
from herringbone.plotting.studies.steady_state import short_names
from herringbone.plotting.studies.table import Points
from herringbone.plotting.studies.waterfall import waterfall

SPEEDS, TORQUES, ZETAS, BACKLASHES = (
    np.linspace(800.0, 1500.0, 36), (100.0, 200.0), (0.01, 0.02, 0.04), (1e-4, 2e-4)
)  # fmt: skip
ZETA, BACKLASH = "housing.damping_ratio", "gear_mesh.backlash"
PEAK = 1100.0
UNITS = {
    "speed": "r/min", "torque": "N.m", ZETA: "1", BACKLASH: "m", "mesh_frequency": "Hz",
    "force.rms": "N", "force.order_1": "N", "force.order_2": "N",
}  # fmt: skip


def level(speed, torque, zeta, backlash):
    """One resonance; goes with 1 / zeta and the root of the backlash everywhere."""
    return torque / (1.0 + ((speed - PEAK) / 60.0) ** 2) / zeta * np.sqrt(backlash)


@pytest.fixture(scope="module")
def table():
    rows = [
        {"point": i, "torque": t, "speed": n, ZETA: z, BACKLASH: b, "outcome": "completed",
         "message": "", "mesh_frequency": 0.45 * n, "force.rms": level(n, t, z, b),
         "force.order_1": level(n, t, z, b), "force.order_2": 0.3 * level(n, t, z, b)}
        for i, (t, n, z, b) in enumerate(itertools.product(TORQUES, SPEEDS, ZETAS, BACKLASHES))
    ]  # fmt: skip
    return pd.DataFrame(rows)


def shipped(table, **kept):
    for name, value in kept.items():
        table = table[table[{"zeta": ZETA, "backlash": BACKLASH}.get(name, name)] == value]
    return table.reset_index(drop=True)


def test_sensitivities_are_the_exponents(table):
    found = sensitivities(shipped(table, torque=200.0), "force.rms", [ZETA, BACKLASH], "speed")
    assert len(found) == 2 * SPEEDS.size
    by_name = found.groupby("parameter")["sensitivity"]
    assert by_name.get_group(ZETA).to_numpy() == pytest.approx(-1.0, rel=1e-12)
    assert by_name.get_group(BACKLASH).to_numpy() == pytest.approx(0.5, rel=1e-12)
    spreads = found.groupby("parameter")["spread"].first()
    assert spreads[ZETA] == pytest.approx(1.0)  # 0.01 to 0.04: a factor of 2 about 0.02
    assert spreads[BACKLASH] == pytest.approx(np.sqrt(2.0) - 1.0)


def test_points_without_figures_count_for_no_sensitivity(table):
    broken = shipped(table, torque=200.0, backlash=1e-4)
    broken.loc[broken[ZETA] != 0.02, "force.rms"] = np.nan
    assert not len(sensitivities(broken, "force.rms", [ZETA], "speed"))
    with pytest.raises(ParameterError, match=r"no column 'force\.peak'"):
        sensitivities(broken, "force.peak", [ZETA])
    with pytest.raises(ParameterError, match="not positive"):
        sensitivities(broken.assign(**{ZETA: 0.0}), "force.rms", [ZETA])


def test_tornado_shows_what_spreads_make_of_a_level(table):
    found = sensitivities(shipped(table, torque=200.0), "force.rms", [ZETA, BACKLASH])
    ends = changes(found).set_index("parameter")
    assert ends.loc[ZETA, ["low", "high"]].tolist() == pytest.approx([-0.5, 1.0])
    axes = tornado(found, "force.rms").axes[0]
    assert axes.get_xlabel() == "change of the level [%]"
    widths = [bar.get_width() for bar in axes.patches]
    assert widths[-1] == pytest.approx(150.0)  # the largest is on top
    assert axes.get_yticklabels()[-1].get_text() == f"{ZETA} (factor 2, p^-1.00)"


def test_band_adds_logarithms_by_their_squares(table):
    here = shipped(table, torque=200.0)
    found = sensitivities(here, "force.rms", [ZETA, BACKLASH], "speed")
    middle = level(SPEEDS, 200.0, 0.02, 1e-4)
    lies = band(SPEEDS, middle, found, "speed")
    width = np.hypot(np.log(2.0), 0.25 * np.log(2.0))
    assert lies.high / middle == pytest.approx(np.exp(width))
    assert lies.low / middle == pytest.approx(np.exp(-width))


def test_levels_have_a_curve_per_combination_and_mark_the_peak(table):
    kept = shipped(table, zeta=0.02, backlash=1e-4)
    figure = levels(Points(kept, UNITS, "rig"))
    left, right = figure.axes
    assert left.get_xlabel() == "pinion speed [r/min]"
    assert left.get_ylabel() == "force, rms [N]"
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    assert entries == ["torque 100 N m", "torque 200 N m"]
    assert "1100" in [text.get_text() for text in left.texts]
    largest = level(PEAK, 200.0, 0.02, 1e-4)
    assert largest < left.get_ylim()[1] < 2.0 * largest
    assert [line.get_label() for line in right.lines] == ["rms", "$f_m$", "$2 f_m$"]


def test_peaks_are_found_highest_first():
    across = np.linspace(0.0, 10.0, 201)
    two = 1.0 / (0.01 + (across - 3.0) ** 2) + 3.0 / (0.01 + (across - 7.0) ** 2)
    assert peaks(across, two) == pytest.approx([7.0, 3.0])
    two[:10] = np.nan
    assert peaks(across, two) == pytest.approx([7.0, 3.0])


def test_points_without_figures_are_told_and_leave_a_gap(table):
    kept = shipped(table, torque=200.0, zeta=0.02, backlash=1e-4)
    lost = [c for c in kept if c.startswith("force.")]
    kept.loc[3:4, lost] = np.nan
    kept.loc[3:4, "outcome"] = "diverged"
    figure = levels(Points(kept, UNITS, "rig"))
    title = "Levels; 2 of 36 points have no figures (2 diverged): rig"
    assert figure.get_suptitle() == title
    assert np.isnan(figure.axes[0].lines[0].get_ydata()).sum() == 2


def test_map_and_waterfall_have_units(table):
    points = Points(shipped(table, zeta=0.02, backlash=1e-4), UNITS)
    axes, bar = level_map(points).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "pinion speed [r/min]", "pinion torque [N m]"
    )  # fmt: skip
    assert bar.get_ylabel() == "force.rms [kN]" or bar.get_ylabel().endswith("[N]")
    axes, bar = waterfall(points).axes
    assert axes.get_ylabel() == "frequency [Hz]"
    offsets = axes.collections[0].get_offsets()
    assert len(offsets) == 2 * 2 * SPEEDS.size
    assert bar.get_ylabel().startswith("dB re ")


def test_maps_say_that_they_show_the_largest_of_several(table):
    told = "largest of the further parameters"
    several = Points(table, UNITS)
    one = Points(shipped(table, torque=200.0, zeta=0.02, backlash=1e-4), UNITS)
    assert told in level_map(several, across="speed", up="torque").get_suptitle()
    assert told in waterfall(several).get_suptitle()
    assert told not in waterfall(one).get_suptitle()


def test_folder_of_a_study_gets_what_its_points_allow(table, tmp_path):
    names = {file.name for file in write_study_pictures(table, UNITS, tmp_path).files}
    assert names == {"levels.png", "map.png", "waterfall.force.png", "tornado.force.png"}
    single = shipped(table, zeta=0.02, backlash=1e-4).iloc[:1]
    files, missing = write_study_pictures(single, UNITS, tmp_path)
    assert files == []
    assert missing == [
        "no levels.png: 1 point and no number that is varied: there is no curve; give several "
        "values, such as speed=[100.0, 200.0, 300.0]"
    ]
    with pytest.raises(ParameterError, match="not several numbers; there are: speed"):
        one = shipped(table, torque=200.0, zeta=0.02, backlash=1e-4)
        levels(Points(one, UNITS), across="torque")


def test_many_curves_are_thinned_and_said(table):
    many = pd.concat([table.assign(torque=t) for t in range(100, 120)], ignore_index=True)
    figure = levels(Points(many, UNITS, "rig"))
    assert "12 of 120 curves" in figure.get_suptitle()
    assert len(figure.legends[0].get_texts()) == 12


def test_resonances_are_triangles_in_the_colour_of_their_order(table):
    points = Points(shipped(table, torque=200.0, zeta=0.02, backlash=1e-4), UNITS)
    given = pd.DataFrame({"speed": [1100.0, 9999.0], "order": [2, 1]})
    right = levels(points, resonances=given).axes[1]
    marks = [line for line in right.lines if line.get_marker() == "^"]
    second = next(line for line in right.lines if line.get_label() == "$2 f_m$")
    assert len(marks) == 1
    assert marks[0].get_color() == second.get_color()


def test_curves_that_coincide_are_told(table):
    """All but the last of them are hidden; a curve 2 % off is not."""
    thrice = pd.concat([
        shipped(table, torque=200.0, zeta=0.02, backlash=1e-4).assign(
            **{"mesh.f_a": f, "force.rms": lambda rows, by=by: by * rows["force.rms"]}
        )
        for f, by in ((0.0, 1.0), (1e-5, 1.005), (2e-5, 1.02))
    ])  # fmt: skip
    ordered = thrice[["mesh.f_a", *(c for c in thrice if c != "mesh.f_a")]]
    panel = levels(Points(ordered, {**UNITS, "mesh.f_a": "m"})).axes[0]
    assert panel.get_title(loc="left") == "f_a 0 µm, 10 µm coincide within 1 %"


def test_sensitivities_of_a_table_make_a_band_and_a_tornado_plot(table, tmp_path):
    """Level ~ zeta^-1, known within a factor of 3: the band lies at thrice and a third of it."""
    one = shipped(table, torque=200.0, zeta=0.02, backlash=1e-4)
    given = one.assign(**{f"force.sensitivity.{ZETA}": -1.0})
    bands, tornados, missing = _uncertain(Points(given, UNITS), 2.0)
    assert not missing
    assert bands["force"].high == pytest.approx(3.0 * bands["force"].low * 3.0)
    found, title = tornados["force"]
    assert title == "force.rms at 1100 r/min"
    assert changes(found)["high"].item() == pytest.approx(2.0)
    names = {file.name for file in write_study_pictures(given, UNITS, tmp_path).files}
    assert "tornado.force.png" in names
    none = given.assign(**{f"force.sensitivity.{ZETA}": np.nan})
    assert write_study_pictures(none, UNITS, tmp_path).missing == [
        "no tornado.force.png: no point has a level and sensitivities of it"
    ]


def test_pictures_of_a_group_called_by_its_unit(table, tmp_path, monkeypatch):
    """A slash made a folder of the name, which is not there."""
    of, group = "outputs_in_rad/s", "outputs_in_rad_per_s"
    called = {c: c.replace("force.", f"{of}.") for c in table}
    units = {called.get(c, c): unit for c, unit in UNITS.items()}
    one = shipped(table, torque=200.0, zeta=0.02).rename(columns=called)
    found = write_study_pictures(one, units, tmp_path)
    assert {f"waterfall.{group}.png", f"tornado.{group}.png"} <= {f.name for f in found.files}
    none = one.assign(**{f"{of}.rms": np.nan, f"{of}.sensitivity.{ZETA}": np.nan})
    missing = write_study_pictures(none, units, tmp_path).missing
    assert f"no tornado.{group}.png: no point has a level and sensitivities of it" in missing
    monkeypatch.setattr(pictures, "steady_picture", lambda _: Figure())
    files = write_steady_pictures(None, {of: {ZETA: Sensitivity(0.02, -1.0, -1.0)}}, tmp_path)
    assert [file.name for file in files] == ["steady.png", f"tornado.{group}.png"]


def test_sensitivities_are_those_at_the_base_of_what_is_not_varied():
    """Level c where b is 0, its base, 1 / c where it is 1; b has no logarithm to be varied by."""
    grid = itertools.product((0.0, 1.0), (1.0, 2.0, 4.0), (1000.0, 2000.0))
    rows = [_row(n, {"g.b": b, "g.c": c}, s, s * (c if b == 0.0 else 1.0 / c))
            for n, (b, c, s) in enumerate(grid)]  # fmt: skip
    bands, tornados, _ = _uncertain(Points(pd.DataFrame(rows), _UNITS), 1.0)
    (found,) = tornados["v"][0].itertuples()
    assert (found.sensitivity, found.points) == (pytest.approx(1.0), 3)
    assert bands["v"].high == pytest.approx(4.0 * bands["v"].low)


@pytest.mark.parametrize(
    "rows",
    [
        [("A.csv", 1.0, 1000.0, 1.0), ("B.csv", 1.0, 2000.0, 2.0), ("B.csv", 2.0, 2000.0, 3.0)],
        [("A.csv", 1.0, 1000.0, np.nan), ("A.csv", 2.0, 1000.0, 1.0),
         ("A.csv", 4.0, 1000.0, np.nan), ("A.csv", 1.0, 2000.0, 1.0),
         ("A.csv", 2.0, 2000.0, np.nan), ("A.csv", 4.0, 2000.0, 3.0)],
    ],
)  # fmt: skip
def test_no_tornado_where_the_base_has_no_level_and_sensitivities(rows, tmp_path):
    """As where the other points are of another file, or the base has failed."""
    table = [_row(n, {"g.file": f, "g.c": c}, s, v) for n, (f, c, s, v) in enumerate(rows)]
    found = write_study_pictures(pd.DataFrame(table), _UNITS, tmp_path)
    assert "no tornado.v.png: no point has a level and sensitivities of it" in found.missing


_UNITS = {"speed": "r/min", "g.b": "1", "g.c": "1", "v.rms": "m/s", "v.order_1": "m/s"}


def _row(number, parameters, speed, level):
    return {"point": number, **parameters, "speed": speed, "outcome": "steady", "message": "",
            "mesh_frequency": speed / 2.0, "v.rms": level, "v.order_1": level}  # fmt: skip


def test_axes_of_small_lengths_are_in_micrometres_and_two_values_make_no_map():
    table = pd.DataFrame({"mesh.f_a": [0.0, 15e-6] * 2, "speed": [600.0, 600.0, 700.0, 700.0],
                          "outcome": "steady", "force.rms": 1.0})  # fmt: skip
    points = Points(table, {"mesh.f_a": "m", "speed": "r/min"})
    assert points.scaled_label("mesh.f_a") == "mesh.f_a [µm]"
    assert [label for label, _ in points.curves("speed")] == ["f_a 0 µm", "f_a 15 µm"]
    assert not is_map(points)


def test_labels_of_outputs_are_the_ends_that_differ(table):
    one, two, far = "first.housing.seat.v_y", "second.housing.seat.v_y", "first.shaft.left.f_y"
    some = shipped(table, torque=200.0, zeta=0.01, backlash=1e-4)
    own = some.assign(**{f"{name}.rms": some["force.rms"] for name in (one, two, far)})
    figure = levels(Points(own, UNITS), "speed", (one, two, far))
    labels = [axes.get_ylabel().split(",")[0] for axes in figure.axes[::2]]
    assert labels == [one, two, "left.f_y"]


def test_curves_are_named_so_that_no_two_parameters_are_meant():
    """The shortest ending of their own; a sweep of a script has no system's name in its title."""
    names = ["b.pinion.stiffness", "b.wheel.stiffness", "gear.backlash"]
    rows = [(p, w, b) for p in (1.0, 2.0) for w in (3.0, 4.0) for b in (5.0, 6.0)]
    table = pd.DataFrame(rows, columns=names).assign(outcome="steady")
    table["force.rms"] = np.arange(8.0) + 1.0
    points = Points(table, dict.fromkeys(names, "1"))
    label = points.curves(names[0])[0][0]
    assert label == "wheel.stiffness 3, backlash 5"
    assert points.headline("Levels") == "Levels"
    assert Points(table, {}, "rig").headline("Levels") == "Levels: rig"


def test_signals_of_two_gearboxes_have_names_of_their_own():
    columns = ["one.bearings.left.f_y", "two.bearings.left.f_y", "one.bearings.right.f_y"]
    assert short_names(columns) == ["one: left.f_y", "two: left.f_y", "right.f_y"]
