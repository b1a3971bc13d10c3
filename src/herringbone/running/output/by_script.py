"""The results folder of a run that a script asks for by its path."""

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from herringbone.core import ParameterError
from herringbone.result.result import Result
from herringbone.running.output.run_output import RunOutput

Recorded = Callable[[Result], None] | None
"""Called with the result as soon as a run has ended, see `running.api.run`."""


class Place(NamedTuple):
    """Where the rows of a run go.

    Attributes:
        output: the folder; None: nowhere.
        recorded: to be called when the run has ended.
        complete: what makes of the result the one that is returned.
    """

    output: RunOutput | None
    recorded: Recorded
    complete: Callable[[Result], Result]


@contextmanager
def placed(
    output: str | PathLike[str] | RunOutput | None, recorded: Recorded, *, overwrite: bool
) -> Iterator[Place]:
    """A folder by its path is written here; one that the caller keeps is left to him.

    Args:
        output, recorded, overwrite: see `running.api.run`.

    Raises:
        HerringboneError: another run is there, or the folder cannot be written.
    """
    if output is None or isinstance(output, RunOutput):
        yield Place(output, recorded, lambda result: result)
        return
    if not isinstance(output, str | PathLike):
        raise ParameterError(f"output = {output!r:.60}: it takes the path of a folder")
    own = RunOutput(Path(output), overwrite=overwrite, pictures=False)

    def written(result: Result) -> None:
        own.write(result)
        if recorded is not None:
            recorded(result)

    with closing(own), own.explaining():
        yield Place(own, written, own.complete)
