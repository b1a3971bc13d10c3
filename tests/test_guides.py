"""The guides: what they link to exists, and their code is taken out of the pages and run."""

import importlib.util
import re
import runpy
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from support import algorithms as conformance

import herringbone as hb
from herringbone.components import registry
from herringbone.core import Instance
from herringbone.cosim.algorithms import ALGORITHMS
from herringbone.housing import importers
from herringbone.scenes import read_scene

ROOT = Path(__file__).parents[1]
PAGES = [
    *sorted((ROOT / "docs").glob("*.md")),
    *(ROOT / f"{n}.md" for n in ("CONTRIBUTING", "SECURITY")),
]
LINKS = [
    (page, link)
    for page in PAGES
    for link in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8"))
    if "://" not in link
]


def blocks(page: str, kind: str) -> list[str]:
    """The code of one kind on a page of the guides."""
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def module(folder: Path, page: str, name: str):
    """The first Python block of a page, as a module of that name."""
    file = folder / f"{name}.py"
    file.write_text(blocks(page, "python")[0], encoding="utf-8")
    spec = importlib.util.spec_from_file_location(name, file)
    found = importlib.util.module_from_spec(spec)
    sys.modules[name] = found
    spec.loader.exec_module(found)
    return found


@pytest.mark.parametrize(("page", "link"), LINKS, ids=lambda x: getattr(x, "stem", x))
def test_link(page, link):
    assert (page.parent / link).exists()


def test_site(tmp_path):
    """The guides become a site without a warning."""
    pytest.importorskip("myst_parser", reason="the extra docs is not installed")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-d", str(tmp_path / "trees")]
    built = subprocess.run(
        [*command, str(ROOT / "docs"), str(tmp_path / "site")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (built.returncode, built.stderr) == (0, "")
    assert (tmp_path / "site" / "new_component.html").is_file()


def test_every_page_is_in_the_index():
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    (tree,) = re.findall(r"^```{toctree}\n:hidden:\n\n(.*?)^```$", index, re.MULTILINE | re.DOTALL)
    assert {*tree.split(), "index"} == {page.stem for page in (ROOT / "docs").glob("*.md")}
    assert all(f"]({name}.md)" in index for name in tree.split())


def test_files_and_modules_in_text_exist():
    """What is written as code and looks like a file of this repository, the examples aside."""
    examples = {"flywheel", "reverse_seidel", "npz"}
    for page in PAGES:
        text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.M | re.S)
        for name in re.findall(
            r"`((?:src|tests|fmus|system_models|examples|docs)/[^\s`*]*)`", text
        ):
            assert Path(name).stem in examples or (ROOT / name).exists(), (page.name, name)


def test_component(tmp_path, monkeypatch):
    """w = tau / f (1 - exp(-f t / J)) under constant torque; the guide's system holds 10 N m."""
    flywheel = module(tmp_path, "new_component", "flywheel").FLYWHEEL
    monkeypatch.setitem(registry.COMPONENTS, "flywheel", flywheel)
    wheel = Instance(flywheel, "wheel")
    wheel.set("viscous_friction", 4.0)
    wheel.initialise()
    wheel.set("flange.tau", 30.0)
    assert wheel.step(0.0, 0.1) == 0
    assert wheel["flange.w"] == pytest.approx(7.5 * -np.expm1(-0.2), rel=1e-12)
    system, scene = blocks("new_component", "toml")
    (tmp_path / "scenes").mkdir()
    (tmp_path / "system.toml").write_text(system)
    (tmp_path / "scenes" / "loaded.toml").write_text(scene)
    result = hb.run(tmp_path, t_end=0.002, fmu="in-process")
    assert result.data["coupling.torque"].to_numpy() == pytest.approx(10.0, rel=1e-6)


def test_algorithm(tmp_path, monkeypatch):
    kind = module(tmp_path, "new_algorithm", "reverse_seidel").ReverseSeidel
    monkeypatch.setitem(ALGORITHMS, kind.name, kind)
    for algorithm in kind.variants():
        for check in (conformance.check_order, conformance.check_end, conformance.check_cost,
                      conformance.check_needs, conformance.check_slow_bodies):  # fmt: skip
            check(algorithm)
    assert kind(order=1) in conformance.variants()


def test_importer(tmp_path, monkeypatch):
    """Springs of 2e8 N/m in series and masses of 10 kg; the guide says what follows."""
    monkeypatch.chdir(tmp_path)
    npz = module(tmp_path, "new_importer", "npz")
    monkeypatch.setitem(importers._MATRICES, ".npz", npz.read_npz)
    (tmp_path / "box.py").write_text(blocks("new_importer", "python")[1])
    runpy.run_path("box.py")
    (tmp_path / "seats.toml").write_text(blocks("new_importer", "toml")[0])
    options = {"band_hz": 3000.0, "tolerance": 0.05, "most_modes": 64}
    housing = importers.import_housing(["box.npz"], "seats.toml", **options)
    assert np.diag(housing.static_compliance()) == pytest.approx(1e-8, rel=1e-9)
    lowest = np.sqrt((3.0 - np.sqrt(5.0)) * 2e8 / 2.0 / 10.0) / (2.0 * np.pi)
    assert housing.frequency_hz[0] == pytest.approx(lowest, rel=1e-9)
    assert f"{lowest:.1f} Hz" in (ROOT / "docs" / "new_importer.md").read_text(encoding="utf-8")


def test_scene(tmp_path):
    """Its values are those of parts that exist, and it runs."""
    (text,) = blocks("new_scene", "toml")
    (tmp_path / "deviation.toml").write_text(text)
    result = hb.run("test_rig", scene=tmp_path / "deviation.toml", t_end=4e-4, fmu="in-process")
    assert result.outcome.completed
    assert result.data["time"].iloc[-1] == pytest.approx(4e-4)


def test_commands_are_those_of_the_command_line():
    """Each `herringbone` line of a page parses, up to what it would do."""
    from herringbone.commands.main import _parser

    lines = [
        line.split("herringbone ", 1)[1]
        for page in PAGES
        for fence in re.findall(r"^```sh\n(.*?)^```$", page.read_text(), re.MULTILINE | re.DOTALL)
        for line in fence.replace("\\\n", " ").splitlines()
        if "bin/herringbone " in line
    ]
    assert len(lines) > 8
    for line in lines:
        _parser().parse_args(line.split())


def test_citation_agrees_with_the_project():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    assert f"version: {project['version']}" in lines
    assert f"license: {project['license']}" in lines
    assert f"## {project['version']}" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_foreign_fmus(tmp_path, monkeypatch, capsys):
    """The page's two FMUs on the gearbox; at 20 us the coupling errs less than a thousandth."""
    from herringbone.commands.main import main

    monkeypatch.chdir(tmp_path)
    for name, code in zip(("motor", "vehicle"), blocks("foreign_fmus", "python"), strict=True):
        (tmp_path / f"{name}.py").write_text(code, encoding="utf-8")
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", f"{name}.py"]
        subprocess.run([*command, "--no-external-tool"], check=True, capture_output=True)
    (tmp_path / "car").mkdir()
    (system,) = blocks("foreign_fmus", "toml")
    (tmp_path / "car" / "system.toml").write_text(system, encoding="utf-8")
    assert main(["check", "Motor.fmu"]) in {0, 1}  # units are not declared
    said = capsys.readouterr().out
    assert "a body with direct feedthrough" in said
    assert "d(flange.tau)/d(flange.phi) = -8000" in said
    contracts = [line.split()[1:] for line in blocks("foreign_fmus", "sh")[-1].splitlines()]
    assert [command[3] for command in contracts] == ["motor", "load"]
    for command in contracts:
        assert main(command) == 0
        assert "rotation, H-term    holds" in capsys.readouterr().out
    run = hb.run(
        "car", start="rest", t_end=0.02, step=2e-5, values={"motor.torque": 200.0}, verify=True
    )
    assert run.outcome.completed
    assert max(run.verification.groups.values()) < 1e-3


def test_plans(tmp_path):
    """The scene of a plan is read; its Python example is a plan that keeps its tolerance."""
    file = tmp_path / "quiet.toml"
    file.write_text(blocks("plans", "toml")[0], encoding="utf-8")
    (ask,) = read_scene(file).asks
    assert (ask.what, ask.tolerance, ask.band) == (("seat velocity",), 0.01, 2000.0)
    names: dict = {}
    exec(compile(blocks("plans", "python")[0], "plans.md", "exec"), names)
    measured = names["found"].choice.measured
    assert measured is None or measured.error <= 0.005
    assert names["state"].converged


def test_sweeps(tmp_path, monkeypatch, capsys):
    """The examples: over speeds, over files of the same pair, and on a cluster of threads."""
    first, files, second = (blocks("sweeps", "python")[k] for k in (0, 1, 2))
    names: dict = {}
    exec(compile(first, "sweeps.md", "exec"), names)
    assert names["found"].table["outcome"].tolist() == ["steady"] * 3
    monkeypatch.chdir(tmp_path)
    for name in ("m24.toml", "m28.toml"):
        shutil.copy(ROOT / "fmus" / "gear_mesh" / "gear_pair.toml", name)
    exec(compile(files, "sweeps.md", "exec"), names)
    one, other = (line.split() for line in capsys.readouterr().out.splitlines())
    assert (one[0], other[0], one[1]) == ("m24.toml", "m28.toml", other[1])
    distributed = pytest.importorskip("distributed", reason="the extra cluster is not installed")
    exec(compile(second, "sweeps.md", "exec"), names)
    with distributed.LocalCluster(
        n_workers=1, processes=False, dashboard_address=None, threads_per_worker=1
    ) as cluster:
        assert len(names["main"](cluster.scheduler_address).table) == 4
