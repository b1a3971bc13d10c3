"""Where chains are computed, and on how many cores."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, NamedTuple

from herringbone.core import ParameterError
from herringbone.studies.working.forked import can_fork
from herringbone.studies.working.processes import WorkerProcesses

_AHEAD = 3
"""Chains that are handed to a worker before it is done with one."""
_WINDOW = 512
"""Pieces that are handed to an executor of the caller, whose workers are not known."""
_PIECE, _PIECES = 1.0, 32
"""CPU time [s] of a piece that such an executor takes at once, as each costs it some 10 ms of its
own; and pieces that there are at the least, so that its workers end together."""
_WORTH, _FORK_WORTH = 10.0, 1.0
"""CPU time [s] that a further process must save: one that is started anew loads all code first."""


@dataclass(frozen=True)
class Workers:
    """Where a study is computed.

    Attributes:
        executor: of the caller; None: processes of our own, or this one.
        count: of processes; None: as many as there are cores, and as are worth it.
        cores: that a point takes: one, and one for each part that runs in a process of its own.
    """

    executor: Executor | None = None
    count: int | None = None
    cores: int = 1

    def __post_init__(self) -> None:
        """Check it; raises ParameterError."""
        if self.count is not None and self.count < 1:
            raise ParameterError(f"workers = {self.count}: it must be at least 1")


class Working(NamedTuple):
    """Where chains are computed.

    Attributes:
        executor: that computes them.
        window: pieces that are under way or wait at most.
        told: where, for people.
        piece: chains that are handed on at once.
    """

    executor: Executor
    window: int
    told: str
    piece: int = 1


@contextmanager
def working(asked: Workers, cpu: float, chains: int) -> Iterator[Working]:
    """What computes the chains of a study.

    Args:
        asked: of it.
        cpu: time that all takes [s].
        chains: there are.
    """
    if asked.executor is not None:
        piece = max(1, min(int(_PIECE * chains / max(cpu, _PIECE)), chains // _PIECES))
        yield Working(asked.executor, _WINDOW, f"on {type(asked.executor).__name__}", piece)
        return
    fitting = max(1, _cores() // asked.cores)
    forked = asked.cores == 1 and can_fork()  # a part of others may have threads of its own
    worth = max(1, int(cpu / (_FORK_WORTH if forked else _WORTH)))
    count = min(asked.count or min(fitting, worth), max(chains, 1))
    if count == 1:
        yield Working(ThisProcess(), 1, "in this process")
        return
    processes = WorkerProcesses(count, forked=forked)
    try:
        yield Working(processes, _AHEAD * count, f"in {count} processes")
    except BaseException:
        processes.shutdown(cancel_futures=True)
        raise
    processes.shutdown()


class ThisProcess(Executor):
    """Calls at once what is submitted."""

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:  # noqa: ANN401
        """See `concurrent.futures.Executor`; errors are raised."""
        future: Future = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def _cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
