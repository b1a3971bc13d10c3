"""What foreign FMUs log in a run that reaches its end."""

from collections.abc import Collection, Sequence

from herringbone.core import Outcome
from herringbone.core.names import cut
from herringbone.core.part import Part

_SHOWN, _LONGEST = 2, 200
"""Messages of a part; characters of one."""


def remarks_of(parts: Sequence[Part], foreign: Collection[str], outcome: Outcome) -> list[str]:
    """A line for each foreign part that has logged a warning or an error.

    Where a part ended the run, its outcome holds what it says.

    Args:
        parts: of the run.
        foreign: names of those that are foreign.
        outcome: of the run.
    """
    if not outcome.reached_end:
        return []
    said = {part.name: part.messages() for part in parts if part.name in foreign}
    return [f"{name} says: {_few(messages)}" for name, messages in said.items() if messages]


def _few(messages: Sequence[str]) -> str:
    """The first messages, and how many there are besides."""
    shown = (cut(message, _LONGEST) for message in messages[:_SHOWN])
    more = len(messages) - _SHOWN
    return "; ".join([*shown, *([f"and {more} more"] if more > 0 else [])])
