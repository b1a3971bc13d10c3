"""Pictures: units on the axes, lines, means, missing channels, no global state."""

import subprocess
import sys
from dataclasses import replace

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import cbook
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text
from support.result import make_foreign_result, make_result

from herringbone.analysis.accuracy.comparison import compare
from herringbone.analysis.figures.operating_point import steady_part
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.core import Outcome, OutcomeKind, ParameterError
from herringbone.plotting import (
    PICTURES,
    bearing_forces,
    overview,
    plot_columns,
    seat_velocities,
    spectra,
    torques,
    write_pictures,
)
from herringbone.plotting.comparison import comparison
from herringbone.plotting.runs.sensors import sensors
from herringbone.plotting.style import depths, envelope, scaled_unit


@pytest.fixture(scope="module")
def rig():
    return make_result()


def panels(figure):
    return [axes for axes in figure.axes if axes.get_visible()]


@pytest.mark.parametrize("draw", [overview, *PICTURES.values()])
def test_every_axis_has_a_label_with_a_unit(rig, draw):
    for axes in panels(draw(rig)):
        assert axes.get_ylabel().endswith("]"), axes.get_ylabel()
        if axes.get_xlabel():
            assert axes.get_xlabel().endswith(("[s]", "[ms]", "[Hz]"))


def test_bearing_forces_show_four_halves_in_newton(rig):
    figure = bearing_forces(rig)
    assert [len(axes.lines) for axes in panels(figure)] == [4, 4, 4, 4]
    whole, last = panels(figure)[:2]
    assert whole.get_ylabel() == "force y [N]"
    assert last.get_ylabel() == "force y, AC [N]"
    values = last.lines[0].get_ydata()
    column = rig["bearing_supports.shaft.pinion_left.f_y"].to_numpy()
    mean = column[column.size // 5 :].mean()
    assert values == pytest.approx(column[-values.size :] - mean, abs=1e-9)
    assert last.get_legend().get_texts()[0].get_text() == "pinion left, mean 1988 N"


def test_seat_velocities_are_in_millimetres_per_second(rig):
    figure = seat_velocities(rig)
    assert len(panels(figure)) == 6
    last = panels(figure)[1]
    column = rig["modal_housing.pinion_left.v_x"].to_numpy()
    assert last.lines[0].get_ydata()[-1] == pytest.approx(1e3 * column[-1])
    assert "[mm/s]" in last.get_ylabel()


def test_a_right_half_that_its_left_one_covers_is_in_front():
    """Ranges that are nearly the same: dashes are seen over the line, and small over large."""
    wave = np.sin(np.linspace(0.0, 6.0, 50))
    left, right, wheel = 41.0 * wave, 41.9 * wave, 8.0 * wave
    for first, second in ((left, right), (right, left)):
        depth = depths(np.column_stack([first, second, wheel, wheel]))
        assert np.all(np.diff(depth) > 0.0)


def test_spectra_mark_the_mesh_orders(rig):
    axes = panels(spectra(rig))[0]
    same, *texts = axes.texts  # synthetic halves differ by their phases
    assert same.get_text() == "left and right coincide: pinion, wheel"
    marks = [text.get_text() for text in texts]
    assert marks == ["$f_m$", *(f"${k} f_m$" for k in range(2, 7))]
    places = [text.get_position()[0] for text in texts]
    assert places == pytest.approx([450.0 * k for k in range(1, 7)], rel=1e-4)
    assert axes.lines[0].get_ydata().max() == pytest.approx(12.0, rel=0.05)


def test_spectra_have_one_legend_in_the_title_line(rig):
    figure = spectra(rig)
    entries = [text.get_text() for text in figure.legends[0].get_texts()]
    halves = ["pinion left", "pinion right", "wheel left", "wheel right"]
    assert entries == [*halves, "mesh left", "mesh right"]
    assert not any(axes.get_legend() for axes in figure.axes)
    colours = {line.get_label(): line.get_color() for a in figure.axes for line in a.lines}
    assert len({colours[entry] for entry in entries}) == len(entries)
    first = figure.axes[0].get_tightbbox()
    assert figure.legends[0].get_window_extent().y0 > first.y1


def test_spectra_tell_their_resolution(rig):
    """160 ms make lines; the 8 ms of a short run make a point every 125 Hz."""
    for result, resolution, step in ((rig, 6.25, None), (make_result(t_end=0.01), 124.7, 4)):
        for axes in panels(spectra(result)):
            told = f"frequency (resolution {resolution:.3g} Hz, cut at 3000 of 25000 Hz) [Hz]"
            assert axes.get_xlabel() == told
            (line, *_) = axes.lines
            assert line.get_markevery() == step
            assert line.get_marker() == ("o" if step else "None")
            if step:
                assert line.get_xdata()[step] == pytest.approx(resolution, abs=0.1)


def test_spectra_go_to_the_highest_line_asked(rig):
    for highest, label in ((8000.0, ", cut at 8000 of 25000 Hz"), (1e9, "")):
        axes = panels(spectra(rig, highest))[0]
        assert axes.get_xlabel() == f"frequency (resolution 6.25 Hz{label}) [Hz]"
        assert axes.get_xlim()[1] == pytest.approx(min(highest, 25000.0))


DRAWN = (0.9896, 1.001)
"""Peaks at most an eighth of a bin off: sin(pi/8) / (pi/8) / (1 - 1/64) = 0.98996."""


def between_bins(time):
    """A unit cosine whose frequency lies half-way between two of its record's bins."""
    duration = time.size * (time[-1] - time[0]) / (time.size - 1)
    return np.cos(2.0 * np.pi * (int(300.0 * duration) + 0.5) / duration * time + 0.3)


def highest_lines(axes):
    return [float(np.max(line.get_ydata())) for line in axes.lines if len(line.get_xdata()) > 2]


def with_wave(rig, columns):
    part, wave = steady_part(rig).rows, np.zeros(len(rig.data))
    wave[part] = between_bins(rig.data["time"].to_numpy()[part])
    return replace(rig, data=rig.data.assign(**dict.fromkeys(columns, wave)))


def test_spectra_draw_lines_between_bins(rig):
    waving = with_wave(rig, [c for c in rig.data if ".f_y" in c])
    drawn = highest_lines(panels(spectra(waving))[0])
    assert len(drawn) == 4
    assert all(DRAWN[0] < line < DRAWN[1] for line in drawn)


def test_comparisons_draw_lines_between_bins(rig):
    waving = with_wave(rig, ["gearbox.gear_mesh.mesh_left.force"])
    found = compare(waving, rig, "*.mesh_left.force")
    axes = panels(comparison(found))[1]
    assert DRAWN[0] < highest_lines(axes)[0] < DRAWN[1]


def test_sensors_draw_lines_between_bins(rig, monkeypatch):
    figures, _ = sensor_figures(rig)
    for name, one in figures.items():
        velocity = np.zeros(one.time.size)
        velocity[one.steady] = 1e-3 * between_bins(one.time[one.steady])
        figures[name] = replace(one, velocity=velocity)
    monkeypatch.setattr(f"{sensors.__module__}.sensor_figures", lambda _: (figures, {}))
    drawn = highest_lines(panels(sensors(rig))[2])
    assert len(drawn) == 3
    assert all(DRAWN[0] < line < DRAWN[1] for line in drawn)


def test_spectra_say_which_halves_coincide(rig):
    column = "gearbox.bearing_supports.shaft.wheel_left.f_y"
    data = rig.data.assign(**{column: 1.02 * rig.data[column]})
    text = panels(spectra(replace(rig, data=data)))[0].texts[0].get_text()
    assert text == "left and right coincide: pinion"


@pytest.mark.parametrize("system", ["test_rig", "gearbox"])
def test_every_panel_of_the_overview_has_a_legend_beside_its_title(system):
    figure = overview(make_result(system))
    FigureCanvasAgg(figure).draw()
    for axes in figure.axes[:4]:
        name = axes.get_title(loc="left")
        title = next(t for t in axes.findobj(Text) if t.get_text() == name)
        legend = axes.get_legend().get_window_extent()
        assert not legend.overlaps(title.get_window_extent())
        assert not any(legend.overlaps(text.get_window_extent()) for text in axes.texts)


def test_spectra_of_a_run_up_have_no_orders(rig):
    data = rig.data.assign(**{"gearbox.gear_mesh.pinion.w": rig.data["time"] * 500.0})
    *_, text = panels(spectra(replace(rig, data=data)))[0].texts
    assert text.get_text() == "speed not steady: no mesh orders"


def test_torques_in_newton_metre_and_speeds_in_revolutions(rig):
    labels = [axes.get_ylabel() for axes in panels(torques(rig))]
    assert labels == ["torque [N m]", "torque [N m]", "speed [r/min]", "speed [r/min]"]
    speed = panels(torques(rig))[2].lines[0].get_ydata()
    assert np.mean(speed) == pytest.approx(1000.0, rel=1e-4)


def test_plot_columns_makes_one_panel_per_unit(rig):
    figure = plot_columns(rig, "bearing_force", "modal_housing.*.v_x", "*.recovered_power")
    labels = [axes.get_ylabel() for axes in panels(figure)]
    assert labels == ["force [N]", "velocity [mm/s]", "power [W]"]
    assert [len(axes.lines) for axes in panels(figure)] == [8, 4, 1]
    entries = [t.get_text() for t in panels(figure)[0].get_legend().get_texts()]
    assert entries == rig.channel("bearing_force")


def test_plot_columns_refuses_a_pattern_without_columns(rig):
    with pytest.raises(ParameterError, match="no column matches"):
        plot_columns(rig, "nothing.*")


def test_result_plot_draws_an_overview_or_columns(rig):
    assert len(panels(rig.plot())) == 5  # four panels and the second axis for the speed
    assert len(panels(rig.plot("seat_velocity"))) == 1


def test_systems_without_gears_get_their_columns():
    foreign = make_foreign_result()
    labels = [axes.get_ylabel() for axes in panels(overview(foreign))]
    assert labels == ["position [m]", "velocity [m/s]", "value [1]"]
    for draw in PICTURES.values():
        with pytest.raises(ParameterError, match="records no"):
            draw(foreign)


@pytest.mark.parametrize("name", ["_2nd.y", "a.$b$", "a.$b^{", "a.der(x)[1]"])
def test_names_are_shown_as_they_are(name, tmp_path):
    result = make_foreign_result()
    old = result.data.columns[1]
    units = {name if n == old else n: unit for n, unit in result.units.items()}
    figure = replace(result, data=result.data.rename(columns={old: name}), units=units).plot(name)
    figure.savefig(tmp_path / "names.png")
    (entry,) = figure.axes[0].get_legend().get_texts()
    assert entry.get_text().strip().replace("\\$", "$") == name
    assert cbook.is_math_text(entry.get_text()) is False


def test_written_pictures_are_those_that_the_system_has(rig, tmp_path):
    names = {
        "rig": {"overview", *PICTURES},
        "gearbox": {"overview", "bearing_forces", "seat_velocities", "spectra", "radiated_power"},
        "foreign": {"overview"},
    }
    results = {"rig": rig, "gearbox": make_result("gearbox"), "foreign": make_foreign_result()}
    for name, result in results.items():
        folder = tmp_path / name
        folder.mkdir()
        files = write_pictures(result, folder)
        assert {file.stem for file in files} == names[name]
        for file in files:
            content = file.read_bytes()
            assert content.startswith(b"\x89PNG")
            assert len(content) > 10_000


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("rows", [0, 1, 2, 9])
def test_short_runs_can_be_drawn(rig, rows, tmp_path):
    short = replace(rig, data=rig.data.iloc[:rows])
    assert (
        len(write_pictures(short, tmp_path)) == {0: 0, 1: 0, 2: 5, 9: 6}[rows]
    )  # sensors need a spline
    overview(short)
    plot_columns(short, "*.torque")


@pytest.mark.filterwarnings("error")
def test_diverged_runs_can_be_drawn(rig, tmp_path):
    growth = np.geomspace(1.0, 1e300, len(rig.data))
    data = rig.data.mul(growth, axis=0).assign(time=rig.data["time"])
    diverged = replace(rig, data=data, outcome=Outcome(OutcomeKind.DIVERGED, 0.2))
    assert len(write_pictures(diverged, tmp_path)) == 5
    last = panels(bearing_forces(diverged))[1]
    assert (last.get_yscale(), last.get_ylabel()) == ("symlog", "force y [N]")


def test_drawing_leaves_no_state_and_needs_no_pyplot(rig):
    before = dict(mpl.rcParams)
    overview(rig)
    assert dict(mpl.rcParams) == before
    code = (
        "import sys, herringbone.plotting, herringbone.running.reporting.report\n"
        "assert 'matplotlib.pyplot' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_report_does_not_import_matplotlib_before_it_draws():
    code = (
        "import sys, herringbone.running.reporting.report\nassert 'matplotlib' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_envelope_keeps_extremes_and_ends():
    x = np.linspace(0.0, 1.0, 20_001)
    y = np.sin(900.0 * x) * x
    shown, values = envelope(x, y)
    assert shown.size < 5000
    assert (values.min(), values.max()) == (y.min(), y.max())
    assert (shown[0], shown[-1]) == (0.0, 1.0)
    assert (np.diff(shown) >= 0.0).all()


@pytest.mark.parametrize(
    ("unit", "peak", "expected"),
    [
        ("m", 3e-6, (1e6, "µm")),
        ("m", 2.0, (1.0, "m")),
        ("m/s", 2e-5, (1e3, "mm/s")),
        ("N", 2000.0, (1.0, "N")),
        ("N", 5e4, (1e-3, "kN")),
        ("N.m", 200.0, (1.0, "N m")),
        ("", 3.0, (1.0, "1")),
        ("kg.m2", 0.0, (1.0, "kg m2")),
    ],
)
def test_units_are_scaled_for_reading(unit, peak, expected):
    assert scaled_unit(unit, peak) == expected
