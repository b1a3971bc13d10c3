"""Pictures of entries, as PNG."""

from dataclasses import dataclass, field
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from herringbone.core import HerringboneError
from herringbone.thesis.working import Done

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DPI = 100
_STEP = 8
"""Of the colours, of 255."""


def _png(figure: "Figure") -> bytes:
    """A figure whose colours are rounded to 33 levels: half of the bytes, and nobody sees it."""
    from PIL import Image  # noqa: PLC0415 (of matplotlib)

    drawn, file = BytesIO(), BytesIO()
    figure.savefig(drawn, format="png", dpi=_DPI)
    colours = np.asarray(Image.open(drawn).convert("RGB")).astype(int)
    rounded = np.minimum((colours + _STEP // 2) // _STEP * _STEP, 255).astype(np.uint8)
    Image.fromarray(rounded).save(file, format="png", optimize=True)
    return file.getvalue()


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
            pictures[name] = _png(figure)
    except Exception as error:  # whatever it is: the other entries make a report
        why = str(error) if isinstance(error, HerringboneError) else repr(error)
        return Shown(done, pictures, f"its pictures failed: {why}")
    return Shown(done, pictures)
