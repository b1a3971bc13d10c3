"""Reports know parts by what they are for: nothing changes with names, or with another bearing."""

import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from support.hardening_bearings import HARDENING_BEARINGS

import herringbone as hb
from herringbone.analysis.figures.radiated_power import radiated_power
from herringbone.analysis.stability.atlas import scaled_bearings, two_rotors, unscaled
from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.stability.limits import stability
from herringbone.analysis.stability.report import stability_text
from herringbone.components.registry import COMPONENTS, component
from herringbone.core import Component
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.places.paths import PACKAGE, systems_folder
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.structure.system_file import read_system
from herringbone.plotting import PICTURES, overview
from herringbone.running.api import run
from herringbone.running.loading import load_scene, load_system
from herringbone.running.reporting.summary import summary_text
from herringbone.running.start import started

RUN = {"algorithm": LI(degree=3), "step": 4e-5, "t_end": 0.02, "fmu": "in-process"}
COST = re.compile(r"wall time|per macro step")
RIG, GEARBOX = "test_rig", "gearbox"


def new_component_name(name: str) -> str:
    return name.upper()


def new_part_name(name: str) -> str:
    """As long as before, so that texts wrap in the same way."""
    return name[::-1]


def renamed_component(found: Component) -> Component:
    """The same component under another name; data and scripts stay where they are."""
    declaration = object.__new__(type(found.declaration))
    declaration.__dict__ |= {**vars(found.declaration), "name": new_component_name(found.name)}
    return replace(found, declaration=declaration)


@pytest.fixture
def renamed_registry():
    """No component has the name that it is shipped with."""
    shipped = dict(COMPONENTS)
    COMPONENTS.clear()
    COMPONENTS.update((new.name, new) for new in map(renamed_component, shipped.values()))
    yield
    COMPONENTS.clear()
    COMPONENTS.update(shipped)


def part_names() -> list[str]:
    return [*(part.name for part in read_system(RIG).parts), GEARBOX]


def with_new_names(text: str) -> str:
    """TOML of a system or scene: components, nested systems and parts renamed."""
    kept = {}

    def keep(match: re.Match) -> str:
        kind, name = match.groups()
        new = new_component_name(name) if kind == "component" else new_part_name(name)
        kept[f"<{len(kept)}>"] = f'{kind} = "{new}"'
        return f"<{len(kept) - 1}>"

    text = re.sub(r'^(component|system) = "(\w+)"', keep, text, flags=re.MULTILINE)
    names = "|".join(sorted([*part_names(), RIG], key=len, reverse=True))
    whole = rf"(?:(?<![\w.])|(?<=parts\.))({names})(?!\w)"
    text = re.sub(whole, lambda m: new_part_name(m[0]), text)
    for mark, line in kept.items():
        text = text.replace(mark, line)
    return text


def with_old_names(text: str) -> str:
    names = {new_part_name(name): name for name in [*part_names(), RIG]}
    return re.sub("|".join(sorted(names, key=len, reverse=True)), lambda m: names[m[0]], text)


@pytest.fixture
def renamed_rig(tmp_path, renamed_registry) -> Path:
    """Folder of the rig in which parts, components and systems have other names."""
    rig = tmp_path / new_part_name(RIG)
    shutil.copytree(systems_folder() / RIG, rig)
    shutil.copytree(systems_folder() / GEARBOX, rig / new_part_name(GEARBOX))
    for file in tmp_path.rglob("*.toml"):
        file.write_text(with_new_names(file.read_text()))
    return rig


def shown(result) -> dict:
    """Every picture of a run: titles, axes and the data of each line."""
    found = {}
    for name, draw in {"overview": overview, **PICTURES}.items():
        figure = draw(result)
        found[name] = [
            (
                axes.get_title(),
                axes.get_xlabel(),
                axes.get_ylabel(),
                [(with_old_label(line.get_label()), *line.get_data()) for line in axes.lines],
            )
            for axes in figure.axes
        ]
    return found


def with_old_label(label: str) -> str:
    """Legends show part names with spaces."""
    return with_old_names(label.replace(" ", "_")).replace("_", " ")


def text_of(result) -> list[str]:
    """The summary in the shipped names, without the times that it took."""
    return [
        row for row in with_old_names(summary_text(result)).splitlines() if not COST.search(row)
    ]


def stable(reference) -> str:
    system, folder = load_system(reference)
    found = stability(
        started(system, load_scene(folder, "loaded"))[0], "loaded", [Jacobi(1), LI(degree=3)]
    )
    assert found.recommended
    return with_old_names(stability_text(found))


def charted(reference) -> list[tuple]:
    found = hb.chart(
        reference, algorithms=["li:degree=3"], steps=[4e-5], t_end=2e-3, fmu="in-process"
    )
    assert found.mode_count > 0
    return [
        found.mode_count,
        found.micro_step,
        [(p.algorithm, p.step, dict(p.error)) for p in found.points],
    ]


@pytest.fixture(scope="module")
def shipped():
    """Run, summary, pictures, stability and chart of the shipped rig."""
    result = run(RIG, **RUN)
    return result, text_of(result), shown(result), stable(RIG), charted(RIG)


def test_all_names_changed(shipped, renamed_rig):
    """Same bits, sections, pictures, radiated power, stability, recommendation and chart."""
    result, text, pictures, limits, chart = shipped
    renamed = run(renamed_rig, **RUN)
    columns = [with_old_names(name) for name in renamed.data.columns]
    assert set(columns).isdisjoint(renamed.data.columns[1:])
    assert columns == list(result.data.columns)
    assert (renamed.data.to_numpy() == result.data.to_numpy()).all()
    assert text_of(renamed) == text
    assert any(row.startswith("Radiated power") for row in text)
    assert radiated_power(renamed).total == radiated_power(result).total
    found = shown(renamed)
    assert found.keys() == pictures.keys()
    for name, panels in pictures.items():
        for (*titles, lines), (*own_titles, own_lines) in zip(panels, found[name], strict=True):
            assert own_titles == titles
            for (label, x, y), (own_label, own_x, own_y) in zip(lines, own_lines, strict=True):
                assert own_label == label
                np.testing.assert_array_equal(own_x, x)
                np.testing.assert_array_equal(own_y, y)
    assert stable(renamed_rig) == limits
    assert charted(renamed_rig) == chart


def test_rotors_of_renamed_components(renamed_registry):
    """The atlas builds them of whatever is a load and a shaft coupling."""
    system = two_rotors(0.02, 3.0)
    roles = [component(part.component).declaration.roles for part in system.parts]
    assert roles == [(Role.LOAD,), (Role.LOAD,), (Role.COUPLING,)]


def with_second_bearing(name: str):
    """A shipped system with the other bearing in the place of the shipped one."""
    system = read_system(name)
    new, ports = HARDENING_BEARINGS.name, (("shaft.", "journal."), ("seat.", "mount."))

    def moved(path: str) -> str:
        for old, own in ports:
            path = path.replace(f".{old}", f".{own}")
        return path

    return replace(
        system,
        parts=tuple(
            replace(part, component=new, values={})
            if Role.BEARING in component(part.component).declaration.roles
            else part
            for part in system.parts
        ),
        connections=tuple((moved(one), moved(other)) for one, other in system.connections),
        channels={key: tuple(map(moved, found)) for key, found in system.channels.items()},
    )


@pytest.fixture
def second_bearing(monkeypatch):
    monkeypatch.setitem(COMPONENTS, HARDENING_BEARINGS.name, HARDENING_BEARINGS)


def labels(text: list[str]) -> list[str]:
    """What the rows of a summary are about: their first 20 characters, numbers left out."""
    found = [re.sub(r"[-\d.e+]+", "", row[:20]).strip() for row in text]
    return list(dict.fromkeys(found))


def test_second_bearing(shipped, second_bearing):
    """Its report has the sections of the shipped one, its pictures the same panels and lines."""
    system = with_second_bearing(RIG)
    scene = load_scene(systems_folder() / RIG, "loaded")
    result = run(system, scene=scene, **RUN)
    _, text, pictures, *_ = shipped
    assert labels(text_of(result)) == labels(text)
    assert "Not known" not in summary_text(result)
    # The bearings are nearly linear at this load: the levels lie close together.
    assert radiated_power(result).level_db == pytest.approx(
        radiated_power(shipped[0]).level_db, abs=1.0
    )
    found = shown(result)
    assert found.keys() == pictures.keys()
    for name, panels in pictures.items():
        kinds = [[label for label, *_ in lines] for *_, lines in found[name]]
        assert [len(k) for k in kinds] == [len(lines) for *_, lines in panels]


def test_what_the_second_bearing_cannot_answer(second_bearing):
    """It has no parameter for damping: one line where damping is asked for."""
    system = with_second_bearing(RIG)
    scene = load_scene(systems_folder() / RIG, "loaded")
    system = started(system, scene)[0]
    (name,) = [p.name for p in system.parts if p.component == HARDENING_BEARINGS.name]
    assert unscaled(system) == (
        f"{name}: {HARDENING_BEARINGS.name} has no parameter for damping; it is not scaled",
    )
    stiff = scaled_bearings(system, 4.0).part(name).values
    (support, thrust) = HARDENING_BEARINGS.declaration.offered(Quantity.STIFFNESS)
    assert stiff[support.name] == 4.0 * support.start
    assert stiff[thrust.name] == 4.0 * thrust.start
    why = diagnose(system, Jacobi(0), 5e-5)
    (line,) = [remedy for remedy in why.remedies if "no parameter" in remedy]
    assert line.startswith(f"more damping at {name}.")


GENERATE = "herringbone.fmi.generate"


def in_copy(root: Path, *command: str) -> subprocess.CompletedProcess:
    environment = {**os.environ, "PYTHONPATH": str(root / "src")}
    environment.pop("HERRINGBONE_CACHE", None)
    return subprocess.run(
        [sys.executable, *command], capture_output=True, text=True, check=False, env=environment
    )


@pytest.mark.slow
def test_a_component_is_one_module_and_one_line(tmp_path):
    """In a copy of the package: module and registry, then one command; its FMU agrees with it."""
    clone = PACKAGE.parents[1]
    shutil.copytree(PACKAGE, tmp_path / "src" / "herringbone", ignore=_caches)
    for folder in ("fmus", "system_models"):
        shutil.copytree(clone / folder, tmp_path / folder, ignore=_caches)
    shutil.copyfile(clone / "pyproject.toml", tmp_path / "pyproject.toml")
    name = HARDENING_BEARINGS.name
    components = tmp_path / "src" / "herringbone" / "components"
    shutil.copyfile(sys.modules["support.hardening_bearings"].__file__, components / f"{name}.py")
    registry = components / "registry.py"
    first = "_MODULES = (\n"
    registry.write_text(registry.read_text().replace(first, f'{first}    "{name}",\n'))
    made = in_copy(tmp_path, "-m", GENERATE, name)
    assert made.returncode == 0, made.stderr
    files = {file.name for file in (tmp_path / "fmus" / name).iterdir()}
    assert files == {f"{name}.py", "README.md", "golden.csv"}
    golden = np.loadtxt(tmp_path / "fmus" / name / "golden.csv", delimiter=",", skiprows=1)
    assert golden.shape == (21, 1 + 5 * 4)
    assert np.isfinite(golden).all()
    assert np.abs(golden[:, 1:]).max() > 1.0
    table = (tmp_path / "fmus" / name / "README.md").read_text()
    assert "| `hardening_deflection` | m | 5e-05 |" in table
    unknown = in_copy(tmp_path, "-m", GENERATE, "nothing")
    assert unknown.returncode == 1
    assert "there is no component 'nothing'" in unknown.stderr.splitlines()[-1]


def _caches(folder: str, names: list[str]) -> list[str]:
    del folder
    return [name for name in names if name == "__pycache__"]
