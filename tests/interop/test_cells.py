"""Misbehaviour of foreign FMUs stays in their cells: the master, which is this process, lives."""

import os
import re
import sys
import tempfile
from pathlib import Path

import pytest
from support.hostile import ENDS, SEEN, Place, hostile_fmu

import herringbone as hb
from herringbone.core import FmuError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")
ROWS = 51
DEADLINE = 1.0
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
QUICK = [EVERY[k] for k in range(0, len(EVERY), 9)]


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


def run(systems, place, **options):
    """Run for 1 ms in steps of 0.01 ms."""
    if place is Place.SET:
        options |= {"algorithm": "jacobi:order=0", "probe": False}
    return hb.run(
        systems[place is Place.SET], step=1e-5, t_end=1e-3, record_step=2e-5,
        in_process=False, call_deadline=DEADLINE, **options,
    )  # fmt: skip


def check(systems, monkeypatch, tmp_path, place, deed):
    """Run, and see that nothing is left behind."""
    children, here = cells(), Path.cwd()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setenv("HOSTILE", f"{int(place)} {int(deed)}")
    if deed in ENDS and place in (Place.INSTANTIATE, Place.INITIALISE):
        with pytest.raises(FmuError) as caught:
            run(systems, place)
        lost(str(caught.value), place, deed)
    else:
        judge(run(systems, place), place, deed)
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


@pytest.mark.parametrize(("fmi", "place", "deed"), QUICK)
def test_misbehaviour(systems, monkeypatch, tmp_path, fmi, place, deed):
    check(systems[fmi], monkeypatch, tmp_path, place, deed)


@pytest.mark.slow
@pytest.mark.parametrize(("fmi", "place", "deed"), [case for case in EVERY if case not in QUICK])
def test_every_misbehaviour(systems, monkeypatch, tmp_path, fmi, place, deed):
    check(systems[fmi], monkeypatch, tmp_path, place, deed)
