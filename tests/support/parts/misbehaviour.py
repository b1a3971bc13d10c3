"""What a step of a `Mass` may do instead of what it should."""

import math
import time

from support.parts.fakes import ERROR, OK


def fail_at(when, status=ERROR):
    """Misbehaviour: refuse the step that ends at `when`."""
    return lambda part, t: status if t > when - 1e-9 else OK


def spoil_at(when, value=math.nan, output="flange.v"):
    """Misbehaviour: an output that is not finite from `when` on."""

    def spoil(part, t):
        if t > when - 1e-9:
            part[output] = value
        return OK

    return spoil


def dawdle(seconds):
    """Misbehaviour: sleep in every step."""

    def sleep(part, t):
        time.sleep(seconds)
        return OK

    return sleep
