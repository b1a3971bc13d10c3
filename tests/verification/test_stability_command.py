"""`herringbone stability`: what it prints, as text and as JSON, what it writes, and its picture."""

import json

import numpy as np
import pytest

from herringbone.analysis.amplification import GROWTH, Amplification
from herringbone.analysis.atlas import Panel
from herringbone.analysis.linear_parts import linear_network
from herringbone.analysis.simulated_limit import nonlinear_limit
from herringbone.cli import main
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.system_file import find_system, read_system
from herringbone.plotting.stability_atlas import atlas_picture
from herringbone.scenes import find_scene, read_scene
from herringbone.start import started


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("stability")


@pytest.fixture(scope="module")
def printed(folder):
    """JSON that the command writes for one algorithm."""
    arguments = ["stability", "test_rig", "--algorithm", "jacobi:order=2"]
    arguments += ["--simulate", "-o", str(folder)]
    assert main(arguments) == 0
    return json.loads((folder / "stability.json").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_json_has_limits_bonds_and_a_recommendation(printed):
    (found,) = printed["algorithms"]
    assert found["algorithm"] == "jacobi:order=2,schedule=bodies_first"
    assert set(found["mesh_stiffness"]) == {"minimum", "mean", "maximum"}
    assert found["limit"] == min(found["mesh_stiffness"].values())
    assert found["unstable_bands"][0][0] == found["mesh_stiffness"]["mean"]
    assert found["unstable_bands"][-1][1] is None
    assert found["limit"] < found["simulated_limit"] < 1.1 * found["limit"]
    assert len(printed["bonds"]) == 8
    assert {"bond", "frequency", "damping_ratio", "masses", "limits"} <= set(printed["bonds"][0])
    recommended = printed["recommended"]
    assert recommended["algorithm"] == found["algorithm"]
    assert 0.0 < recommended["step"] < found["limit"]


@pytest.mark.slow
def test_text_says_the_same(printed, folder):
    text = (folder / "stability.txt").read_text(encoding="utf-8")
    assert f"from {1e6 * printed['algorithms'][0]['unstable_bands'][-1][0]:.1f}" in text
    assert f"--step {printed['recommended']['step']:.3g}" in text
    assert "bearing_supports.shaft.pinion_left.f_y" in text


@pytest.mark.slow
def test_one_step_is_judged_and_explained(capsys):
    arguments = ["stability", "test_rig", "--algorithm", "jacobi:order=2", "--json", "--step"]
    assert main([*arguments, "2e-5"]) == 0
    (stable,) = json.loads(capsys.readouterr().out)
    assert stable["stable"] and stable["growth"] < 0.0 and stable["why"] is None
    assert main([*arguments, "5e-5"]) == 0
    (unstable,) = json.loads(capsys.readouterr().out)
    assert not unstable["stable"]
    assert unstable["growth"] >= unstable["why"]["growth"] > 0.01
    assert unstable["why"]["bonds"][0][0].startswith("bearing_supports.shaft.pinion")
    assert sum(share for _, share in unstable["why"]["bonds"]) == pytest.approx(1.0)
    assert unstable["why"]["remedies"][0].startswith("a step below")


def test_runs_become_unstable_just_beyond_the_linear_limit():
    """Within 10 %: 1000 steps show no slower growth, and the teeth hold it at a finite size."""
    folder = find_system("test_rig")
    rig, _ = started(read_system("test_rig"), read_scene(find_scene(folder, "loaded")))
    growth = Amplification(*linear_network(rig), Jacobi(2)).growth
    below = next(h for h in np.geomspace(60e-6, 30e-6, 70) if growth(h).radius <= 1.0 + GROWTH)
    found = nonlinear_limit(rig, Jacobi(2), below)
    assert 0.98 * below < found < 1.1 * below


def test_no_limit_is_looked_for_without_a_prediction():
    assert nonlinear_limit(None, Jacobi(2), np.inf) is None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--algorithm", "jacobi:order=7"], "order=7; it must be 0, 1 or 2"),
        (["--algorithm", "jacobi:order=2", "--tolerance", "3"], "tolerance = 3"),
        (["--scene", "nothing"], "nothing"),
        (["--step", "-1"], "step = -1 s: it must be positive"),
        (["--step", "1e-5", "--atlas"], "--step asks about one step; leave --atlas out"),
    ],
)
def test_bad_input_is_one_line(arguments, words, capsys):
    assert main(["stability", "test_rig", *arguments]) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert words in lines[-1]
    assert lines[-1].startswith("herringbone: ")


def test_picture_has_a_line_and_points_per_algorithm():
    values = (0.01, 0.1)
    limits = {"jacobi:order=1,schedule=bodies_first": (0.4, 0.9), "li": (5.0, 5.5)}
    points = {"li": (5.1, np.nan)}
    figure = atlas_picture([Panel("title", "damping ratio", values, limits, points)])
    (ax,) = figure.axes
    assert ax.get_xlabel() == "damping ratio"
    drawn = [tuple(line.get_ydata()) for line in ax.get_lines()]
    assert {(0.4, 0.9), (5.0, 5.5)} <= set(drawn)
    assert any(line.get_marker() == "o" for line in ax.get_lines())
