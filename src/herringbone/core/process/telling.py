"""What long work is told by while it goes on."""

from collections.abc import Callable

Tell = Callable[[str], None]
"""Called with a line on what is done now, or on how an answer came about."""


def untold(line: str) -> None:
    """Where nobody listens."""
