"""Whether this process was asked to terminate (SIGTERM), and not only interrupted (Ctrl-C).

Who terminates a process waits some seconds before killing it: then it writes what would be lost,
and leaves what can be made later.
"""

from signal import SIGTERM

EXIT_CODE = 128 + SIGTERM
"""Of a command that was terminated, as shells tell it."""
_asked = [False]


def note_signal(number: int) -> None:
    """Keep it, if a signal asks to terminate."""
    _asked[0] |= number == SIGTERM


def is_terminating() -> bool:
    """True if it was asked for since `forget_signals`."""
    return _asked[0]


def forget_signals() -> None:
    """Begin anew, as a command does."""
    _asked[0] = False
