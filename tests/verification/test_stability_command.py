"""`herringbone stability`: what it prints, as text and as JSON, what it writes, and its picture."""

import json

import numpy as np
import pytest

from herringbone.analysis.atlas import Panel
from herringbone.cli import main
from herringbone.plotting.stability_atlas import atlas_picture


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("stability")


@pytest.fixture(scope="module")
def printed(folder):
    """JSON that the command writes for one algorithm."""
    arguments = ["stability", "test_rig", "--algorithm", "jacobi:order=2", "-o", str(folder)]
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


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--algorithm", "jacobi:order=7"], "order=7; it must be 0, 1 or 2"),
        (["--algorithm", "jacobi:order=2", "--tolerance", "3"], "tolerance = 3"),
        (["--scene", "nothing"], "nothing"),
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
