"""The speed-accuracy chart of the test rig: orders of convergence, and what an iteration buys."""

import json
import math

import numpy as np
import pytest

from herringbone.chart_command import measure
from herringbone.cli import main
from herringbone.housing import default_housing

T_END = 0.005
JACOBI_1, JACOBI_2, LI_3 = "jacobi:order=1", "jacobi:order=2", "li:degree=3"
STEPS = {JACOBI_2: (2e-6, 4e-6, 8e-6), LI_3: (2e-5, 4e-5)}
"""Steps of the asymptotic range: below the stability limit, above the error of the micro steps."""


@pytest.fixture(scope="module")
def chart():
    return measure(
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


def test_command(tmp_path, capsys):
    arguments = ["test_rig", "--algorithm", JACOBI_1, "--steps", "20e-6", "80e-6", "100e-6"]
    where = ["--t-end", "0.005", "--fmu", "in-process", "-o", str(tmp_path / "out"), "--json"]
    assert main(["chart", *arguments, *where]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [p["step"] for p in found["points"]] == pytest.approx([2e-5, 8e-5, 1e-4], rel=0.02)
    assert [p["error"]["bearing_force"] for p in found["points"][:1]] == pytest.approx([0.04], 0.9)
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert names == {"chart.csv", "chart.json", "chart.png"}
