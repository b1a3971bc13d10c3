"""What commands do, scripts can do: the same names, files, numbers and errors."""

import json
from zipfile import ZipFile

import pytest

import herringbone as hb
from herringbone.analysis.stability.limits import default_algorithms
from herringbone.commands.main import BAD_INPUT, main
from herringbone.core import ParameterError
from herringbone.cosim.algorithms import ALGORITHMS

ALGORITHM, STEP = "jacobi:order=1", 1e-4


def test_stability(capsys):
    assert main(["stability", "gearbox", "--algorithm", ALGORITHM, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    found = hb.stability("gearbox", algorithms=[hb.Jacobi(order=1)])
    assert found.limits[0].limit == told["algorithms"][0]["limit"]
    assert 'algorithm="jacobi:order=1" step=' in str(found)
    assert "jacobi:order=1" in repr(found)
    reached = []
    (verdict,) = hb.stability("gearbox", algorithms=[ALGORITHM], step=STEP, progress=reached.append)
    assert verdict.stable == (found.limits[0].limit > STEP)
    assert all(name.startswith(ALGORITHM) for name in reached)
    capsys.readouterr()
    hb.stability("gearbox", algorithms=[ALGORITHM], step=STEP, progress=True)
    assert f"{len(reached)} matrices" in capsys.readouterr().err


def test_chart(tmp_path):
    asked = ["--algorithm", ALGORITHM, "--steps", "2e-5", "--t-end", "2e-3", "--fmu", "in-process"]
    assert main(["chart", "gearbox", *asked, "-o", str(tmp_path)]) == 0
    (told,) = json.loads((tmp_path / "chart.json").read_text())["points"]
    own = {"steps": [2e-5], "t_end": 2e-3, "fmu": "in-process"}
    reached = []
    found = hb.chart(
        "gearbox", algorithms=[ALGORITHM], progress=lambda *run: reached.append(run), **own
    )
    assert dict(found.points[0].error) == told["error"]
    assert len(reached) == 1
    assert len(found.plot().axes) > 1
    assert "1 of 0.002 s, 1 of them good" in repr(found)


def test_export(tmp_path):
    """Start values alone, which take no compiler, and a system of Python FMUs."""
    one, other = tmp_path / "one.ssv", tmp_path / "other.ssv"
    assert main(["export", "gearbox", "--as-fmu", "-o", str(one)]) == 0
    assert hb.export("gearbox", other, as_fmu=True) == other
    assert one.read_bytes() == other.read_bytes()
    system = hb.export("gearbox", tmp_path / "gearbox.ssp", python=True)
    with ZipFile(system) as archive:
        assert any(name.endswith("gear_mesh.fmu") for name in archive.namelist())


@pytest.mark.parametrize(
    ("asked", "options", "said"),
    [
        ({"as_fmu": True, "step": 1e-4}, ["--as-fmu", "--step", "1e-4"], "of .ssp files"),
        ({"as_fmu": True, "nested": True}, ["--as-fmu", "--nested"], "of .ssp files"),
        ({"plan": True}, ["--plan"], "of one FMU"),
        ({"me": True}, ["--me"], "of one FMU"),
        ({"fmi": 3}, ["--fmi", "3"], "of one FMU"),
        ({"outside": ["modal_housing"]}, ["--outside", "modal_housing"], "of one FMU"),
        ({"python": True, "platforms": ["all"]}, ["--python", "--platforms", "all"], "of Python"),
    ],
)
def test_wrong_exports_are_told_in_the_words_of_each(asked, options, said, capsys, tmp_path):
    name = list(asked)[-1] if "python" not in asked else "python"
    with pytest.raises(hb.HerringboneError, match=f"^{name}: {said}"):
        hb.export("gearbox", tmp_path / "x.ssp", **asked)
    assert main(["export", "gearbox", *options]) == BAD_INPUT
    assert f"--{name}: {said}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("asked", "options"),
    [({"platforms": ["all"]}, ["--platforms", "all"]), ({"fmi": 3}, ["--fmi", "3"])],
)
def test_start_values_alone_have_no_binaries(asked, options, capsys, tmp_path):
    """They said "built, not run"."""
    (name,), file = asked, tmp_path / "x.ssv"
    with pytest.raises(hb.HerringboneError, match=f"^{name}: of FMUs; a .ssv file has start"):
        hb.export("gearbox", file, as_fmu=True, **asked)
    assert main(["export", "gearbox", "--as-fmu", "-o", str(file), *options]) == BAD_INPUT
    assert f"--{name}: of FMUs" in capsys.readouterr().err
    assert not file.exists()


@pytest.mark.parametrize("file", ["x.ssv", "x.fmu", "x.ssp"])
def test_unknown_platform_is_told(file, tmp_path):
    with pytest.raises(hb.HerringboneError, match=r"^platform 'windoze' is unknown; there are: "):
        hb.export("gearbox", tmp_path / file, as_fmu=file != "x.ssp", platforms=["windoze"])


def test_flanges_are_checked_by_name():
    with pytest.raises(hb.HerringboneError, match=r"^wheel = 'force': it takes torque or"):
        hb.export("gearbox", as_fmu=True, wheel="force")


def test_one_step_takes_no_runs(capsys):
    with pytest.raises(hb.HerringboneError, match=r"^step asks about one step; leave simulate out"):
        hb.stability("gearbox", step=STEP, simulate=True)
    assert main(["stability", "gearbox", "--step", "1e-4", "--simulate"]) == BAD_INPUT
    assert "--step asks about one step; leave --simulate out" in capsys.readouterr().err


def test_algorithms_that_a_system_cannot_have_are_told_once(monkeypatch, capsys):
    """Those that are named are refused."""

    def refuse(self, network):
        raise ParameterError("gear_mesh takes no signal nodes")

    monkeypatch.setattr(ALGORITHMS["predict"], "prepare", refuse)
    found = hb.stability("gearbox", step=STEP)
    assert main(["stability", "gearbox", "--step", f"{STEP}"]) == 0
    assert capsys.readouterr().out == f"{found}\n"
    assert found.notes == ("predict: gear_mesh takes no signal nodes",)
    assert len(found) == len(default_algorithms()) - 1
    with pytest.raises(ParameterError, match="no signal nodes"):
        hb.stability("gearbox", step=STEP, algorithms=["predict"])


def test_a_results_folder_of_a_script(tmp_path, capsys):
    """Commands read it; another run of a script, or a command, does not overwrite it unasked."""
    folder, own = tmp_path / "run", {"t_end": 2e-3, "fmu": "in-process"}
    ended = []
    result = hb.run("gearbox", output=str(folder), recorded=ended.append, **own)
    assert ended[0].data.equals(result.data)
    assert hb.load(folder).data.equals(result.data)
    assert str(folder / "results.csv") in result.files
    assert main(["compare", str(folder), str(folder)]) == 0
    assert main(["run", "--resume", str(folder)]) == BAD_INPUT
    other = {**own, "t_end": 3e-3}
    with pytest.raises(hb.HerringboneError, match="choose another folder, or overwrite=True"):
        hb.run("gearbox", output=folder, **other)
    capsys.readouterr()
    assert main(["run", "gearbox", "-o", str(folder)]) == BAD_INPUT
    assert "choose another folder, or --overwrite" in capsys.readouterr().err
    assert hb.run("gearbox", output=folder, overwrite=True, **other).info.t_end == 3e-3
