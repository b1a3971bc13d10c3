"""What a gearbox FMU says: the input at fault, loads beyond its data, and slow steps."""

import math
import re
from functools import cache
from zipfile import ZipFile

import pytest
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from support.compiler import needs_compiler
from support.gearing.own_pair import write_pair
from support.hosts.fmi2 import Fmi2Host
from support.hosts.fmi3 import Fmi3Host

from herringbone.commands import main as cli
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.running.exporting.system_fmu import export_fmu

SPEED = 1000.0 * math.pi / 30.0
STEP = 1e-3
LIMIT = 5000.0
"""Torque at the pinion [N m] where the shipped table ends."""
KINDS = {
    "torque": (Wanted(), 2),
    "motion": (Wanted({"pinion": Given.MOTION}), 2),
    "speed": (Wanted({"pinion": Given.SPEED}, exchange=True), 3),
    "torque in FMI 3": (Wanted(), 3),
}

pytestmark = [pytest.mark.slow, needs_compiler]


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Function: the gearbox for a host, by kind."""
    folder = tmp_path_factory.mktemp("told")

    @cache
    def export(kind):
        wanted, fmi = KINDS[kind]
        return export_fmu("gearbox", folder / f"{kind}.fmu", fmi=fmi, wanted=wanted)

    return export


def opened(file, folder, values):
    """A host of the FMU's version, and what the FMU says to it."""
    if read_model_description(str(file)).fmiVersion == "2.0":
        host = Fmi2Host(file, folder, values=values)
        return host, host.messages
    said = []
    host = Fmi3Host(
        file, folder, None, values,
        loggingOn=True, logMessage=lambda _, status, category, text: said.append(text.decode()),
    )  # fmt: skip
    return host, said


def load(torque):
    return {"initial_speed": SPEED, "pinion.tau": torque, "wheel.tau": -3.0 * torque}


def unstable(host, kind):
    """A host with an inertia, explicit and far beyond its stable step, until the FMU refuses."""
    angle, speed = 0.0, SPEED
    inertia = {"motion": 0.02, "speed": 0.002}.get(kind, 0.02)
    for k in range(200):
        if kind in {"motion", "speed"}:
            host.set({"pinion.phi": angle, "pinion.w": speed} if kind == "motion"
                     else {"pinion.w": speed})  # fmt: skip
            host.step(k * STEP, STEP)
            torque = 200.0 + float(host.get("pinion.tau")[0])
        else:
            phi, w = float(host.get("pinion.phi")[0]), float(host.get("pinion.w")[0])
            if k == 0:
                angle = phi + 200.0 / 6e4
            shaft = 6e4 * (angle - phi) + 5.0 * (speed - w)
            host.set({"pinion.tau": shaft})
            host.step(k * STEP, STEP)
            torque = 200.0 - shaft
        angle += speed * STEP
        speed += torque / inertia * STEP
        angle += torque / inertia * STEP**2 / 2.0


@pytest.mark.parametrize("kind", KINDS)
def test_an_unstable_loop_is_told(kind, exported, tmp_path):
    """The input, its values and unit, and the steps of the documentation at that flange."""
    start = {"pinion.w": SPEED, "wheel.tau": -600.0} if kind in {"motion", "speed"} else load(200.0)
    host, said = opened(exported(kind), tmp_path, start)
    with pytest.raises(FMICallException):
        unstable(host, kind)
    (line,) = [text for text in said if "host is unstable" in text]
    names = {"motion": r"pinion\.(phi|w)", "speed": r"pinion\.w"}.get(kind, r"pinion\.tau")
    units = r"(rad|rad/s|N\.m)"
    assert re.search(rf"\.{names} = \S+ {units} after \S+ {units}: its changes alternate", line)
    assert "smaller than 0.001 s" in line
    with ZipFile(exported(kind)) as archive:
        page = archive.read("documentation/index.html").decode()
    row = re.search(r"<td>pinion</td><td>\w+</td><td>0.1 kg.*?</td><td>(.*?)</td>", page)
    assert f"{row[1]} with 0.1 kg.m2" in line


@pytest.mark.parametrize("kind", ["torque", "torque in FMI 3"])
@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_a_single_jump_is_told(noise, kind, exported, tmp_path):
    """Noise [N m], 1e-12 of the jump, changes its sign all the time, which is no unstable loop."""
    host, said = opened(exported(kind), tmp_path, load(200.0))
    for k in range(9):
        host.set({"pinion.tau": 200.0 + noise * (-1) ** k})
        host.step(k * STEP, STEP)
    host.set({"pinion.tau": 1e12})
    with pytest.raises(FMICallException):
        host.step(9 * STEP, STEP)
    assert re.search(r"pinion\.tau = 1e\+12 N\.m after [\d.]+ N\.m: it jumps", said[-1])


def test_steady_inputs_leave_the_inner_step(exported, tmp_path):
    host, said = opened(exported("torque"), tmp_path, load(1e12))
    with pytest.raises(FMICallException):
        host.step(0.0, STEP)
    assert "under steady inputs: the inner step is the cause" in said[-1]


@pytest.mark.parametrize(("share", "told"), [(0.9, 0), (1.3, 1), (20.0, 1)])
def test_load_beyond_the_table_is_told_once(share, told, exported, tmp_path):
    host, said = opened(exported("torque"), tmp_path, load(share * LIMIT))
    for k in range(5):
        host.step(k * STEP, STEP)
    lines = [text for text in said if "stiffness table ends" in text]
    assert len(lines) == told
    assert all("which is 5000 N.m at the pinion" in line for line in lines)


@pytest.mark.parametrize(
    ("kind", "change", "told"),
    [
        ("torque", {}, 0),
        ("torque", {"bearing_supports.pinion.radial_stiffness": 0.0}, 0),
        ("motion", {}, 1),
    ],
)
def test_slow_steps_are_told(kind, change, told, exported, tmp_path):
    start = load(200.0) if kind == "torque" else {"pinion.w": SPEED, "wheel.tau": -600.0}
    host, said = opened(exported(kind), tmp_path, start | change)
    host.step(0.0, STEP)
    assert len([text for text in said if "condensed core" in text]) == told


@pytest.mark.parametrize(("kind", "shaft"), [("motion", False), ("torque", True)])
def test_limits_are_those_of_the_documentation(kind, shaft, exported, capsys):
    """By the equations that the FMU carries, for any inertia, with the command that it gives."""
    file = exported(kind)
    with ZipFile(file) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "--flange PORT --inertia J`" in page
    assert "gives torque with `--stiffness K --damping D`" in page
    for inertia in ("0.02", "0.1", "1"):
        row = re.search(
            rf"<td>pinion</td><td>{kind}</td><td>{inertia} kg.*?</td><td>(\d+) us", page
        )
        command = ["stability", str(file), "--flange", "pinion", "--inertia", inertia]
        command += ["--stiffness", "6e4", "--damping", "5"] if shaft else []
        assert cli.main(command) == 0
        limit = re.search(r"    0  (?:inertia|shaft).* ([\d.]+)\n", capsys.readouterr().out)
        assert float(limit[1]) == pytest.approx(float(row[1]), abs=0.5)


def test_check_resolves_the_vibration(exported, capsys):
    assert cli.main(["check", str(exported("torque"))]) == 0
    said = capsys.readouterr().out
    assert "a body with direct feedthrough" in said
    assert "does not hold" not in said
    assert "is not clear" not in said


def test_words_of_a_flange_that_takes_motion(exported):
    model = read_model_description(str(exported("motion")))
    said = {v.name: v.description for v in model.modelVariables}
    assert said["pinion.phi"] == "angle of flange pinion"
    assert said["pinion.tau"] == "torque on the body at pinion"
    assert not [text for text in said.values() if re.search(r"\b(flange|at|from|to) [ab]\b", text)]


def test_a_housing_of_another_pair_is_told(tmp_path, capsys):
    """A pair of another centre distance: when it is exported, and in the FMU."""
    gear, file = write_pair(tmp_path / "mine.toml"), tmp_path / "g.fmu"
    command = ["export", "gearbox", "--as-fmu", "--gear", str(gear), "-o", str(file)]
    assert cli.main(command) == 0
    note = "apart, gear_mesh a centre distance of 161.7 mm"
    assert note in capsys.readouterr().err
    with ZipFile(file) as archive:
        assert note in archive.read("documentation/index.html").decode()
