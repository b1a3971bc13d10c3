"""A process that computes, forked from this one: what is loaded and compiled is there at once.

A fork copies the thread that forks and no other, so that it is made where there is no other, and
before any is started. The threads of BLAS end before a fork by themselves.
"""

import gc
import os
import signal
import sys
import threading
from pathlib import Path
from typing import BinaryIO, NoReturn

from herringbone.studies.working.process import serve

_STDERR = 2
_ENDING = 0.2
"""Time [s] that a thread may take to end that was told to."""


def can_fork() -> bool:
    """True if a copy of this process can go on by itself: on Linux, and without other threads."""
    if sys.platform != "linux":
        return False
    others = [each for each in threading.enumerate() if each is not threading.current_thread()]
    for thread in others:
        thread.join(_ENDING / len(others))
    return threading.active_count() == 1


class ForkedProcess:
    """A process with pipes to its stdin and from its stdout, as `subprocess.Popen` makes them.

    Attributes:
        pid: of it.
        stdin, stdout: pipes.
    """

    def __init__(self) -> None:
        calls, self.stdin = _pipe()
        self.stdout, answers = _pipe()
        for stream in filter(None, (sys.stdout, sys.stderr)):  # closed ones are None
            stream.flush()  # else the copy has it, too
        self.pid = os.fork()
        if self.pid == 0:
            _compute(calls, answers)
        calls.close()
        answers.close()
        self.stdout.read(1)  # until it holds nothing of this process: locks of folders above all
        self._code: int | None = None
        self._reaping = threading.Lock()

    def kill(self) -> None:
        """End it at once."""
        with self._reaping:
            if self._code is None:
                os.kill(self.pid, signal.SIGKILL)

    def wait(self) -> int:
        """Wait until it ends; returns its exit code, of a signal the negative one."""
        if self._code is None:
            os.waitid(os.P_PID, self.pid, os.WEXITED | os.WNOWAIT)  # nobody else has its number yet
            with self._reaping:
                self._code = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
        return self._code


def _pipe() -> tuple[BinaryIO, BinaryIO]:
    """Both ends: for reading, for writing."""
    ends = os.pipe()
    return os.fdopen(ends[0], "rb"), os.fdopen(ends[1], "wb")


def _compute(calls: BinaryIO, answers: BinaryIO) -> NoReturn:
    """What the copy does; it never returns into what its parent was about."""
    try:
        os.setsid()  # an interrupt is of the parent, which ends it
        gc.freeze()  # what is shared stays so
        _let_go({calls.fileno(), answers.fileno()})
        answers.write(b".")
        answers.flush()
        serve(calls, answers)
    finally:
        os._exit(1)


def _let_go(kept: set[int]) -> None:
    """Nothing that the parent has open stays open here: pipes, locks of folders, files.

    The numbers stay taken, as objects that were copied may still use and close them. What parts
    print is no answer: it goes to stderr.
    """
    nothing = os.open(os.devnull, os.O_RDWR)
    for number in [int(entry.name) for entry in Path("/proc/self/fd").iterdir()]:
        if number not in {*kept, nothing, _STDERR}:
            standard = number <= _STDERR
            try:
                os.dup2(_STDERR if number == 1 else nothing, number, inheritable=standard)
            except OSError:  # of the listing itself
                continue
