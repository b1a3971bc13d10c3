"""What an FMU logs, and whether it has failed for good."""

_FATAL = 4


class FmuLog:
    """Warnings and errors of one FMU.

    Attributes:
        fatal: the FMU reported a fatal error: FMI allows no further call, and pythonfmu crashes on
            one.
    """

    def __init__(self) -> None:
        self.fatal = False
        self._messages: list[str] = []

    def add(self, status: int, message: bytes | None) -> None:
        """Called by the FMU."""
        if status == _FATAL:
            self.fatal = True
        if status > 0 and message:
            self._messages.append(message.decode("utf-8", "replace").strip())

    def take(self) -> list[str]:
        """Messages since the last call, each on one line and once.

        A message that repeats another one inside it, as the FMU's runtime does, is left out.
        """
        found = list(dict.fromkeys(" ".join(message.split()) for message in self._messages))
        self._messages.clear()
        return [m for m in found if not any(other in m for other in found if other != m)]
