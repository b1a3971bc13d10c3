"""Figures of a run that several parts of a report ask for are computed once.

They are known by the content of what they follow from: a table may be changed in place.
"""

from collections.abc import Callable
from typing import TypeVar, cast

import numpy as np

from herringbone.core.caching.keys import digest_of
from herringbone.core.caching.remembered import Remembered

T = TypeVar("T")
_MOST = 64
_known: Remembered[object] = Remembered(_MOST)


def figure_of(find: Callable[[], T], *arguments: object) -> T:
    """What `find` returns, which nobody changes; if it is known, without asking again.

    Args:
        find: a function of the arguments alone.
        arguments: arrays count by their content, all else by its text; the first names the figure.
    """
    parts = (
        np.ascontiguousarray(a).tobytes() if isinstance(a, np.ndarray) else repr(a)
        for a in arguments
    )
    return cast("T", _known(digest_of(*parts), find))
