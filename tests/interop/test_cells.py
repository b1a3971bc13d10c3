"""Misbehaviour of foreign FMUs stays in their cells: the master, which is this process, lives."""

import ctypes
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
from support.foreign.hostile import ENDS, SEEN, Deed, Place, hostile_fmu

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import FmuError
from herringbone.cosim.fmu.instance import new_part
from herringbone.cosim.loops.calls import do_step

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")
ROWS = 51
DEADLINE, PATIENT = 1.0, 60.0
"""Of a call [s]: of one that never answers, and of those that answer, on a busy machine late."""
CALLS = {
    Place.INSTANTIATE: "instantiate",
    Place.INITIALISE: "initialise",
    Place.SET: "set",
    Place.LATE_STEP: "doStep",
    Place.GET: "get",
    Place.TERMINATE: "terminate",
    Place.FREE: "free",
}
EVERY = [(fmi, place, deed) for fmi in (2, 3) for place in CALLS for deed in (*ENDS, *SEEN)]
CASES = EVERY if "EVERY_MISBEHAVIOUR" in os.environ else [EVERY[9 * k] for k in range(40)]
"""All 364 take five minutes; 40 of them meet every place and every deed."""


@pytest.fixture(scope="module")
def systems(tmp_path_factory):
    """Folders of two systems by FMI version: the hostile part alone, and fed by another one."""
    return {fmi: (alone(tmp_path_factory, fmi), pair(tmp_path_factory, fmi)) for fmi in (2, 3)}


def alone(factory, fmi):
    folder = factory.mktemp(f"alone{fmi}")
    hostile_fmu(folder, fmi)
    (folder / "system.toml").write_text('[parts.stranger]\nfmu = "hostile.fmu"\n')
    return folder


def pair(factory, fmi):
    folder = factory.mktemp(f"pair{fmi}")
    hostile_fmu(folder, fmi)
    (folder / "system.toml").write_text(
        'connections = [["source.y", "stranger.u"]]\n'
        '[parts]\nsource = { fmu = "hostile.fmu" }\nstranger = { fmu = "hostile.fmu" }\n'
    )
    return folder


def run(systems, place, deed, **options):
    """Run for 1 ms in steps of 0.01 ms."""
    deadline = DEADLINE if ENDS.get(deed) == "no answer" else PATIENT
    if place is Place.SET:
        options |= {"algorithm": "jacobi:order=0", "probe": False}
    return hb.run(
        systems[place is Place.SET], step=1e-5, t_end=1e-3, record_step=2e-5,
        in_process=False, call_deadline=deadline, **options,
    )  # fmt: skip


def check(systems, monkeypatch, tmp_path, place, deed):
    """Run, and see that nothing is left behind."""
    children, here = cells(), Path.cwd()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("HOSTILE", f"{int(place)} {int(deed)}")
    if deed in ENDS and place in (Place.INSTANTIATE, Place.INITIALISE):
        with pytest.raises(FmuError) as caught:
            run(systems, place, deed)
        lost(str(caught.value), place, deed)
    else:
        judge(run(systems, place, deed), place, deed)
    assert not list(tmp_path.iterdir())
    assert cells() == children
    assert Path.cwd() == here


def lost(said, place, deed):
    """The message names call and reason."""
    assert "stranger" in said
    assert re.search(ENDS[deed], said)
    assert re.search(rf"in {CALLS[place]}\b", said)


def judge(result, place, deed):
    """Outcome, rows and notes of a run."""
    outcome, rows = result.outcome, len(result.data)
    if deed in SEEN:
        assert (outcome.kind, rows) == (hb.OutcomeKind.COMPLETED, ROWS)
        noticed = [n for n in result.info.notes if n.startswith("stranger ") and SEEN[deed] in n]
        assert len(noticed) == 1 or not SEEN[deed]
    elif place in (Place.TERMINATE, Place.FREE):
        assert (outcome.kind, rows) == (hb.OutcomeKind.PART_LOST_AT_END, ROWS)
        lost(outcome.message, place, deed)
    else:
        assert outcome.kind is hb.OutcomeKind.PART_FAILED
        assert outcome.culprit == "stranger"
        assert 20 < rows < ROWS
        lost(outcome.message, place, deed)
        reached = float(re.search(r" at ([\d.e-]+) s", outcome.message)[1])
        assert reached == pytest.approx(outcome.time, abs=2.1e-5)


def cells():
    """Processes that are children of this one."""
    found = set()
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            status = (folder / "stat").read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(status[1]) == os.getpid():
            found.add(folder.name)
    return found


@pytest.mark.parametrize(("fmi", "place", "deed"), CASES)
def test_misbehaviour(systems, monkeypatch, tmp_path, fmi, place, deed):
    check(systems[fmi], monkeypatch, tmp_path, place, deed)


def test_endless_recursion_without_a_limit_of_the_stack(systems, monkeypatch, tmp_path):
    """It ends in the cell, not when the machine's memory is full."""
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_STACK)
    if hard != resource.RLIM_INFINITY:
        pytest.skip("the stack is limited here")
    resource.setrlimit(resource.RLIMIT_STACK, (hard, hard))
    try:
        check(systems[2], monkeypatch, tmp_path, Place.LATE_STEP, Deed.OVERFLOW)
    finally:
        resource.setrlimit(resource.RLIMIT_STACK, (soft, hard))


@pytest.mark.parametrize("fmi", [2, 3])
def test_crash_in_trials_is_an_outcome_of_the_run(systems, monkeypatch, fmi):
    """What trials do not survive, the run does not survive either; it says so."""
    monkeypatch.setenv("HOSTILE", f"{int(Place.SET)} {int(Deed.CRASH)}")
    options = {"step": 1e-5, "t_end": 1e-3, "algorithm": "jacobi:order=0"}
    result = hb.run(systems[fmi][1], in_process=False, **options)
    assert (result.outcome.kind, result.outcome.culprit) == (
        hb.OutcomeKind.PART_FAILED, "stranger"
    )  # fmt: skip


@pytest.mark.parametrize("place", [Place.INSTANTIATE, Place.LATE_STEP])
def test_check_survives(systems, monkeypatch, capsys, tmp_path, place):
    """The file has the name by which the FMU is hostile."""
    file = shutil.copy(systems[2][0] / "hostile.fmu", tmp_path / "stranger.fmu")
    monkeypatch.setenv("HOSTILE", f"{int(place)} {int(Deed.CRASH)}")
    assert main(["check", str(file), "--cells"]) == 1
    assert "signal 11 (SIGSEGV) in " in capsys.readouterr().out


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("deed", [Deed.ROUND, Deed.FLUSH, Deed.PRECISION])
def test_modes_of_floating_point_are_restored_in_process(systems, monkeypatch, fmi, deed):
    """After each call: those from Python, and those of compiled code."""
    before = modes()
    assert before[:2] == (0, True)
    for place in (Place.INITIALISE, Place.STEP):
        monkeypatch.setenv("HOSTILE", f"{int(place)} {int(deed)}")
        part = new_part("stranger", systems[fmi][0] / "hostile.fmu")
        part.enter_initialization(0.0, 1.0)
        assert modes() == before
        part.exit_initialization()
        at = part.addresses
        assert do_step(at.do_step, at.component, 0.0, 1e-3) == 0
        assert modes() == before
        part.close()


def modes():
    """Rounding mode, whether denormal numbers are there, digits of a third in the older unit."""
    third = np.longdouble(1.0) / np.longdouble(3.0)
    return ctypes.CDLL(None).fegetround(), sys.float_info.min / np.float64(2.0) > 0.0, str(third)


SLAVE = """from pythonfmu import Fmi2Slave, Fmi2Causality, Real
from own_gain import GAIN

class Gain(Fmi2Slave):
    def __init__(self, **options):
        super().__init__(**options)
        self.y = 0.0
        self.register_variable(Real("y", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.y = GAIN
        return True
"""


def test_python_fmus_have_modules_of_their_own(tmp_path):
    """Two FMUs with the same names of all modules; in one process the first would serve both."""
    lines = []
    for name, gain in (("first", 2.0), ("second", 3.0)):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "gain.py").write_text(SLAVE)
        (folder / "own_gain.py").write_text(f"GAIN = {gain}\n")
        command = [sys.executable, "-m", "pythonfmu", "build", "-f", "gain.py", "own_gain.py"]
        subprocess.run(command, cwd=folder, check=True, capture_output=True)
        lines.append(f'{name}.fmu = "{name}/Gain.fmu"')
    (tmp_path / "system.toml").write_text("\n".join(["[parts]", *lines]))
    last = hb.run(tmp_path, step=1e-3, t_end=2e-3, probe=False, in_process=False).data.iloc[-1]
    assert (last["first.y"], last["second.y"]) == (2.0, 3.0)
