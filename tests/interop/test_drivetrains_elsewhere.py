"""The shipped drivetrains in other masters, as exported: nothing is set there.

ecos, libcosim and fmpy.ssp step all FMUs in parallel on held inputs. fmpy.ssp hands nothing on
before the first step, in which all connected inputs are zero; the same loop is written here.
"""

import importlib.util
import json
import subprocess
import sys
import zipfile
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp

import herringbone as hb
from herringbone.benchmarks.other_masters import environment
from herringbone.components.registry import COMPONENTS
from herringbone.core.places.part_path import flat_name
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.structure.system import System
from herringbone.running.exporting.export import export_ssp
from herringbone.running.loading import load_scene, load_system, open_parts
from herringbone.running.own_master import connections
from herringbone.running.prepared import Wishes, prepared

SYSTEMS = ("back_to_back", "boosted_axle", "e_axle", "gearbox", "on_ground", "ship", "turbine")
OFFERED = ("gearbox", True)
"""Its torques are connectors of the whole there, which fmpy holds at zero."""
STEP, COUNT, EVERY = 1e-6, 200, 50
FEW = 20
"""Steps of fmpy's loop, which is slow."""
TOLERANCE = 1e-9
"""Of the largest value of all channels of a unit: some are differences of others."""
MASTERS = {"ecos": "ecospy", "libcosim": "libcosimpy"}


@pytest.fixture(scope="module")
def exported(native_fmus, tmp_path_factory):
    """Function: a system's .ssp file, once; nested systems stay so if asked."""
    folder = tmp_path_factory.mktemp("ssp")

    @cache
    def export(name: str, nested: bool = False) -> Path:
        scene = replace(scene_of(name), t_end=COUNT * STEP)
        file = folder / f"{name}{'-nested' * nested}.ssp"
        return export_ssp(name, file, scene=scene, step=STEP, nested=nested)

    return export


def scene_of(name: str):
    return load_scene(load_system(name)[1], "loaded")


@cache
def ours(name: str):
    scene = replace(scene_of(name), t_end=COUNT * STEP, record_step=EVERY * STEP)
    return hb.run(name, scene=scene, step=STEP, algorithm="jacobi:order=0,schedule=parallel")


def unit_of(system: System, column: str) -> str:
    part, variable = system.split(column)
    return COMPONENTS[str(system.part(part).component)].declaration.variable(variable).unit


def rows_of(master: str, file: Path, names: list[str], folder: Path) -> np.ndarray:
    """Records of another master, in a process of its own."""
    request, answer = folder / "request.json", folder / "answer.json"
    asked = {"step": STEP, "count": COUNT, "every": EVERY, "names": names, "parameter_set": None}
    request.write_text(json.dumps(asked), encoding="utf-8")
    script = Path(__file__).with_name("run_master.py")
    subprocess.run(
        [sys.executable, script, master, file, request, answer],
        env=environment(),
        capture_output=True,
        check=True,
        timeout=300,
    )
    return np.array(json.loads(answer.read_text(encoding="utf-8")))


@pytest.mark.parametrize("master", MASTERS)
@pytest.mark.parametrize("name", SYSTEMS)
def test_other_masters_start_and_step_as_we_do(name, master, exported, tmp_path):
    if importlib.util.find_spec(MASTERS[master]) is None:
        pytest.skip(f"{MASTERS[master]} is not installed")
    result = ours(name)
    columns = [column for column in result.data.columns if column != "time"]
    system = load_system(name)[0]
    split = (system.split(column) for column in columns)
    names = [f"{flat_name(part)}.{variable}" for part, variable in split]
    rows = rows_of(master, exported(name), names, tmp_path)
    values = result.data[columns].to_numpy()[1:]
    largest = dict(zip(columns, np.abs(values).max(axis=0), strict=True))
    units = {column: unit_of(system, column) for column in columns}
    size = [max(largest[c] for c in columns if units[c] == unit) for unit in units.values()]
    worst = np.abs(rows - values).max(axis=0) / np.where(np.array(size) > 0.0, size, 1.0)
    assert {c: d for c, d in zip(columns, worst, strict=True) if d > TOLERANCE} == {}
    speeds = [i for i, c in enumerate(columns) if c.endswith("gear_mesh.pinion.w")]
    assert (np.abs(rows[:, speeds]) > 100.0).all()  # they turn from the start


def loop_of_fmpy(system: System, columns: list[str]) -> np.ndarray:
    """Last values after `FEW` steps of fmpy's loop, by parts in this process."""
    parts = {part.name: part for part in open_parts(system, "in-process")}
    links = connections(system)
    for part in parts.values():
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()
    handed = [0.0] * len(links)
    for n in range(FEW):
        for link, value in zip(links, handed, strict=True):
            parts[link.target].set(link.input, value)
        for part in parts.values():
            assert part.instance.step(n * STEP, STEP) == 0
        handed = [parts[link.source].get([link.output])[0] for link in links]
    places = (system.split(column) for column in columns)
    return np.array([parts[part].get([variable])[0] for part, variable in places])


@pytest.mark.parametrize(
    ("name", "nested"),
    [(name, nested) for name in SYSTEMS for nested in (False, True) if (name, nested) != OFFERED],
)
def test_fmpy_runs_the_file(name, nested, exported):
    """It sets no parameters of a file: what the FMUs start with is all that it has."""
    result = ours(name)
    pattern = ("gear_mesh.pinion.w", "shaft.pinion_left.f_y", "pinion_left.v_y")
    columns = [column for column in result.data.columns if column.endswith(pattern)]
    system = prepared(name, "loaded", Wishes()).system
    found = simulate_ssp(str(exported(name, nested)), 0.0, (FEW - 0.5) * STEP, STEP)
    assert len(found) == FEW
    paths = columns if nested else [f"{flat_name(p)}.{v}" for p, v in map(system.split, columns)]
    rows = np.array([found[-1][path] for path in paths])
    wanted = loop_of_fmpy(system, columns)
    np.testing.assert_allclose(rows, wanted, rtol=TOLERANCE, atol=TOLERANCE * 1e-3)
    assert (np.abs(rows[[c.endswith("pinion.w") for c in columns]]) > 100.0).all()


def test_ports_are_connectors_of_the_nested_file(exported):
    """A gearbox alone offers its flanges; each instance carries its start values."""
    import fmpy
    from fmpy.ssp.ssd import read_ssd

    file = exported("gearbox", nested=True)
    root = read_ssd(str(file)).system
    assert {c.name for c in root.connectors} == {
        f"{gear}.{q}" for gear in ("pinion", "wheel") for q in ("tau", "phi", "w", "a")
    }
    with zipfile.ZipFile(file) as archive:
        archive.extractall(file.parent / "gearbox")
    model = fmpy.read_model_description(file.parent / "gearbox" / "resources" / "gear_mesh.fmu")
    start = {v.name: v.start for v in model.modelVariables}
    given = hb.start_values("gearbox")["gear_mesh"]
    assert float(start["pinion.tau"]) == given["pinion.tau"] == 200.0
    assert float(start["der(angle)"]) == given["der(angle)"]


def test_both_gearboxes_keep_their_own_values(exported):
    """Two FMUs of one component, with different flanks."""
    first, second = (
        part.fmu for part in read_ssp(exported("back_to_back")).parts if "gear_mesh" in part.name
    )
    assert first.read_bytes() != second.read_bytes()
