"""Pictures of entries, as PNG."""

from dataclasses import dataclass, field
from io import BytesIO

from herringbone.core import HerringboneError
from herringbone.thesis.working import Done

_DPI = 120


@dataclass(frozen=True)
class Shown:
    """An entry and its pictures.

    Attributes:
        done: the entry.
        pictures: PNG files by name.
        error: why the entry or its pictures failed; else "".
    """

    done: Done
    pictures: dict[str, bytes] = field(default_factory=dict)
    error: str = ""


def shown(done: Done) -> Shown:
    """Draw an entry; one that cannot be drawn says why."""
    from herringbone.plotting.style import styled  # noqa: PLC0415 (matplotlib: lazy)

    if done.outcome is None:
        return Shown(done, error=done.error)
    pictures = {}
    try:
        for name, figure in styled(done.entry.draw)(done.outcome.tables).items():
            file = BytesIO()
            figure.savefig(file, format="png", dpi=_DPI)
            pictures[name] = file.getvalue()
    except Exception as error:  # whatever it is: the other entries make a report
        why = str(error) if isinstance(error, HerringboneError) else repr(error)
        return Shown(done, pictures, f"its pictures failed: {why}")
    return Shown(done, pictures)
