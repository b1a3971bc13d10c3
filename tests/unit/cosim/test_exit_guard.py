"""Guards against FMUs that end the process: several at a time, and each taken back alone."""

import os
from threading import Barrier, Thread

from herringbone.cosim.exit_guard import exit_guard


def test_a_guard_that_goes_leaves_the_others(monkeypatch):
    """Runs in two threads: the first to end is no call of exit(), while the other goes on."""
    ended = []
    monkeypatch.setattr(os, "_exit", ended.append)
    both, gone = Barrier(2, timeout=60.0), Barrier(2, timeout=60.0)

    def other():
        with exit_guard():
            both.wait()
            gone.wait()

    thread = Thread(target=other)
    thread.start()
    with exit_guard():
        both.wait()
    gone.wait()
    thread.join()
    with exit_guard(), exit_guard():
        pass
    assert not ended
