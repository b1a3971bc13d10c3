"""Processes of our own that compute chains.

Not those of `concurrent.futures`: these would run the user's script a second time, stay behind when
their parent is killed, and do not tell which chain has killed one.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import Executor, Future
from queue import SimpleQueue
from threading import Lock, Thread
from typing import Any

from herringbone.core import HerringboneError, reason
from herringbone.core.places.paths import PACKAGE, module_path
from herringbone.studies.working.forked import ForkedProcess

_MODULE = "herringbone.studies.working.process"
_ATTEMPTS = 3
"""Processes that may die of the same chain."""

Process = subprocess.Popen | ForkedProcess
Task = tuple[Future, Callable, tuple, dict]


class WorkerProcesses(Executor):
    """Processes that end with this one, and are replaced when they die.

    Args:
        count: of processes.
        forked: the first ones are copies of this process, see `can_fork`. Else, and in place of
            those that die, they are started anew, and load what they need.
    """

    def __init__(self, count: int, *, forked: bool = False) -> None:
        self._tasks: SimpleQueue[Task | None] = SimpleQueue()
        first = [ForkedProcess() if forked else None for _ in range(count)]
        self._processes: set[Process] = {each for each in first if each is not None}
        self._lock, self._ended = Lock(), False
        self._threads = [Thread(target=self._serve, args=(each,), daemon=True) for each in first]
        for thread in self._threads:
            thread.start()

    def submit(self, fn: Callable, /, *args: Any, **kwargs: Any) -> Future:  # noqa: ANN401
        """See `concurrent.futures.Executor`."""
        future: Future = Future()
        self._tasks.put((future, fn, args, kwargs))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End all processes; with `cancel_futures` at once."""
        if cancel_futures:
            with self._lock:
                self._ended = True
                for process in self._processes:
                    process.kill()
        for _ in self._threads:
            self._tasks.put(None)
        if wait:
            for thread in self._threads:
                thread.join()

    def _serve(self, process: Process | None) -> None:
        """Hand tasks to one process after the other."""
        while (task := self._tasks.get()) is not None:
            if self._ended or not task[0].set_running_or_notify_cancel():
                continue
            try:
                process = self._done(process, task)
            except Exception as error:  # no process can be started, what came back not be made here
                task[0].set_exception(HerringboneError(f"a process of the study: {reason(error)}"))
                process = None
        if process is not None:
            process.stdin.close()  # type: ignore[union-attr]
            process.wait()
            self._forget(process)

    def _done(self, process: Process | None, task: Task) -> Process | None:
        """Do a task; returns the process that is alive then."""
        future, *work = task
        try:
            call = pickle.dumps(work)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            future.set_exception(HerringboneError(f"the evaluator cannot be sent: {error}"))
            return process
        for _ in range(_ATTEMPTS):
            process = process or self._started()
            try:
                process.stdin.write(call)  # type: ignore[union-attr]
                process.stdin.flush()  # type: ignore[union-attr]
                found, raised = pickle.load(process.stdout)  # type: ignore[arg-type]
            except (OSError, EOFError, pickle.UnpicklingError):
                code, process = self._end(process), None
                if self._ended:
                    future.set_exception(HerringboneError("the study was ended"))
                    return None
                continue
            except Exception:  # what came back cannot be made here, and more of it may follow
                self._end(process)
                raise
            if raised is None:
                future.set_result(found)
            else:
                future.set_exception(raised)
            return process
        future.set_exception(
            HerringboneError(
                f"{_ATTEMPTS} processes one after the other died of the same chain of points "
                f"(exit code {code}); run one of its points alone to see why"
            )
        )
        return process

    def _started(self) -> subprocess.Popen:
        path = os.pathsep.join([str(PACKAGE.parent), module_path()])
        process = subprocess.Popen(
            [sys.executable, "-m", _MODULE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, "PYTHONPATH": path},
            start_new_session=True,  # an interrupt is of the parent, which ends them
        )
        with self._lock:
            self._processes.add(process)
            if self._ended:
                process.kill()
        return process

    def _end(self, process: Process) -> int:
        """End a process; returns its exit code."""
        process.kill()
        self._forget(process)
        return process.wait()

    def _forget(self, process: Process) -> None:
        with self._lock:
            self._processes.discard(process)
        for stream in (process.stdin, process.stdout):
            try:
                stream.close()  # type: ignore[union-attr]
            except OSError:  # what it did not take
                continue
