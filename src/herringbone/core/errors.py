"""One tree of errors. A message names the place, the value with its unit, and what to do next."""


class HerringboneError(Exception):
    """Base of every error that the package raises on bad input; its message is one line.

    Args:
        message: what is wrong. It may quote text from files: what is not printable is escaped.
    """

    def __init__(self, message: str) -> None:
        super().__init__(one_line(message))


class ParameterError(HerringboneError):
    """A variable is unknown, missing, of the wrong type or outside its range."""


class ResourceError(HerringboneError):
    """A file that a component reads (table, modes, cycle) is missing or malformed."""


class StructureError(HerringboneError):
    """A system cannot be wired: unknown name, unit, direction, double source, algebraic loop."""


class EquilibriumError(HerringboneError):
    """A system has no steady rotation to start from, or none was found."""


class FmuError(HerringboneError):
    """An FMU cannot be read, loaded, instantiated or initialised."""


def reason(error: Exception) -> str:
    """Why a file could not be read or written, without its name, which the message already has."""
    return error.strerror if isinstance(error, OSError) and error.strerror else str(error)


def one_line(text: str) -> str:
    """A text in which nothing moves a terminal's cursor: what is not printable is escaped."""
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
