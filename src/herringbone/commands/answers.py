"""Answers of commands that were found before, told without loading what found them."""

import argparse
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from herringbone.commands.output import say
from herringbone.core.process.telling import Tell
from herringbone.cosim.cell.policy import policy

_NOT_ASKED = frozenset({"command", "debug", "fresh", "json", "output"})
"""Options that decide how an answer is shown, or that none is known."""


class Told(NamedTuple):
    """An answer.

    Attributes:
        text: for people.
        summary: as JSON may hold it.
        again: it would be the same another time; False of FMUs that do not repeat.
    """

    text: str
    summary: Any
    again: bool = True


def answered(options: argparse.Namespace, find: Callable[[Tell], Told]) -> Told:
    """The answer to a command, if it was found before, else that which is found now.

    One with warnings, or with remarks on FMUs, is found again the next time.

    Args:
        options: of the command.
        find: finds it; what it raises is raised.
    """
    from herringbone.core.caching.answers import Answers  # noqa: PLC0415 (looks at all sources)

    asked = {k: v for k, v in sorted(vars(options).items()) if k not in _NOT_ASKED}
    answers = Answers(options.command.__module__, repr(asked))
    if (known := answers.known()) is not None:
        for line in known["said"]:
            say(line)
        return Told(known["text"], known["summary"])
    said: list[str] = []

    def tell(line: str) -> None:
        said.append(line)
        say(line)

    with answers.finding() as found, _warnings() as warned:
        told = find(tell)
        if told.again and not warned.count and not policy().remarks:
            found.answer = {"said": said, "text": told.text, "summary": told.summary}
    return told


class _Heard(logging.Handler):
    """Counts warnings of the library."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.count = 0

    def emit(self, record: logging.LogRecord) -> None:
        """One more."""
        del record
        self.count += 1


@contextmanager
def _warnings() -> Iterator[_Heard]:
    logger, heard = logging.getLogger("herringbone"), _Heard()
    logger.addHandler(heard)
    try:
        yield heard
    finally:
        logger.removeHandler(heard)
