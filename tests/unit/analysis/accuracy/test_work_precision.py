"""Speed-accuracy charts: Pareto front, interpolated steps, table grammar, failures, the picture."""

import csv
import json
import math
from dataclasses import replace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.accuracy.step_ladder import (
    FEWEST_STEPS,
    charted_algorithms,
    ladder,
    left_out,
)
from herringbone.analysis.accuracy.variant_labels import variant_labels
from herringbone.analysis.accuracy.work_precision import Point, WorkPrecision
from herringbone.commands.chart.report import table
from herringbone.core import ParameterError
from herringbone.cosim.algorithms import ALGORITHMS, parse_algorithm
from herringbone.plotting.work_precision import chart_picture, write_chart
from herringbone.running.charting.chart import said_once

CHEAP, GOOD = "jacobi:order=1,schedule=bodies_first", "li:degree=3,iterations=1"
KEYS = {
    "model", "mode_count", "micro_step", "algorithm", "step", "passes_per_ms", "wall_s",
    "cpu_s", "t_reached", "error", "outcome",
}  # fmt: skip


def point(algorithm, step, error, passes=1, outcome="completed"):
    errors = {"bearing_force": error, "seat_velocity": error / 2.0}
    times = 2e-7 / step, 1e-7 / step
    return Point(algorithm, step, passes * 1e-3 / step, *times, 0.02, errors, outcome)


def chart():
    """Order 2 at one pass, order 4 at two; both fail at large steps."""
    return WorkPrecision(
        "test_rig", "loaded", 0.02, "in-process", 52, 2.5e-6,
        (
            *(point(CHEAP, h, 1e-4 * (h / 1e-6) ** 2) for h in (1e-6, 2e-6, 5e-6, 10e-6)),
            point(CHEAP, 50e-6, 7.0),
            point(CHEAP, 80e-6, math.inf, outcome="diverged"),
            *(point(GOOD, h, 1e-4 * (h / 20e-6) ** 4, 2) for h in (1e-6, 5e-6, 20e-6, 40e-6)),
        ),
        ("a note",),
    )  # fmt: skip


def test_what_all_algorithms_have_in_common_is_said_once():
    ours = "a unit is not declared"
    found = [
        (point(CHEAP, 1e-6, 1e-4), (f"{CHEAP}: {ours}", f"{CHEAP}: held")),
        (point(CHEAP, 2e-6, 1e-4), (f"{CHEAP}: {ours}",)),
        (point(GOOD, 1e-6, 1e-4), (f"{GOOD}: {ours}",)),
    ]
    assert list(said_once(found)) == [ours, f"{CHEAP}: held"]


def test_pareto_front():
    found = chart().front(lambda p: p.passes_per_ms)
    assert [(p.algorithm, p.step) for p in found] == [
        (GOOD, 40e-6), (GOOD, 20e-6), (GOOD, 5e-6), (GOOD, 1e-6)
    ]  # fmt: skip
    by_wall = chart().front(lambda p: p.wall_per_ms)
    assert all(not p.failed for p in by_wall)
    assert np.all(np.diff([p.worst for p in by_wall]) < 0.0)


def test_time_is_that_of_the_processor_but_where_parts_are_apart():
    """The picture's axis, and the values on it."""
    for foreign, label, cost in (
        (False, "CPU time", "cpu_per_ms"),
        (True, "wall time", "wall_per_ms"),
    ):
        panel = chart_picture(replace(chart(), foreign=foreign)).axes[2]
        assert panel.get_xlabel().startswith(label)
        line = next(line for line in panel.lines if line.get_label().startswith("li:degree=3"))
        best = chart().of(GOOD)[-1]
        assert line.get_xdata()[-1] == pytest.approx(getattr(best, cost))


def test_failures_are_kept():
    found = chart()
    assert [p.step for p in found.points if p.failed] == [50e-6, 80e-6]
    assert [row["error"]["bearing_force"] for row in found.rows()[4:6]] == [7.0, None]


def test_an_unstable_run_is_a_failure_whatever_its_error():
    assert point(CHEAP, 50e-6, 0.01, outcome="unstable").failed
    assert not point(CHEAP, 50e-6, 0.01).failed


def test_tolerances_make_one_curve():
    name = "li:degree=3,iterations=1,tolerance="
    points = [point(f"{name}{t:g}", h, t) for t, h in ((1e-3, 2e-5), (1e-4, 1e-5))]
    found = replace(chart(), points=(*chart().points, *points))
    assert found.algorithms == (CHEAP, GOOD, f"{name}*")
    assert [p.step for p in found.of(f"{name}*")] == [1e-5, 2e-5]


def test_reach_interpolates_in_logarithms():
    reach = chart().reach(CHEAP, 1e-3)
    assert reach.limited == "error"
    assert reach.step == pytest.approx(1e-6 * math.sqrt(10.0))
    assert reach.passes_per_ms == pytest.approx(1e-3 / reach.step)


def test_reach_at_its_limits():
    found = chart()
    assert found.reach(CHEAP, 1e-5) is None
    assert (found.reach(CHEAP, 0.5).step, found.reach(CHEAP, 0.5).limited) == (10e-6, "failure")
    assert (found.reach(GOOD, 0.5).step, found.reach(GOOD, 0.5).limited) == (40e-6, "ladder")


def test_json_keys():
    found = json.loads(json.dumps(chart().summary(), allow_nan=False))
    assert set(found) == {"system", "scene", "t_end", "fmu", "points", "notes"}
    assert all(set(row) == KEYS for row in found["points"])


def test_csv_grammar(tmp_path):
    chart().to_csv(tmp_path / "chart.csv")
    with (tmp_path / "chart.csv").open(encoding="utf-8") as stream:
        assert stream.readline().startswith("# units: micro_step s, step s, passes_per_ms 1/ms")
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(chart().points)
    assert set(rows[0]) == KEYS - {"error"} | {"error_bearing_force", "error_seat_velocity"}
    assert [float(row["step"]) for row in rows] == [p.step for p in chart().points]
    assert rows[5]["error_bearing_force"] == ""


def test_ladder_leaves_out_short_runs():
    found = ladder((1e-5, 2e-4, 1e-6, 1e-4), 0.005)
    assert [g.count for g in found] == [5000, 500, FEWEST_STEPS]
    assert left_out((1e-5, 2e-4, 1.0), 0.005) == (
        "steps: 0.0002, 1 s: fewer than 50 macro steps in 0.005 s, left out",
    )
    assert left_out((1e-5, 1e-4), 0.005) == ()
    with pytest.raises(ParameterError, match="longer t_end"):
        ladder((1e-3, 1.0), 0.005)
    with pytest.raises(ParameterError, match="positive"):
        ladder((1e-5, -1e-5), 0.005)


def test_automatic_choice_is_no_algorithm_to_compare():
    with pytest.raises(ParameterError, match="auto is a choice"):
        hb.chart("test_rig", algorithms=["auto"])


def test_every_algorithm_is_charted():
    found = charted_algorithms()
    assert {a.name for a in found} == {n for n, kind in ALGORITHMS.items() if kind.charted()}
    assert len(set(found)) == len(found)
    assert all(parse_algorithm(str(a)) == a for a in found)


def test_labels_are_what_the_command_takes():
    parallel = ("jacobi:order=1,schedule=parallel", "jacobi:order=2,schedule=parallel")
    for algorithms in (tuple(map(str, charted_algorithms())), parallel, ("predict", CHEAP, GOOD)):
        labels = variant_labels(algorithms)
        assert all(parse_algorithm(labels[a]) == parse_algorithm(a) for a in algorithms)


def test_labels_show_what_differs():
    labels = variant_labels((CHEAP, "jacobi:order=2,schedule=bodies_first"))
    assert list(labels.values()) == ["jacobi:order=1", "jacobi:order=2"]
    adaptive = f"{GOOD},tolerance=*"
    labels = variant_labels((GOOD, adaptive))
    assert labels == {GOOD: "li:degree=3", adaptive: "li:tolerance=*"}
    assert variant_labels(("predict", GOOD)) == {"predict": "predict", GOOD: "li:degree=3"}
    thrice = "fixed_point:degree=3,sweeps=3"
    assert variant_labels((thrice,)) == {thrice: "fixed_point:sweeps=3"}


def test_axis_reaches_down_to_the_smallest_error():
    points = (point(GOOD, 1e-6, 5.9e-9), point(GOOD, 2e-6, 0.0), point(GOOD, 5e-6, 1e-4))
    axes = chart_picture(replace(chart(), points=points)).axes[0]
    assert axes.get_ylim() == pytest.approx((1e-9, 1.0))


def test_picture(tmp_path):
    figure = chart_picture(chart())
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    assert labels == ["Pareto front", "jacobi:order=1  (3.16 µs)", "li:degree=3  (35.6 µs)"]
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert texts.count("80 µs") == 2
    write_chart(chart(), tmp_path / "chart.png")
    assert (tmp_path / "chart.png").stat().st_size < 2e5


def test_legend_marks_what_the_table_marks():
    """The ladder ends below the level, or the next step fails."""
    points = (*(point(GOOD, h, 1e-4) for h in (1e-6, 20e-6)), point(CHEAP, 1e-6, 1e-4))
    failed = point(CHEAP, 2e-6, math.inf, outcome="diverged")
    found = replace(chart(), points=(*points, failed))
    legend = chart_picture(found).legends[0]
    labels = [text.get_text() for text in legend.get_texts()]
    assert labels[1:] == ["li:degree=3  (>20 µs)", "jacobi:order=1  (!1 µs)"]
    rows = [line.split() for line in table(found, []).splitlines()[3:5]]
    assert [row[3] for row in rows] == [">20.0", "!1.0"]
    explained = ["> no larger step was tried", "! the next larger one failed"]
    assert legend.get_title().get_text().splitlines()[1:] == explained


def test_legend_has_room_for_the_longest_names():
    points = tuple(point(str(a), 104e-6, 1e-4) for a in charted_algorithms())
    figure = chart_picture(replace(chart(), points=points))
    assert figure.legends[0].get_window_extent().x1 < figure.bbox.x1


def test_table():
    lines = table(chart(), ["chart.csv"]).splitlines()
    assert lines[3].split() == [CHEAP, "10.0", "100", "3.2", "316"]
    assert lines[4].split() == [GOOD, ">40.0", "50", "35.6", "56"]
    assert "a note" in lines
