r"""Direct feedthrough from finite steps: Richardson extrapolation to a step of zero length.

An input that is changed by a from the start changes an output after a step h by

    r(h) = D + r_1 h + r_2 h^2 + O(h^3)                                       (times a)

D: direct feedthrough, r_1: of a rate, r_2: of a position. With h, h/2 and h/4,

    d_1 = 2 r(h/2) - r(h),   d_2 = 2 r(h/4) - r(h/2),   D = (4 d_2 - d_1) / 3 + O(h^3).

r_1 and r_2 drop out exactly. Where the response has a time constant near h, the estimates of h and
h/2 differ: D is unknown at this step, and shorter ones are tried. What answers much faster than h
passes directly, as far as a coupling with this step can tell.
r_1, by the same extrapolation of (r(h) - r(h/2)) / (h/2), tells whether a part integrates one of
its inputs into another one.

Of a part that takes steps of one length H only, h are 8 H, 4 H, 2 H, H, with the input held over
all. Its own integration in steps of H may show its states as they are before a step or after it, so
that D is known only as well as the extrapolated value and r(H) agree.
"""

from typing import NamedTuple

import numpy as np

HALVINGS = 4
"""Steps are h / 2^k, k = 0 ... HALVINGS - 1."""
SURE = 0.02
"""Difference of two estimates over the largest response, below which D is known; and last response
over the largest, below which there is none."""
NONE = 0.01
"""Share of the largest response below which what is left is no feedthrough."""
ALIKE = 0.05
"""Difference of D and of the response to one step, over the larger, of steps of one length."""
_LEAST = 1e-300
_JITTER = 1e-3
"""Responses over what rounding may hide, below which they are rounding; above, they are lost."""


class Response(NamedTuple):
    """Estimates of D, each (m,).

    Attributes:
        feedthrough: D; nan where it is unknown, 0 where there is none.
        slope: r_1 [1/s], times what D is of.
    """

    feedthrough: np.ndarray
    slope: np.ndarray


def extrapolated(responses: np.ndarray, floor: np.ndarray, step: float) -> Response:
    """D from responses at steps h / 2^k.

    Args:
        responses: (HALVINGS, m) changes of the outputs over that of the input.
        floor: (m,) responses that are rounding.
        step: h [s].
    """
    first = 2.0 * responses[1:] - responses[:-1]
    estimates = (4.0 * first[1:] - first[:-1]) / 3.0
    largest = np.maximum(np.abs(responses).max(axis=0), floor)
    last, before = estimates[-1], estimates[-2]
    apart = np.abs(last - before) / np.maximum(largest, _LEAST)
    none = np.abs(last) <= np.maximum(NONE * largest, floor)
    gone = np.abs(responses[-1]) <= np.maximum(SURE * largest, floor)
    found = np.where(none | gone, 0.0, last)
    seen = np.abs(responses).max(axis=0)
    lost = (seen > _JITTER * floor) & (seen <= floor)
    known = ((apart <= SURE) | gone) & ~lost
    lengths = step / 2.0 ** np.arange(1, len(responses))
    slopes = (responses[:-1] - responses[1:]) / lengths[:, None]
    return Response(np.where(known, found, np.nan), 2.0 * slopes[1] - slopes[0])


def of_one_length(found: Response, one: np.ndarray, floor: np.ndarray) -> Response:
    """What is known of a part that takes steps of one length only.

    Args:
        found: extrapolated from one step and more.
        one: (m,) responses to one step.
        floor: (m,) responses that are rounding.
    """
    value = found.feedthrough
    apart = np.abs(value - one) > ALIKE * np.maximum(np.abs(value), np.abs(one))
    known = np.where(apart & (value != 0.0), np.nan, value)
    return found._replace(feedthrough=np.where(np.abs(one) <= floor, 0.0, known))
