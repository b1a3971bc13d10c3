"""The run around the compiled loop: grid, end time, records, parts, determinism."""

import math
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from support.algorithms import STAGED
from support.parts.misbehaviour import dawdle
from support.parts.running import columns
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.core import HerringboneError, ParameterError
from herringbone.core.part import closing_all
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.simulation import check_records, make_grid, simulate
from herringbone.cosim.structure.system import System

PROBLEM = TwoMass(zeta=0.05)


@pytest.mark.parametrize("bad", [0.0, -1e-5, math.nan, math.inf])
@pytest.mark.parametrize("name", ["step", "t_end", "record_step"])
def test_grid_refuses(name, bad):
    values = {"t_end": 1.0, "step": 0.1, "record_step": 0.1} | {name: bad}
    with pytest.raises(ParameterError, match=f"{name} = .* s: it must be positive and finite"):
        make_grid(**values)


def test_grid_refuses_what_is_no_number():
    with pytest.raises(ParameterError, match="t_end = 'x': it must be a number of seconds"):
        make_grid("x", 0.1, 0.1)


def test_grid_refuses_an_end_before_the_first_step():
    with pytest.raises(ParameterError, match=r"t_end = 0\.05 s is shorter than one step of 0\.1 s"):
        make_grid(0.05, 0.1, 0.1)


def test_a_run_records_more_than_its_start():
    check_records(0.2, 0.2)
    check_records(0.3, 3 * 0.1)  # longer by a rounding
    said = r"record_step = 1 s is longer than the run, t_end = 0\.2 s: only its start would be"
    with pytest.raises(ParameterError, match=said):
        check_records(0.2, 1.0)


@pytest.mark.parametrize(
    ("t_end", "step", "count"),
    [(0.2, 1e-5, 20000), (0.1, 0.03, 4), (1.0, 1.0, 1), (0.3, 0.1, 3), (0.02, 2.0000001e-5, 1000)],
)
def test_grid_shortens_the_step_to_hit_the_end(t_end, step, count):
    grid = make_grid(t_end, step, step)
    assert grid.count == count
    assert grid.step <= step * (1.0 + 1e-9)
    assert grid.step * grid.count == pytest.approx(t_end, rel=1e-15)


@pytest.mark.parametrize(
    ("record_step", "every"),
    [(1e-5, 1), (1e-9, 1), (2e-5, 2), (2.5e-5, 2), (3e-5, 3), (1.0, 10**5)],
)
def test_records_are_whole_numbers_of_steps(record_step, every):
    assert make_grid(1.0, 1e-5, record_step).every == every


@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_each_part_steps_once_a_macro_step(algorithm):
    parts = PROBLEM.parts()
    recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(2.0, 0.1, 0.1))
    assert [part.steps for part in parts] == [20, 20, 20] == list(recording.passes.values())


def test_chunks_do_not_change_the_result():
    """Slow parts make other chunks; the result is the same."""
    quick = PROBLEM.run(Jacobi(order=2), 0.1, 4.0)
    slow = PROBLEM.run(Jacobi(order=2), 0.1, 4.0, misbehave=dawdle(0.004))
    assert quick.values.tobytes() == slow.values.tobytes()


def test_records_are_every_nth_point():
    fine = PROBLEM.run(Jacobi(order=2), 0.1, 2.0)
    grid = make_grid(2.0, 0.1, 0.3)
    coarse = simulate(TWO_MASS_SYSTEM, PROBLEM.parts(), Jacobi(order=2), grid)
    assert coarse.time == pytest.approx(np.arange(7) * 0.3)
    assert coarse.values.tobytes() == fine.values[::3].tobytes()
    assert (coarse.step, coarse.record_step) == (grid.step, 3 * grid.step)


def test_first_record_is_the_consistent_start():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 1.0)
    stretch = PROBLEM.start[0] - PROBLEM.start[1]
    found = columns(recording, ("left.flange.s", "right.flange.s", "spring.a.f"))[0]
    assert found == pytest.approx([*PROBLEM.start, -PROBLEM.stiffness * stretch], rel=1e-15)


def test_names_and_units():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 1.0)
    units = dict(zip(recording.names, recording.units, strict=True))
    assert units == {
        "left.flange.s": "m", "left.flange.v": "m/s",
        "right.flange.s": "m", "right.flange.v": "m/s",
        "spring.a.f": "N", "spring.b.f": "N",
    }  # fmt: skip


def test_progress_ends_at_the_end():
    seen = []
    grid = make_grid(2.0, 0.1, 0.1)
    simulate(
        TWO_MASS_SYSTEM, PROBLEM.parts(), Jacobi(order=2), grid, lambda *told: seen.append(told)
    )
    assert seen == sorted(seen)
    assert seen[-1] == pytest.approx((2.0, 2.0))


def test_parts_without_connected_inputs_only():
    """A system without connections runs: every part is a source."""
    recording = simulate(
        System("free", "", TWO_MASS_SYSTEM.parts, ()),
        TwoMass(start=(1.0, 2.0)).parts(), Jacobi(order=2), make_grid(1.0, 0.1, 0.1),
    )  # fmt: skip
    assert columns(recording, ("left.flange.s", "right.flange.s"))[-1].tolist() == [1.0, 2.0]


@pytest.mark.parametrize("algorithm", [a for a in STAGED if a == type(a)()], ids=str)
def test_unconnected_inputs_keep_their_start_value(algorithm):
    """A force that nothing feeds, and whose signal nodes nobody sets, acts on both masses alike."""
    parts = TwoMass(start=(0.0, 0.0)).parts()
    for part in parts[:2]:
        part.set("load.f", 3.0 * part.mass)
    recording = simulate(TWO_MASS_SYSTEM, parts, algorithm, make_grid(2.0, 0.1, 0.1))
    found = columns(recording, ("left.flange.s", "right.flange.s", "spring.a.f"))[-1]
    assert found == pytest.approx([6.0, 6.0, 0.0], abs=1e-12)  # s = a t^2 / 2


def test_all_parts_are_closed_after_an_error():
    closed = []
    parts = [SimpleNamespace(close=partial(closed.append, name)) for name in ("left", "right")]
    with pytest.raises(HerringboneError), closing_all(parts) as opened:
        assert opened is parts
        raise HerringboneError("a part refuses to initialise")
    assert closed == ["left", "right"]
