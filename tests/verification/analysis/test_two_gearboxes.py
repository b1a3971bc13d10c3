"""Two gearboxes in series: parts of the same name in two scopes, through everything a run has."""

import json
import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.compiler import needs_compiler

import herringbone as hb
from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.analysis.measured.of_run import predicted_of
from herringbone.analysis.twin.composite import make_composite
from herringbone.analysis.twin.monolithic import Twin
from herringbone.commands.main import main
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.roles import Role
from herringbone.core.sensor_spec import SensorSpec
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import read_system
from herringbone.fmi.check import check_fmu
from herringbone.plotting import PICTURES
from herringbone.running.loading import load_system
from herringbone.running.reporting.report import write_report
from herringbone.running.start import started
from herringbone.scenes import Scene, Start

SYSTEM = """
name = "two_stages"
connections = [
  ["bench_controller.speed_setpoint", "drive_motor.speed_setpoint"],
  ["bench_controller.torque_setpoint", "load_motor.torque_setpoint"],
  ["drive_motor.flange", "drive_coupling.flange_a"], ["first.pinion", "drive_coupling.flange_b"],
  ["first.wheel", "middle_coupling.flange_a"], ["second.pinion", "middle_coupling.flange_b"],
  ["second.wheel", "load_coupling.flange_a"], ["load_motor.flange", "load_coupling.flange_b"],
]
[parts]
bench_controller = { component = "bench_controller", set = { gear_ratio = 9.0 } }
drive_motor = { component = "drive_motor" }
drive_coupling = { component = "shaft_coupling", set = { stiffness = 6e4, damping = 5.0 } }
first = { system = "gearbox" }
middle_coupling = { component = "shaft_coupling", set = { stiffness = 3e5, damping = 50.0 } }
second = { system = "gearbox" }
load_coupling = { component = "shaft_coupling", set = { stiffness = 1e6, damping = 200.0 } }
load_motor = { component = "load_motor" }
"""
BOXES = ("first", "second")
SPEED, TORQUE, RATIO, BASE_RADIUS = 1000.0 * np.pi / 30.0, 200.0, 3.0, 50.298e-3
RUN = {"algorithm": "li:degree=3", "step": 4e-5, "record_step": 4e-5, "fmu": "in-process"}
ARGUMENTS = ("--algorithm=li:degree=3", "--step=4e-5", "--t-end=4e-4", "--fmu=in-process", "--json")
PROMISE = 1e-3
CHAIN = {"sampling_hz": 5e3, "range": 1.0, "bits": 32.0, "high_pass_hz": 0.0, "low_pass_hz": 0.0}
AMBIGUOUS = (
    "herringbone: system 'two_stages': 'gear_mesh' may mean first.gear_mesh or second.gear_mesh; "
    "write more of the path\n"
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    found = tmp_path_factory.mktemp("two_stages")
    (found / "system.toml").write_text(SYSTEM, encoding="utf-8")
    return found


@pytest.fixture(scope="module")
def ran(folder):
    """Function: the run of some duration, once."""
    return cache(lambda t_end: hb.run(folder, t_end=t_end, reference=True, **RUN))


def test_parts_have_paths(folder):
    box = read_system("gearbox")
    system = read_system(folder)
    for name in BOXES:
        assert [p for p in system.paths if p.scope == name] == [f"{name}.{p}" for p in box.paths]
    assert len(system.parts) == 2 * len(box.parts) + 6


def test_start_is_in_equilibrium(ran):
    """Speeds by the ratio of the teeth; bearings carry T / r_b, three times as much behind."""
    result = ran(0.02)
    for name, ratio in zip(BOXES, (1.0, RATIO), strict=True):
        speed, torque = SPEED / ratio, ratio * TORQUE
        start = result.data.iloc[0]
        assert start[f"{name}.gear_mesh.pinion.w"] == pytest.approx(speed, rel=1e-6)
        assert start[f"{name}.gear_mesh.wheel.w"] == pytest.approx(speed / RATIO, rel=1e-6)
        for gear, sign in (("pinion", 1.0), ("wheel", -1.0)):
            halves = (f"{name}.bearing_supports.shaft.{gear}_{s}.f_y" for s in ("left", "right"))
            wanted = sign * torque / BASE_RADIUS
            assert sum(start[half] for half in halves) == pytest.approx(wanted, rel=1e-4)


def test_nothing_rings_after_the_start(ran):
    """As in the rig: the first 5 ms swing no more than twice as far as the last."""
    data = ran(0.02).data
    for column in (c for c in data.columns if re.search(r"bearing_supports.shaft.*f_y$", c)):
        force = (data[column] - data[column].mean()).abs()
        assert 1.0 < force[data["time"] > 0.015].max() < 100.0
        assert force[data["time"] < 0.005].max() < 2.0 * force[data["time"] > 0.015].max(), column


def test_error_against_the_twin(ran):
    """Both gearboxes are in the channels."""
    result = ran(0.02)
    assert result.outcome.completed
    assert {c.split(".")[0] for c in result.channel("bearing_force")} == set(BOXES)
    assert len(result.channel("bearing_force")) == 2 * 8
    assert len(result.channel("seat_velocity")) == 2 * 12
    assert set(result.error) == {"bearing_force", "seat_velocity"}
    assert 0.0 < max(result.error.values()) <= PROMISE


def test_columns_need_as_much_of_the_path_as_tells_them_apart(ran):
    result = ran(0.02)
    with pytest.raises(ParameterError, match=r"may mean first\.gear_mesh.* or second\.gear_mesh"):
        result["gear_mesh.pinion.w"]
    assert result["second.gear_mesh.pinion.w"].equals(result.data["second.gear_mesh.pinion.w"])
    assert result.columns("gear_mesh.pinion.w") == [f"{b}.gear_mesh.pinion.w" for b in BOXES]
    # The energy of the meshes changes over their phase: below 1e-4 of the torque.
    assert result["drive_coupling.torque"].iloc[0] == pytest.approx(TORQUE, rel=1e-4)


def test_sensors_feel_their_own_housing_and_know_their_own_mesh(folder):
    """The mesh frequency of the second stage is a third; a chain of 5 kHz changes rms by little."""
    spec = {name: SensorSpec(f"{name}.modal_housing", "A", "z", CHAIN) for name in BOXES}
    run = hb.run(folder, t_end=0.1, **RUN)
    run = replace(run, info=replace(run.info, sensors=spec))
    figures, refused = sensor_figures(run)
    assert not refused
    predicted = {name: predicted_of(run, name) for name in BOXES}
    for name, ratio in zip(BOXES, (1.0, RATIO), strict=True):
        found = predicted[name]
        assert found.mesh_hz == pytest.approx(450.0 / ratio, rel=1e-3)
        assert found.vibration.std() == pytest.approx(figures[name].rms, rel=0.02)
        named = [x for x in figures[name].lines if x.mesh_order and not x.folded]
        assert named
        for line in named:
            assert line.frequency_hz == pytest.approx(line.mesh_order * 450.0 / ratio, abs=5.0)
    assert predicted["second"].vibration.std() != pytest.approx(predicted["first"].vibration.std())


# -- report -------------------------------------------------------------------------------------


def by_section(text):
    """Lines below each underlined title."""
    pieces = re.split(r"^Gearbox (\w+)\n-+\n", text, flags=re.MULTILINE)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def test_report_has_a_section_per_gearbox(ran, tmp_path):
    (tmp_path / "overview.third.png").touch()  # of an earlier run
    result = write_report(ran(0.02), tmp_path)
    text = (tmp_path / "summary.txt").read_text(encoding="utf-8")
    sections = by_section(text)
    assert list(sections) == list(BOXES)
    assert max(map(len, text.splitlines())) <= 100
    for name, ratio in zip(BOXES, (1.0, RATIO), strict=True):
        section = sections[name]
        speed, frequency = re.search(r"Pinion speed +(\S+) r/min.* f_m (\S+) Hz", section).groups()
        assert float(speed) == pytest.approx(1000.0 / ratio, abs=0.1)
        assert float(frequency) == pytest.approx(450.0 / ratio, abs=0.1)
        torques = re.search(r"Torque +pinion (\S+) N m, wheel (\S+) N m", section).groups()
        wanted = [ratio * TORQUE, RATIO * ratio * TORQUE]
        assert list(map(float, torques)) == pytest.approx(wanted, rel=2e-3)
        left, right = re.search(r"Mesh force.*left (\S+) N .*right (\S+) N ", section).groups()
        mesh = ran(0.02).data[f"{name}.gear_mesh.mesh_left.force"].mean()
        assert float(left) == pytest.approx(mesh, rel=1e-3)
        assert float(left) == pytest.approx(float(right), rel=1e-3)
        for half in ("pinion left", "pinion right", "wheel left", "wheel right"):
            row = re.search(rf"^{half} +(.*)$", section, flags=re.MULTILINE).group(1).split()
            assert len(row) == 7
            assert abs(float(row[0])) == pytest.approx(0.5 * ratio * TORQUE / BASE_RADIUS, rel=3e-3)
        assert section.count("Radiated power") == 1
    pictures = sorted(file.name for file in tmp_path.glob("*.png"))
    kinds = ["overview", *(kind for kind in PICTURES if kind != "sensors")]  # it has none
    assert pictures == sorted(f"{kind}.{box}.png" for kind in kinds for box in BOXES)
    assert {f"{tmp_path}/{name}" for name in pictures} <= set(result.files)


# -- stability ----------------------------------------------------------------------------------


def judged(folder, capsys, algorithm, step):
    arguments = ["stability", str(folder), f"--algorithm={algorithm}", f"--step={step}", "--json"]
    assert main(arguments) == 0
    return json.loads(capsys.readouterr().out)[0]


@pytest.mark.slow
def test_stability_is_predicted_for_both(folder, capsys):
    """Order 2 is stable below 43.9 us in one gearbox; beyond that each has unstable bearings."""
    assert judged(folder, capsys, "jacobi:order=2", 3.5e-5)["stable"]
    unstable = judged(folder, capsys, "jacobi:order=2", 5e-5)
    assert not unstable["stable"]
    bonds = [name for name, _ in unstable["why"]["bonds"]]
    assert bonds[0].split(".")[0] in BOXES
    assert all(".bearing_supports." in bond for bond in bonds[:2])


@pytest.mark.slow
def test_limits_and_a_recommendation(folder, tmp_path):
    arguments = ["stability", str(folder), "--algorithm=jacobi:order=2", "-o", str(tmp_path)]
    assert main(arguments) == 0
    found = json.loads((tmp_path / "stability.json").read_text(encoding="utf-8"))
    bonds = [bond["bond"] for bond in found["bonds"]]
    for box in BOXES:
        assert sum(bond.startswith(f"{box}.bearing_supports.") for bond in bonds) == 6
    assert len(bonds) == 2 * 6 + 3  # and the couplings
    assert 0.0 < found["recommended"]["step"] < found["algorithms"][0]["limit"]
    # Each gearbox alone has the limit of the rig: the couplings are soft and slow.
    assert found["algorithms"][0]["limit"] == pytest.approx(43.9e-6, rel=0.05)


# -- files --------------------------------------------------------------------------------------


def test_ssp_out_and_in_gives_the_same_bits(folder, tmp_path):
    plain = hb.run(folder, t_end=2e-3, **RUN)
    file = tmp_path / "two.ssp"
    assert main(["export", str(folder), "-o", str(file)]) == 0
    again = hb.run(file, t_end=2e-3, **RUN)
    assert again.outcome.completed
    assert again.info.model == plain.info.model
    assert again.channels == plain.channels
    assert again.data.equals(plain.data)
    forces = plain.data[plain.channel("bearing_force")].to_numpy()
    assert np.ptp(forces, axis=0).max() > 1.0


@pytest.mark.slow
@needs_compiler
def test_it_is_one_fmu(folder, ran, tmp_path):
    file = tmp_path / "two.fmu"
    assert main(["export", str(folder), "--as-fmu", "-o", str(file)]) == 0
    assert check_fmu(file) == []
    declared = make_composite(read_system(folder)).component.declaration
    mesh = COMPONENTS["gear_mesh"].declaration.outputs
    names = {v.name for v in declared.outputs}
    assert {f"{box}.gear_mesh.{v.name}" for box in BOXES for v in mesh} <= names
    # Runge-Kutta at 2.5 us without coupling error; in the rig it errs by less than 1e-6.
    one = System("one", "", (PartSpec("one", fmu=file),), ())
    found = hb.run(one, scene=Scene("rest", "", 4e-3, 4e-5, Start.REST), step=4e-5)
    twin = Twin(started(read_system(folder), Scene("default"))[0])
    forces, velocities = (ran(0.02).channel(g) for g in ("bearing_force", "seat_velocity"))
    exact = twin.solve(found.data["time"].to_numpy(), [*forces, *velocities])
    of_forces, of_velocities = np.split(exact, [len(forces)], axis=1)
    for columns, wanted in ((forces, of_forces), (velocities, of_velocities)):
        assert relative_error(found.data[[f"one.{c}" for c in columns]].to_numpy(), wanted) < 1e-5


# -- what people write --------------------------------------------------------------------------


def test_ambiguous_names_are_refused_in_one_line(folder, tmp_path, capsys):
    arguments = ["run", str(folder), *ARGUMENTS, "-o", str(tmp_path)]
    assert main([*arguments, "--set", "gear_mesh.backlash=1e-4"]) == 2
    assert capsys.readouterr().err == AMBIGUOUS
    for option in ("--slow=gear_mesh=2", "--replace=gear_mesh=x.fmu"):
        assert main([*arguments, option]) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert "'gear_mesh' may mean first.gear_mesh or second.gear_mesh" in line
    with pytest.raises(StructureError, match="'modal_housing' may mean"):
        read_system(folder).part("modal_housing")


def test_the_path_says_which(folder, tmp_path):
    file = tmp_path / "two.ssp"
    values = ["--set", "first.gear_mesh.backlash=1e-4"]
    assert main(["export", str(folder), *values, "-o", str(file)]) == 0
    set_, other = (load_system(file)[0].part(f"{box}.gear_mesh").values for box in BOXES)
    assert set_["backlash"] == 1e-4
    assert "backlash" not in other
    ran = hb.run(folder, t_end=4e-4, values={"second.gear_mesh.backlash": 1e-4}, **RUN)
    shipped = COMPONENTS["gear_mesh"].declaration.variable("backlash").start
    assert ran.info.parameters["first.gear_mesh.backlash"] == shipped != 1e-4
    assert ran.info.parameters["second.gear_mesh.backlash"] == 1e-4


def test_roles_are_found_in_both(ran):
    for role in (Role.GEAR_PAIR, Role.BEARING, Role.HOUSING):
        assert [p.split(".")[0] for p in ran(0.02).parts_with(role)] == list(BOXES)
