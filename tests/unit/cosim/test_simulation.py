"""The run around the compiled loop: grid, end time, outcomes, interruption, determinism."""

import math
import os
import signal
import threading
from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from support.algorithms import variants
from support.parts.fakes import OK
from support.parts.misbehaviour import dawdle, fail_at, spoil_at
from support.parts.running import columns
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.core import HerringboneError, OutcomeKind, ParameterError
from herringbone.core.part import closing_all
from herringbone.core.run_table import KeptRows
from herringbone.cosim import run
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.divergence import is_sudden
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.simulation import check_records, make_grid, simulate
from herringbone.cosim.structure.system import System

PROBLEM = TwoMass(zeta=0.05)
STAGED = [a for a in variants() if not a.needs]
"""Algorithms that step each part once, whatever it can do."""


# -- grid ---------------------------------------------------------------------------------------


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


# -- a run --------------------------------------------------------------------------------------


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


# -- runs that end early ------------------------------------------------------------------------


@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_a_part_that_fails(algorithm):
    whole = PROBLEM.run(algorithm, 0.1, 2.0)
    recording = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=fail_at(1.0))
    outcome = recording.outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left"
    assert outcome.time == pytest.approx(0.9)
    assert outcome.message.startswith("left refused its step at 0.9 s")
    assert recording.time == pytest.approx(np.arange(10) * 0.1)
    assert recording.values.tobytes() == whole.values[:10].tobytes()


@pytest.mark.parametrize("status", [2, 3, 4])
def test_discard_error_and_fatal_are_failures(status):
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(1.0, status))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED


def test_a_warning_is_no_failure():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(1.0, 1))
    assert recording.outcome.kind is OutcomeKind.COMPLETED


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_values_that_are_not_finite(algorithm, value):
    whole = PROBLEM.run(algorithm, 0.1, 2.0)
    recording = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=spoil_at(1.0, value))
    outcome = recording.outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left.flange.v"
    assert outcome.time == pytest.approx(1.0)
    assert outcome.message == "left.flange.v is not finite at 1 s, and nothing has grown before"
    assert recording.time == pytest.approx(np.arange(10) * 0.1)
    assert recording.values.tobytes() == whole.values[:10].tobytes()


@pytest.mark.parametrize("algorithm", STAGED, ids=str)
def test_values_that_are_not_finite_in_the_first_steps(algorithm):
    """Whether something has grown cannot be seen; the part that began it is named all the same."""
    outcome = PROBLEM.run(algorithm, 0.1, 2.0, misbehave=spoil_at(0.2)).outcome
    assert outcome.kind is OutcomeKind.PART_FAILED
    assert outcome.culprit == "left.flange.v"
    assert "is not finite at 0.2 s, as soon as the run has begun" in outcome.message


def test_an_output_that_is_no_number_and_that_nothing_takes():
    """The run is complete, but no success; a failure later keeps all rows before it."""

    def run(misbehave, streaming=None):
        parts = PROBLEM.parts(misbehave=misbehave)
        parts[0]._add("gauge", "output", frozenset())
        return simulate(
            TWO_MASS_SYSTEM, parts, Jacobi(order=2), make_grid(2.0, 0.1, 0.1), streaming=streaming
        )

    gauge, velocity = spoil_at(0.5, output="gauge"), spoil_at(1.5)
    found = run(gauge)
    assert found.outcome.kind is OutcomeKind.WITH_NAN
    assert found.outcome.culprit == "left.gauge"
    assert found.outcome.message.startswith("left.gauge is NaN from 0.5 s on")
    assert found.time[-1] == pytest.approx(2.0)
    assert run(gauge, Streaming(Folder(np.empty((0, 7))))).outcome == found.outcome
    both = run(lambda part, t: max(gauge(part, t), velocity(part, t)))
    assert both.outcome.kind is OutcomeKind.PART_FAILED
    assert both.outcome.culprit == "left.flange.v"
    assert both.time[-1] == pytest.approx(1.4)


def test_values_that_are_not_finite_after_growth():
    """The coupling may be to blame: rows that grow tenfold from the first half on tell so."""
    growing = np.exp(np.linspace(0.0, 2.0 * np.log(10.1), 21))[:, None] * np.ones(3)
    assert not is_sudden(lambda: [growing])
    assert not is_sudden(lambda: [growing[:4], growing[4:18], growing[18:], growing[:1] * np.nan])
    assert is_sudden(lambda: [growing[:11]])
    assert is_sudden(lambda: [growing[:3], growing[3:11]])


class Folder:
    """Where rows go that a run was resumed with, and those that it adds."""

    def __init__(self, there):
        self.there = [there]

    def begin(self, columns, rows):
        pass

    def append(self, times, values, others):
        self.there.append(values)

    def read(self):
        return ((np.zeros(len(values)), values) for values in self.there)

    def cut(self, rows):
        pass

    def kept(self):
        values = np.vstack(self.there)
        return KeptRows(np.arange(float(len(values))), values, {})


@pytest.mark.parametrize(
    ("size", "kind"), [(1.0, OutcomeKind.PART_FAILED), (1e-3, OutcomeKind.DIVERGED)]
)
def test_growth_before_a_run_was_resumed_counts(size, kind):
    """The rows since then, a second of an oscillation, have not grown; all rows may have."""
    whole = PROBLEM.run(Jacobi(order=2), 0.1, 2.0)
    folder = Folder(size * np.abs(whole.values).max(axis=0) * np.ones((30, 1)))
    parts = PROBLEM.parts(misbehave=spoil_at(1.0, math.nan))
    recording = simulate(
        TWO_MASS_SYSTEM, parts, Jacobi(order=2), make_grid(2.0, 0.1, 0.1),
        streaming=Streaming(folder),
    )  # fmt: skip
    assert recording.outcome.kind is kind


def test_failure_in_the_first_step_keeps_the_start():
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 2.0, misbehave=fail_at(0.0))
    assert recording.outcome.time == 0.0
    assert recording.time.tolist() == [0.0]
    assert np.isfinite(recording.values).all()


# -- interruption -------------------------------------------------------------------------------


@pytest.fixture
def handler():
    """A SIGINT handler of the caller's, which a run has to give back."""
    calls = []

    def mine(number, frame):
        calls.append(number)

    before = signal.signal(signal.SIGINT, mine)
    yield mine, calls
    signal.signal(signal.SIGINT, before)


def interrupt():
    """SIGINT to this process, whose main thread this is."""
    os.kill(os.getpid(), signal.SIGINT)


STEP_TIME = 0.02


def test_interrupt_ends_the_run_within_a_chunk(handler, monkeypatch):
    """By a clock of its own, each step takes STEP_TIME; a chunk takes CHUNK_SECONDS."""
    mine, calls = handler
    now, sent = [0.0], []

    def dawdle_and_interrupt(part, t):
        now[0] += STEP_TIME
        if t > 5.0 and not sent:
            sent.append(t)
            interrupt()
        return OK

    clock = lambda: now[0]  # noqa: E731
    monkeypatch.setattr(run, "time", SimpleNamespace(perf_counter=clock, thread_time=clock))
    recording = PROBLEM.run(Jacobi(order=2), 0.1, 1000.0, misbehave=dawdle_and_interrupt)
    outcome = recording.outcome
    assert outcome.kind is OutcomeKind.INTERRUPTED
    assert outcome.message == f"stopped at {outcome.time:g} s; results so far are kept"
    assert sent[0] - 1e-9 <= outcome.time < sent[0] + 0.1 * run.CHUNK_SECONDS / STEP_TIME
    assert recording.wall_seconds <= now[0]
    assert recording.time[-1] == pytest.approx(outcome.time)
    assert np.isfinite(recording.values).all()
    assert calls == []
    assert signal.getsignal(signal.SIGINT) is mine


def test_interrupt_of_quick_parts(handler):
    """Nothing is stepped after the chunk in which the signal came."""
    reached = []

    def interrupt_the_third(time, end):
        reached.append(time)
        if len(reached) == 3:
            interrupt()

    grid = make_grid(1e5, 0.1, 0.1)
    parts = PROBLEM.parts()
    recording = simulate(TWO_MASS_SYSTEM, parts, Jacobi(order=2), grid, interrupt_the_third)
    assert recording.outcome.kind is OutcomeKind.INTERRUPTED
    assert recording.outcome.time == reached[2] == reached[-1]
    assert recording.time.size == recording.macro_steps + 1
    assert np.isfinite(recording.values).all()


def test_chunks_grow_no_more_than_fourfold(monkeypatch):
    """A clock that stands still promises any rate: 1, 4, 16, ... steps."""
    clock = lambda: 0.0  # noqa: E731
    monkeypatch.setattr(run, "time", SimpleNamespace(perf_counter=clock, thread_time=clock))
    reached = []
    simulate(TWO_MASS_SYSTEM, PROBLEM.parts(), Jacobi(order=2), make_grid(8.5, 0.1, 0.1),
             lambda time, end: reached.append(time))  # fmt: skip
    assert np.diff([0.0, *reached]) == pytest.approx([0.1, 0.4, 1.6, 6.4], abs=1e-12)


def test_handler_is_restored_after_an_error(handler):
    mine, _ = handler
    with pytest.raises(ZeroDivisionError), InterruptFlag():
        raise ZeroDivisionError
    assert signal.getsignal(signal.SIGINT) is mine


def test_runs_in_another_thread(handler):
    """Python delivers signals to the main thread only; elsewhere the handler is left alone."""
    mine, _ = handler
    found = []
    thread = threading.Thread(
        target=lambda: found.append(PROBLEM.run(Jacobi(order=2), 0.1, 2.0).outcome.kind)
    )
    thread.start()
    thread.join()
    assert found == [OutcomeKind.COMPLETED]
    assert signal.getsignal(signal.SIGINT) is mine


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
