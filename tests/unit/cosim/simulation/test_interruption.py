"""Runs that are interrupted: within a chunk, with the caller's handler given back."""

import os
import signal
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from support.parts.fakes import OK
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.core import OutcomeKind
from herringbone.cosim import run
from herringbone.cosim.algorithms import Jacobi
from herringbone.cosim.interrupt import InterruptFlag
from herringbone.cosim.simulation import make_grid, simulate

PROBLEM = TwoMass(zeta=0.05)


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


def test_a_signal_that_a_host_in_c_handles_is_left_to_it(monkeypatch):
    """Python knows of its handler that it is none of its own, and cannot set it again."""
    mine = lambda number, frame: None  # noqa: E731
    handlers = {signal.SIGINT: mine, signal.SIGTERM: None}

    def set_handler(number, handler):
        if handler is None:
            raise TypeError
        before, handlers[number] = handlers[number], handler
        return before

    monkeypatch.setattr(signal, "signal", set_handler)
    monkeypatch.setattr(signal, "getsignal", handlers.get)
    with InterruptFlag():
        assert handlers[signal.SIGINT] is not mine
        assert handlers[signal.SIGTERM] is None
    assert handlers == {signal.SIGINT: mine, signal.SIGTERM: None}


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
