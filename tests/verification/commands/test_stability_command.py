"""`herringbone stability`: what it prints, as text and as JSON, what it writes, and its picture."""

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from herringbone.analysis.stability import limits as stability_module
from herringbone.analysis.stability.atlas import Panel
from herringbone.analysis.stability.bonds import Bond
from herringbone.analysis.stability.limits import Stability, default_algorithms
from herringbone.analysis.stability.linear_parts import MeshStiffness
from herringbone.analysis.stability.recommendation import Ranking, Recommendation
from herringbone.analysis.stability.report import stability_summary, stability_text
from herringbone.analysis.stability.steps.simulated_limit import nonlinear_limit
from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.analysis.stability.steps.step_verdict import StepVerdicts
from herringbone.commands.main import main
from herringbone.core import HerringboneError
from herringbone.core.caching import answers
from herringbone.core.caching.files import kept
from herringbone.core.places.paths import CACHE_VARIABLE, PACKAGE, cache_root, components_folder
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.structure.system_file import find_system
from herringbone.plotting.stability_atlas import atlas_picture, write_atlas
from herringbone.running.operating import stability as operating

OF_PYTHON = (sys.prefix, sys.base_prefix, "/proc", "/dev", "/sys", "/usr", "/etc")
"""Where files of Python, of libraries and of the machine lie."""


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
    runs = found["simulated_limit"]  # known to half a percent to both sides
    assert found["limit"] < 1.005 * runs < 1.1 * found["limit"]
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
    assert "gearbox.bearing_supports.shaft.pinion_left.f_y" in text


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
    assert unstable["why"]["bonds"][0][0].startswith("gearbox.bearing_supports.shaft.pinion")
    assert sum(share for _, share in unstable["why"]["bonds"]) == pytest.approx(1.0)
    assert unstable["why"]["remedies"][0].startswith("a step below")


def test_no_limit_is_looked_for_without_a_prediction():
    assert nonlinear_limit(None, Jacobi(2), np.inf) is None


def made_up():
    """A result with long names and many bands."""
    bands = tuple((700e-6 + 1e-5 * k, 705e-6 + 1e-5 * k) for k in range(6))
    limits = [
        StepLimits(
            str(algorithm),
            (*bands, (1.1e-3, np.inf)),
            dict.fromkeys(MeshStiffness, 7e-4),
            73.0,
            7e-4,
        )
        for algorithm in default_algorithms()
    ]
    name = "gearbox.bearing_supports.shaft.pinion_right.f_y"
    bodies = ("gearbox.gear_mesh", "gearbox.modal_housing")
    bond = Bond(name, bodies, (6.5, 6.284), 6.34e8, 2.5e3, 14087.0, 0.029)
    recommended = Recommendation(str(Jacobi(2)), 1e-5, 4.4e-8, 5e-5, "micro steps")
    ranking = Ranking((recommended, replace(recommended, algorithm=str(LI(3)), step=2e-5)))
    return Stability(
        "test_rig", "loaded", tuple(limits), (bond,), 14e3, 1e-3, ranking, ("word " * 40,)
    )


def test_text_fits_in_100_columns_and_says_everything():
    text = stability_text(made_up())
    assert max(map(len, text.splitlines())) <= 100
    for algorithm in default_algorithms():
        assert str(algorithm).removesuffix(",schedule=bodies_first") + " " in text
    for low in range(700, 760, 10):
        assert text.count(f"{low}.0-{low + 5}.0") == len(default_algorithms())
    assert text.count("from 1100.0") == len(default_algorithms())
    assert "gearbox.gear_mesh 6.5 kg, gearbox.modal_housing 6.284 kg" in text
    assert text.count("word") == 40


def test_what_bounds_the_error_is_said():
    said = "expected error 4.4e-06 %, bounded by micro steps; 0.005 % where teeth separate"
    assert said in stability_text(made_up()).splitlines()
    summary = stability_summary(made_up())
    recommended = summary["recommended"]
    assert summary["ranking"][0] == recommended
    assert [r["passes_per_ms"] for r in summary["ranking"]] == pytest.approx([100.0, 50.0])
    assert recommended["expected_error"] == 4.4e-8
    assert recommended["separation_error"] == 5e-5
    assert recommended["bounded_by"] == "micro steps"


def test_written_files_are_named(monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(stability_module, "stability", lambda *_, **__: made_up())
    arguments = ["stability", "test_rig", "-o", str(tmp_path)]
    files = [str(tmp_path / f"stability.{kind}") for kind in ("txt", "json")]
    assert main(arguments) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "Files: " + ", ".join(files)
    assert main([*arguments, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["results"] == files
    (tmp_path / "stability.json").unlink()
    (tmp_path / "stability.json").mkdir()
    assert main(arguments) == 2
    said = capsys.readouterr().err.splitlines()
    assert said == [
        f"herringbone: cannot write to {tmp_path}: Is a directory; choose another folder with -o"
    ]


@pytest.fixture
def question(tmp_path, capsys):
    """A system of one's own with a scene and a gear file, and a quick question about it."""
    shipped = find_system("gearbox")
    system = Path(
        shutil.copytree(shipped, tmp_path / "mine", ignore=shutil.ignore_patterns("*.md"))
    )
    gear = tmp_path / "mine.toml"
    assert main(["template", "gear", "-o", str(gear)]) == 0
    capsys.readouterr()
    text = gear.read_text(encoding="utf-8")
    assert 'method = "auto"' in text  # a table by finite elements, which is not what is asked
    gear.write_text(text.replace('method = "auto"', 'method = "slices"'), encoding="utf-8")
    files = ["--gear", str(gear), "--scene", str(system / "scenes/loaded.toml")]
    return ["stability", str(system), *files, "--algorithm", "jacobi:order=0", "--step", "1e-5"]


def test_an_answer_is_told_again(question, capsys, monkeypatch, tmp_path):
    """Until a file changes, be it by a remark."""
    told = [main(question), capsys.readouterr()]
    found = operating.verdicts_before
    monkeypatch.setattr(operating, "verdicts_before", None)
    assert [main(question), capsys.readouterr()] == told
    assert main([*question, "--json"]) == 0
    (verdict,) = json.loads(capsys.readouterr().out)
    assert verdict["stable"] and "stable" in told[1].out
    monkeypatch.setattr(
        operating, "verdicts_before", lambda *a: StepVerdicts([*found(*a), *found(*a)])
    )
    assert main(question) == 0 and capsys.readouterr().out == told[1].out
    (tmp_path / "mine" / "scenes" / "loaded.toml").open("a").write("# a remark\n")
    assert main(question) == 0 and capsys.readouterr().out == 2 * told[1].out


def test_all_files_that_an_answer_was_read_from_are_looked_at(question, tmp_path):
    """Python tells of each file that is opened; those of the package and of its cache are keyed."""
    opened = set()

    def hear(event, arguments):
        if event == "open" and isinstance(arguments[0], str) and hearing:
            opened.add(str(Path(arguments[0]).absolute()))

    hearing = True
    sys.addaudithook(hear)
    assert main(question) == 0
    hearing = False
    (kept_in,) = Path(answers.FOLDER).iterdir()
    looked_at = set(kept(kept_in)["files"])
    own = {str(tmp_path / name) for name in ("mine.toml", "mine/system.toml")}
    assert own < looked_at
    keyed = tuple(map(str, (PACKAGE, cache_root(), components_folder(), answers.FOLDER)))
    others = {file for file in opened - looked_at if not file.startswith((*keyed, *OF_PYTHON))}
    assert others == set()


def test_a_known_answer_loads_nothing_heavy(tmp_path):
    """A whole process takes 0.08 s of CPU then, with numba 1.5 s."""
    fmu = tmp_path / "a.fmu"
    question = ["stability", str(fmu), "--inertia", "1"]
    script = (
        "import sys\n"
        "from herringbone.commands import answers, main\n"
        "from herringbone.commands.checking import flange\n"
        "told = answers.Told('limits', {'a': 1})\n"
        "flange.flange_limits = lambda options: told\n"
        f"assert main.main({question}) == 0\n"
        "flange.flange_limits = None\n"
        f"assert main.main({question}) == 0\n"
        "print(*sys.modules)"
    )
    shown = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True,
        env={**os.environ, CACHE_VARIABLE: str(tmp_path / "cache")},
    ).stdout.splitlines()  # fmt: skip
    assert shown[:2] == ["limits"] * 2
    heavy = {"numba", "numpy", "pandas", "scipy", "matplotlib", "fmpy", "tqdm", "email"}
    assert heavy.isdisjoint(shown[2].split())


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--algorithm", "jacobi:order=7"], "order=7; it must be 0, 1 or 2"),
        (["--algorithm", "jacobi:order=2", "--tolerance", "3"], "tolerance = 3"),
        (["--tolerance", "1e-12"], "tolerance = 1e-12: it must lie between 1e-08 and 1"),
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
    nothing = (np.nan, np.nan)
    limits = {"jacobi:order=1,schedule=bodies_first": (0.4, 0.9), "li": (5.0, 5.5)}
    points = {"jacobi:order=1,schedule=bodies_first": nothing, "li": (5.1, np.nan)}
    figure = atlas_picture([Panel("title", "damping ratio", values, limits, points)])
    (ax,) = figure.axes
    assert ax.get_xlabel() == "damping ratio"
    drawn = [tuple(line.get_ydata()) for line in ax.get_lines()]
    assert {(0.4, 0.9), (5.0, 5.5)} <= set(drawn)
    (seen,) = (line for line in ax.get_lines() if line.get_marker() != "None")
    assert seen.get_ydata()[0] == 5.1
    legends = [[text.get_text() for text in legend.get_texts()] for legend in figure.legends]
    assert legends[0] == ["jacobi:order=1", "li"]
    assert "mesh frozen at mean stiffness" in legends[1][1]


def test_picture_that_cannot_be_written_is_one_line(tmp_path):
    (tmp_path / "stability_atlas.png").mkdir()
    panel = Panel("title", "damping ratio", (0.1,), {"li": (5.0,)}, {"li": (5.1,)})
    with pytest.raises(HerringboneError, match=r"cannot write .*atlas.png: Is a directory; choose"):
        write_atlas([panel], tmp_path / "stability_atlas.png")
