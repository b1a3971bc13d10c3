"""Foreign FMUs give the same bits in cells as in the master's process, whatever is exchanged."""

import sys

import numpy as np
import pytest
from support.foreign.all_types import EVENTS, KINDS, build_all_types
from support.foreign.oscillator import Oscillator

import herringbone as hb
from herringbone.cosim.structure.system import PartSpec, System

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")
CASES = [
    ("force and force", "mass", False, "li:degree=3"),
    ("motion and motion", "mass", True, "li:degree=2"),
    ("force and motion", "curve", False, "li:degree=3"),
    ("force and motion", "mass", False, "jacobi:order=2"),
    ("motion and motion", "mass", False, "jacobi:order=1,schedule=parallel"),
    ("force and force", "mass", True, "gauss_seidel"),
]
"""Cut, kind of the masses (`curve` has FMI derivatives), without states, algorithm."""


@pytest.mark.parametrize(("cut", "mass", "plain", "algorithm"), CASES)
def test_coupled_parts(kinds, cut, mass, plain, algorithm):
    """Records in every third step: what is read is not the same in all."""
    oscillator = Oscillator(kinds, cut, 0.01, plain=plain, mass=mass)
    found = [
        hb.run(
            oscillator.system, algorithm=algorithm, step=1e-3, record_step=3e-3, t_end=0.3,
            start="rest", values=oscillator.values, in_process=in_process,
        )
        for in_process in (False, True)
    ]  # fmt: skip
    same(*found)
    assert np.ptp(found[0].data["one.x"]) > 1.0


def notes(result):
    return [note for note in result.info.notes if "trials are not possible" not in note]


def same(one, other):
    """Outcome, notes and all values; trials that a part ends may be told at another call."""
    assert one.outcome == other.outcome
    assert notes(one) == notes(other)
    assert list(one.data) == list(other.data)
    for name in one.data:
        assert one.data[name].tolist() == other.data[name].tolist(), name


@pytest.mark.parametrize("end", [0.75, 0.73])
@pytest.mark.parametrize("abilities", ["", EVENTS])
def test_all_types(tmp_path, abilities, end):
    """Arrays of a size that is set, all types connected, events inside of steps, and an end, at a
    communication point or within a step."""
    file = build_all_types(tmp_path, abilities)
    parts = tuple(PartSpec(name, fmu=file) for name in "ab")
    joined = [(f"a.{kind}_out", f"b.{kind}_in") for kind in KINDS if kind != "Float32"]
    joined += [("a.y[1]", "b.u[2]"), ("a.swapped", "b.pair")]
    system = System("two", "", parts, tuple(joined))
    values = {"a.n": 4, "b.n": 3, "a.u": [1, 2, 3, 4], "a.String_in": "a", "a.Binary_in": "00ff"}
    values |= {"a.every": 0.1625 if abilities else 0.0, "a.Float32_in": 0.1, "b.end": end}
    found = [
        hb.run(
            system, values=values, step=0.05, t_end=1.0, record_step=0.1,
            algorithm="jacobi:order=0", in_process=in_process,
        )
        for in_process in (False, True)
    ]  # fmt: skip
    same(*found)
    assert found[0].data["b.String_out"].iloc[-1] == "a"
    assert found[0].outcome.kind is hb.OutcomeKind.ENDED
    assert found[0].outcome.time == pytest.approx(end, rel=1e-12)
