"""The end of a cell's process, and of what its FMU has started.

A cell has a process group of its own. The group has its number as long as the cell was not waited
for: until then it can be ended, and no other one is.
"""

import contextlib
import os
import select
import signal
import subprocess

_MILLISECONDS = 1e3


def is_child(process: "subprocess.Popen[bytes]") -> bool:
    """True if it is of this process, and was not waited for."""
    if process.returncode is not None:
        return False
    try:
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return False
    return True


def ends_within(watched: int, seconds: float) -> bool:
    """True if a process ends within a time [s], by a descriptor of it; it is not waited for."""
    poll = select.poll()
    poll.register(watched, select.POLLIN)
    return bool(poll.poll(_MILLISECONDS * seconds))


def end_group(process: "subprocess.Popen[bytes]") -> None:
    """Kill a process, if it runs, and its group; of no effect if it was waited for."""
    if is_child(process):
        with contextlib.suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL)
        process.kill()  # its FMU may have left the group
