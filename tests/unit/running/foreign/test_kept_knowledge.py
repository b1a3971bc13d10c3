"""Signatures and limits are found once, and again when anything has changed that decides them."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from herringbone.analysis.stability.steps.step_limits import StepLimits
from herringbone.core.places.paths import CACHE_VARIABLE, component_folder
from herringbone.cosim.algorithms import LI, Jacobi
from herringbone.cosim.cell.policy import foreign_fmu_policy, remarks_of_cells
from herringbone.cosim.signature import Answer, Kind, Signature
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.foreign.known_signatures import known_signature
from herringbone.running.known_limits import KnownLimits
from herringbone.running.settling import flanks
from herringbone.running.settling.stranger import NeverSettlesError, NoSettledStartError

STEP = 1e-4
LIMITS = StepLimits(
    "li", ((1e-4, 2e-4), (3e-4, np.inf)), {"minimum": 1e-4, "mean": 1e-4}, 1234.5, None, 1e-3, 2e-3
)
SIGNATURE = Signature(
    ("u",),
    ("y",),
    step=STEP,
    kind=Kind.UNKNOWN,
    feedthrough=np.ones((1, 1)),
    memory=Answer.NO,
    delay=np.zeros((1, 1), dtype=int),
)


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))


@pytest.fixture
def system(tmp_path):
    """One own part that reads a file, and a foreign one; nobody opens the latter."""
    fmu = tmp_path / "theirs.fmu"
    fmu.write_bytes(b"content")
    cycle = component_folder("bench_controller") / "resources" / "loaded.csv"
    values = {"cycle": str(shutil.copy(cycle, tmp_path / "cycle.csv"))}
    parts = PartSpec("own", "bench_controller", values=values), PartSpec("theirs", fmu=fmu)
    return System("both", "", parts, (("own.speed", "theirs.speed"),))


def counted(found):
    """A search, and the calls of it."""
    calls = []

    def find():
        calls.append(1)
        return found

    return find, calls


def test_limits_are_found_once(system):
    find, calls = counted(LIMITS)
    assert KnownLimits(system, STEP)(LI(), False, find) == LIMITS
    assert KnownLimits(system, STEP)(LI(), False, find) == LIMITS
    assert len(calls) == 1


@pytest.mark.parametrize("what", ["fmu", "file", "value", "wire", "step", "algorithm", "runs"])
def test_limits_follow_what_decides_them(system, what):
    find, calls = counted(LIMITS)
    KnownLimits(system, STEP)(LI(), False, find)
    own, theirs = system.parts
    step, algorithm, simulated = STEP, LI(), False
    if what == "fmu":
        theirs.fmu.write_bytes(b"other content")
    elif what == "file":
        Path(own.values["cycle"]).write_text("other", encoding="utf-8")
    elif what == "value":
        system = replace(system, parts=(own, replace(theirs, values={"mass": 2.0})))
    elif what == "wire":
        system = replace(system, connections=())
    elif what == "step":
        step = 2.0 * STEP
    elif what == "algorithm":
        algorithm = Jacobi(1)
    else:
        simulated = True
    KnownLimits(system, step)(algorithm, simulated, find)
    assert len(calls) == 2


def test_an_unknown_signature_is_looked_for_again(system):
    spec = system.parts[1]
    find, calls = counted(SIGNATURE)
    for _ in range(2):
        assert known_signature(spec, STEP, find).kind is Kind.UNKNOWN
    assert len(calls) == 2
    find, calls = counted(replace(SIGNATURE, kind=Kind.BODY))
    for _ in range(2):
        assert known_signature(spec, STEP, find).feedthrough == 1.0
    assert len(calls) == 1
    known_signature(replace(spec, values={"mass": 2.0}), STEP, find)
    assert len(calls) == 2


def test_what_is_found_after_a_trial_was_lost_is_looked_for_again(system):
    """A crash, or a late answer, is not what the part does."""
    limits, of_limits = counted(LIMITS)
    signature, of_signature = counted(replace(SIGNATURE, kind=Kind.BODY))

    def ask():
        KnownLimits(system, STEP)(LI(), False, limits)
        known_signature(system.parts[1], STEP, signature)

    with foreign_fmu_policy() as found:
        found.note_lost("theirs", "no answer within 60 s")
        with remarks_of_cells():
            ask()
    for _ in range(2):
        ask()
    assert (len(of_limits), len(of_signature)) == (2, 2)
    (remark,) = found.remarks
    assert str(remark) == (
        "theirs lost a trial (no answer within 60 s); what follows from it is not kept"
    )


@pytest.mark.parametrize(("error", "searches"), [(NeverSettlesError, 1), (NoSettledStartError, 2)])
def test_why_nothing_settles_is_found_once_unless_a_part_failed(
    system, monkeypatch, error, searches
):
    calls = []

    def search(*_):
        calls.append(1)
        raise error("their.torque does not die out")

    monkeypatch.setattr(flanks, "settled_start", search)
    for _ in range(2):
        with pytest.raises(error, match="does not die out"):
            flanks.loaded_settled_start(system, system, STEP)
    assert len(calls) == searches
