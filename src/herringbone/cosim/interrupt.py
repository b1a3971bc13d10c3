"""Ctrl-C, or a request to terminate, while a compiled loop runs.

A KeyboardInterrupt raised inside a Python FMU would be fatal to it, so that the handler only sets a
flag, which is read between chunks of the loop.
"""

import signal
import threading
from types import FrameType

from herringbone.core.process.termination import note_signal

_SIGNALS = (signal.SIGINT, signal.SIGTERM)


class InterruptFlag:
    """Context in which SIGINT and SIGTERM set a flag; only in the main thread.

    A signal that a host in C handles itself is left to it: Python could not give it back.
    """

    def __init__(self) -> None:
        self.raised = False

    def __enter__(self) -> "InterruptFlag":
        self._main = threading.current_thread() is threading.main_thread()
        if self._main:
            own = [s for s in _SIGNALS if signal.getsignal(s) is not None]
            self._before = {s: signal.signal(s, self._set) for s in own}
        return self

    def _set(self, number: int, frame: FrameType | None) -> None:
        del frame
        note_signal(number)
        self.raised = True

    def __exit__(self, *exception: object) -> None:
        if self._main:
            for number, before in self._before.items():
                signal.signal(number, before)
