"""Progress of a run: told to the caller, or shown as a bar."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from herringbone.core.process.activity import activity
from herringbone.core.process.telling import Tell

if TYPE_CHECKING:
    from tqdm import tqdm

Progress = Callable[[float, float], None]
"""Called with the simulated time reached and its end [s]."""
_FORMAT = "{l_bar}{bar}| {n:.1f}/{total:.1f} ms simulated [{elapsed}<{remaining}]"


class Bar:
    """A bar of simulated milliseconds on the standard error stream.

    Args:
        always: also where that is no terminal, as in a notebook.
    """

    def __init__(self, *, always: bool) -> None:
        self._disable = False if always else None
        self._bar: tqdm | None = None

    def show(self, reached: float, t_end: float) -> None:
        """Move the bar to a simulated time [s]."""
        if self._bar is None:
            total = round(1e3 * t_end, 3)
            self._bar = self._made(total=total, unit="ms", bar_format=_FORMAT)
        self._bar.update(1e3 * reached - self._bar.n)

    def tell(self, text: str) -> None:
        """Show a line until the bar is closed."""
        self.close()
        self._bar = self._made(desc=text, bar_format="{desc}", leave=False)

    def _made(self, **options: Any) -> "tqdm":  # noqa: ANN401 (of tqdm)
        from tqdm import tqdm  # noqa: PLC0415 (many commands show none)

        return tqdm(disable=self._disable, **options)

    def close(self) -> None:
        """End the line."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextmanager
def told(progress: bool | Progress, what: str) -> Iterator[Progress | None]:
    """What a run calls inside: a bar for True; for False None, and a line says what takes long."""
    if not isinstance(progress, bool):
        yield progress
        return
    if not progress:
        with activity(what):
            yield None
        return
    bar = Bar(always=True)
    try:
        yield bar.show
    finally:
        bar.close()


@contextmanager
def counted(progress: bool | Tell | None, unit: str) -> Iterator[Tell]:
    """What is called inside with the name of each of many pieces.

    Args:
        progress: of the caller; True: a count of them, None: only in a terminal, False: nothing.
        unit: what they are.
    """
    if callable(progress):
        yield progress
        return
    from tqdm import tqdm  # noqa: PLC0415 (many callers show none)

    with tqdm(unit=f" {unit}", disable=None if progress is None else not progress) as bar:

        def show(name: str) -> None:
            bar.set_description(name, refresh=False)
            bar.update()

        yield show
