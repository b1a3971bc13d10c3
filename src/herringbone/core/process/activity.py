"""What takes long says so: one line on what it is, and on how long it usually takes.

The lines go to the logger `herringbone.activity`. A program that has set up logging gets them
there; otherwise they stand on stderr, in a terminal as in a notebook, above progress bars.
"""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import monotonic

from herringbone.core.caching.files import keep, kept
from herringbone.core.places.paths import cache_root
from herringbone.core.process.streams import write_line

A_WHILE = "this may take a while"
"""How long, where nothing is known."""
_PATIENCE = 2.0
"""Seconds for which nothing need be said."""
_MINUTE = 60.0
_AGAIN = 4.0
"""What is done in many pieces says how far it is whenever its time is so many times longer."""


def _is_set_up() -> bool:
    """True if the program has set up logging."""
    return bool(logging.getLogger().handlers)


class _Shown(logging.Handler):
    """Writes to stderr, as it is at the moment, unless the program has set up logging."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write a line."""
        if not _is_set_up():
            write_line(self.format(record))


_LOG = logging.getLogger("herringbone.activity")
_LOG.setLevel(logging.INFO)
_LOG.addHandler(_Shown())
_open = threading.local()


def _memory() -> Path:
    return cache_root() / "durations.json"


def _durations() -> dict[str, float]:
    """How long things took [s]; what cannot be read is not known."""
    return kept(_memory()) or {}


def _remember(what: str, seconds: float) -> None:
    known = _durations()
    if max(seconds, known.get(what, 0.0)) < _PATIENCE:
        return
    keep(_memory(), {**known, what: round(seconds, 2)})


class _Alarm:
    """Calls a function after some seconds, unless it is stopped before.

    The function returns after how many seconds it wants to be called again; None: not at all.
    """

    def __init__(self, seconds: float, ring: Callable[[], float | None]) -> None:
        self._stopped = threading.Event()
        self._ring = ring
        threading.Thread(target=self._wait, args=(seconds,), daemon=True).start()

    def _wait(self, seconds: float | None) -> None:
        while seconds is not None and not self._stopped.wait(seconds):
            seconds = self._ring()

    def stop(self) -> None:
        """It is over."""
        self._stopped.set()


class Pieces:
    """Something that is done in many short pieces, of which nobody knows how many will come.

    Args:
        what: such as "compiling kernels".
        note: how often it is done, such as "once".
    """

    def __init__(self, what: str, note: str) -> None:
        self._what, self._note = what, note
        self._done, self._spent, self._mark = 0, 0.0, _PATIENCE
        self._started: float | None = None
        self._most: float | None = None

    def spent(self) -> float:
        """Time of all pieces of this process [s]."""
        started = self._started
        return self._spent + (0.0 if started is None else monotonic() - started)

    @contextmanager
    def piece(self) -> Iterator[None]:
        """Do a piece; one inside of another is a part of it."""
        if self._started is not None:
            yield
            return
        self._started = monotonic()
        alarm = _Alarm(max(self._mark - self._spent, 0.0), self._say)
        try:
            yield
        finally:
            alarm.stop()
            self._spent, self._started = self.spent(), None
            self._done += 1
            self._keep()

    def _say(self) -> float | None:
        if self._most is None:
            self._most = _durations().get(self._what, 0.0)
        spent = self.spent()
        if spent >= self._mark:
            self._mark *= _AGAIN
            most = f"up to {self._most:.0f} s in all; " if self._most > spent else ""
            so_far = f"{self._done} in {spent:.0f} s so far"
            _LOG.info("%s: %s (%s%s)", self._what, so_far, most, self._note)
        return self._mark - spent

    def _keep(self) -> None:
        if self._spent > max(_PATIENCE, self._most or 0.0, _durations().get(self._what, 0.0)):
            _remember(self._what, self._spent)


COMPILING = Pieces("compiling kernels", "only the first time, and when their code has changed")


class _Activity:
    """One thing that is going on."""

    def __init__(self, what: str, note: str, takes: str, around: "_Activity | None") -> None:
        self._what, self._note, self._takes, self._around = what, note, takes, around
        self._usual = _durations().get(what)
        self._started, self._compiled = monotonic(), COMPILING.spent()
        self._said = False
        at_once = self._usual is not None and self._usual >= _PATIENCE
        self._wanted = 0.0 if at_once else _PATIENCE
        self._alarm = _Alarm(self._wanted, self._tell)

    def own(self) -> float:
        """How long it has been going on [s], without kernels that were compiled for it."""
        return monotonic() - self._started - (COMPILING.spent() - self._compiled)

    def told(self) -> bool:
        """True if it, or what it is a part of, has been said."""
        return self._said or (self._around is not None and self._around.told())

    def _tell(self) -> float | None:
        if (rest := self._wanted - self.own()) > 0.0:
            return rest
        if not self.told():
            self._said = True
            usual = f"usually {self._usual:.0f} s" if self._usual else self._takes
            _LOG.info("%s ... (%s%s)", self._what, usual, f"; {self._note}" if self._note else "")
        return None

    def end(self) -> None:
        """It is over."""
        self._alarm.stop()


@contextmanager
def activity(
    what: str, note: str = "", *, takes: str = A_WHILE, shown: bool = False
) -> Iterator[None]:
    """Do something that may take more than two seconds; if so, a line says it.

    The line comes at once if it took long the last time. What is inside of something that has been
    said is not said as well.

    Args:
        what: such as "building the FMU of NAME"; its duration is remembered by it.
        note: how often it is done, such as "once".
        takes: how long, where that is not remembered.
        shown: something else shows that it goes on, and nothing is said.
    """
    if shown:
        yield
        return
    around = getattr(_open, "activity", None)
    this = _Activity(what, note, takes, around)
    _open.activity = this
    try:
        yield
        _remember(what, this.own())
    finally:
        _open.activity = around
        this.end()


def tell(line: str) -> None:
    """Say at once what the user should know before something takes long."""
    _LOG.info("%s", line)


def lasting(seconds: float) -> str:
    """A duration with the unit that reads best."""
    if seconds < _MINUTE:
        return f"{seconds:.2g} s"
    if seconds < _MINUTE * _MINUTE:
        return f"{seconds / _MINUTE:.2g} min"
    return f"{seconds / _MINUTE / _MINUTE:.3g} h"
