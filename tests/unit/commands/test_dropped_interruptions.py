"""Ctrl-C ends a command wherever it comes."""

import ctypes
import signal
import time
import weakref

import pytest

from herringbone.commands.output import terminable


def interrupt(*_: object) -> None:
    signal.raise_signal(signal.SIGINT)


class Destroyed:
    """Interrupted while it is destroyed."""

    def __del__(self) -> None:
        interrupt()


def called_from_c() -> None:
    ctypes.CFUNCTYPE(None)(interrupt)()


def collected() -> None:
    told = weakref.ref(type("Thing", (), {})(), interrupt)
    assert told() is None


@pytest.fixture(autouse=True)
def raising():
    """Interruptions raise, also where SIGINT is ignored from the start (`nohup`, `&`)."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize("dropping", [Destroyed, called_from_c, collected])
def test_what_python_drops_comes_again(dropping):
    """From a destructor, a function that C calls, and a callback nothing is raised."""
    with pytest.raises(KeyboardInterrupt), terminable():
        dropping()
        for _ in range(1000):  # ten seconds at the most
            time.sleep(0.01)


def test_handlers_are_given_back():
    before = signal.getsignal(signal.SIGALRM), signal.getsignal(signal.SIGTERM)
    with terminable():
        assert signal.getsignal(signal.SIGALRM) is not before[0]
    assert (signal.getsignal(signal.SIGALRM), signal.getsignal(signal.SIGTERM)) == before
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
