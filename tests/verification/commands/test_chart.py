"""The speed-accuracy chart of the test rig: orders of convergence, and what an iteration buys."""

import json
import math

import numpy as np
import pytest

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import ParameterError
from herringbone.housing import default_housing

T_END = 0.005
JACOBI_1, JACOBI_2, LI_3 = "jacobi:order=1", "jacobi:order=2", "li:degree=3"
STEPS = {JACOBI_2: (2e-6, 4e-6, 8e-6), LI_3: (2e-5, 4e-5)}
"""Steps of the asymptotic range: below the stability limit, above the error of the micro steps."""


@pytest.fixture(scope="module")
def chart():
    return hb.chart(
        "test_rig",
        algorithms=(JACOBI_1, JACOBI_2, LI_3),
        steps=(2e-6, 4e-6, 8e-6, 2e-5, 4e-5),
        t_end=T_END,
        fmu="in-process",
    )


def errors(chart, name):
    """Error by step [us]."""
    algorithm = next(a for a in chart.algorithms if a.startswith(name))
    return {round(p.step * 1e6): p.worst for p in chart.of(algorithm)}


@pytest.mark.parametrize(("name", "order"), [(JACOBI_2, 3), (LI_3, 4)])
def test_slope(chart, name, order):
    found = errors(chart, name)
    steps = STEPS[name]
    slope = np.polyfit(np.log(steps), [math.log(found[round(h * 1e6)]) for h in steps], 1)[0]
    assert slope == pytest.approx(order, abs=0.4)


def test_li_is_a_hundred_times_more_accurate(chart):
    assert errors(chart, LI_3)[20] < errors(chart, JACOBI_1)[20] / 100.0


def test_cost_and_internals(chart):
    assert (chart.mode_count, chart.micro_step) == (default_housing().frequency_hz.size, 2.5e-6)
    for p in chart.points:
        passes = p.passes_per_ms * p.step / 1e-3
        if p.algorithm.startswith("li"):
            assert 2.0 < passes < 3.0  # two passes, and Jacobians
        else:
            assert passes == pytest.approx(1.0)
        assert p.wall_s > 0.0


def test_curve_of_adaptive_li():
    """Error over tolerance between 0.1 and 5, at the twin's values where the steps end."""
    tolerances = (1e-2, 1e-3, 1e-4)
    found = hb.chart(
        "test_rig", algorithms=(LI_3,), steps=(4e-5,), tolerances=tolerances, t_end=0.02,
        fmu="in-process",
    )  # fmt: skip
    (_, curve) = found.algorithms
    assert curve == "li:degree=3,iterations=1,tolerance=*"
    points = found.of(curve)
    for p, tolerance in zip(points, sorted(tolerances), strict=True):
        assert p.algorithm == f"li:degree=3,iterations=1,tolerance={tolerance}"
        assert 0.1 < p.worst / tolerance < 5.0
    assert found.reach(curve, 1e-3).step > points[0].step


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"tolerances": (2.0,)}, "li: tolerance=2; it must lie between"),
        ({"tolerances": (0.0,)}, "tolerances: 0 keeps the step"),
        ({"algorithms": ("li:tolerance=1e-3",)}, "over steps or over tolerances; leave the"),
    ],
)
def test_bad_tolerances(options, words):
    with pytest.raises(ParameterError, match=words):
        hb.chart("test_rig", **options)


def test_command(tmp_path, capsys):
    arguments = ["test_rig", "--algorithm", JACOBI_1, "--steps", "20e-6", "80e-6", "100e-6"]
    where = ["--t-end", "0.005", "--fmu", "in-process", "-o", str(tmp_path / "out"), "--json"]
    assert main(["chart", *arguments, *where]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [p["step"] for p in found["points"]] == pytest.approx([2e-5, 8e-5, 1e-4], rel=0.02)
    assert [p["error"]["bearing_force"] for p in found["points"][:1]] == pytest.approx([0.04], 0.9)
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert names == {"chart.csv", "chart.json", "chart.png"}
