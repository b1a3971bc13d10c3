"""The exported test rig runs in other masters, and gives the same results there.

libcosim (through libcosimpy) and ecos (through ecospy) step all FMUs in parallel on held inputs:
`Jacobi(order=0, schedule="parallel")` of this package. The step lies below the stability limit of
that scheme at the stiffest bearing, as `herringbone stability` says.
"""

import importlib.util
import json
import shutil
import subprocess
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.ssd import read_ssd

from herringbone.benchmarks.other_masters import environment
from herringbone.core import ParameterError
from herringbone.core.places.part_path import flat_name
from herringbone.core.places.paths import component_folder
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.ssp.read import read_ssp
from herringbone.cosim.ssp.write import PARAMETER_SET
from herringbone.running.api import run
from herringbone.running.exporting.export import export_ssp
from herringbone.running.loading import load_scene, load_system

STEP, COUNT, EVERY = 1e-6, 400, 50
PARALLEL = Jacobi(order=0, schedule="parallel")
TOLERANCE = 1e-9
"""Of the largest value of a channel. libcosim's step sizes are differences of times, so that
they differ in the last digits; that leaves about 2e-10."""


@pytest.fixture(scope="module")
def scene():
    _, folder = load_system("test_rig")
    loaded = load_scene(folder, "loaded")
    return replace(loaded, t_end=COUNT * STEP, record_step=EVERY * STEP)


@pytest.fixture(scope="module", params=["python", "native"])
def native(request):
    """Whether the exported FMUs are native ones."""
    if request.param == "native":
        request.getfixturevalue("native_fmus")
    return request.param == "native"


@pytest.fixture(scope="module")
def exported(native, scene, tmp_path_factory):
    file = tmp_path_factory.mktemp("ssp") / "test_rig.ssp"
    return export_ssp("test_rig", file, scene=scene, step=STEP, native=native)


@pytest.fixture(scope="module")
def ours(scene):
    return run("test_rig", scene=scene, step=STEP, algorithm=PARALLEL)


@pytest.fixture(scope="module")
def unpacked(exported):
    folder = exported.parent / "unpacked"
    with zipfile.ZipFile(exported) as archive:
        archive.extractall(folder)
    return folder


def name_in_file(column):
    """`gearbox.gear_mesh.pinion.w` is `gearbox__gear_mesh.pinion.w` there."""
    part, variable = load_system("test_rig")[0].split(column)
    return f"{flat_name(part)}.{variable}"


def run_in(master, package, file, names, folder):
    if importlib.util.find_spec(package) is None:
        pytest.skip(f"{package} is not installed")
    request, answer = folder / "request.json", folder / "answer.json"
    wanted = {"step": STEP, "count": COUNT, "every": EVERY, "names": list(map(name_in_file, names))}
    request.write_text(json.dumps({**wanted, "parameter_set": PARAMETER_SET}), encoding="utf-8")
    script = Path(__file__).with_name("run_master.py")
    done = subprocess.run(
        [sys.executable, script, master, file, request, answer],
        env=environment(),
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return np.array(json.loads(answer.read_text(encoding="utf-8")))


def largest_differences(result, rows, names):
    """Largest difference of each column, over its largest value."""
    values = result.data[names].to_numpy()[1:]
    assert rows.shape == values.shape == (COUNT // EVERY, len(names))
    size = np.abs(values).max(axis=0)
    return np.abs(rows - values).max(axis=0) / np.where(size > 0.0, size, 1.0)


def result_names(result):
    names = [name for name in result.data.columns if name != "time"]
    for pattern in ("bearing_supports.shaft.*.f_?", "modal_housing.*.v_?", "*_coupling.torque"):
        assert result.columns(pattern)
    return names


def assert_same_results(result, rows, names):
    worst = dict(zip(names, largest_differences(result, rows, names), strict=True))
    assert {name: d for name, d in worst.items() if d > TOLERANCE} == {}


def test_ecos_gives_our_results(exported, ours, tmp_path):
    names = result_names(ours)
    rows = run_in("ecos", "ecospy", exported, names, tmp_path)
    assert largest_differences(ours, rows, names).max() == 0.0


def test_libcosim_gives_our_results(unpacked, ours, tmp_path):
    names = result_names(ours)
    rows = run_in("libcosim", "libcosimpy", unpacked, names, tmp_path)
    assert_same_results(ours, rows, names)


def test_the_run_is_not_at_rest(ours):
    """Otherwise agreement would say little: the forces change by more than the tolerance."""
    forces = ours.data[ours.channel("bearing_force")].to_numpy()
    assert np.abs(forces - forces[0]).max() > 1e3 * TOLERANCE * np.abs(forces).max()


def test_libcosim_sets_start_values_of_states_where_the_fmus_have_them(
    exported, native, ours, tmp_path
):
    """Its reader of SSP passes over them; hence OspSystemStructure.xml, and FMUs that have them."""
    names = ["bench_controller.speed_setpoint", "drive_motor.flange.w"]
    rows = run_in("libcosim", "libcosimpy", exported, names, tmp_path)
    setpoint, speed = largest_differences(ours, rows, names)
    assert setpoint == 0.0
    assert speed < TOLERANCE if native else speed > 0.1


@pytest.mark.parametrize("fmu", ["python", "in-process"])
def test_exported_file_runs_here_bit_for_bit_the_same(exported, ours, fmu):
    again = run(exported, step=STEP, record_step=EVERY * STEP, algorithm=PARALLEL, fmu=fmu)
    assert again.outcome.completed
    assert again.channels == ours.channels
    assert again.data.equals(ours.data)


def test_own_fmus_are_recognised_as_components(exported):
    system, _ = load_system("test_rig")
    found, _ = load_system(exported)
    assert {p.name: p.component for p in found.parts} == {p.name: p.component for p in system.parts}
    assert found.foreign_parts == ()
    assert len(read_ssp(exported).foreign_parts) == len(system.parts)


def test_own_scheme_reports_errors_against_the_twin(exported):
    result = run(exported, step=1e-5, reference=True)
    assert result.error is not None
    assert set(result.error) == {"bearing_force", "seat_velocity"}


def test_export_of_an_exported_file_is_the_same_file(exported, native, tmp_path):
    again = export_ssp(exported, tmp_path / "again.ssp", step=STEP, native=native)
    with zipfile.ZipFile(exported) as first, zipfile.ZipFile(again) as second:
        assert first.namelist() == second.namelist()
        assert {n: first.read(n) for n in first.namelist()} == {
            n: second.read(n) for n in second.namelist()
        }


def test_fmpy_reads_the_structure(exported):
    found = read_ssd(str(exported))
    assert [c.name for c in found.system.elements] == [
        flat_name(p.name) for p in read_ssp(exported).parts
    ]


def test_resource_outside_the_fmus_is_refused(tmp_path):
    cycle = tmp_path / "mine.csv"
    shutil.copyfile(component_folder("bench_controller") / "resources" / "loaded.csv", cycle)
    with pytest.raises(ParameterError, match="must not depend on files outside it"):
        export_ssp(
            "test_rig",
            tmp_path / "x.ssp",
            values={"bench_controller.cycle": str(cycle)},
            native=False,
        )
