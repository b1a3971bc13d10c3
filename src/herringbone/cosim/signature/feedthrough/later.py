"""Direct feedthrough a few steps after the start, where all inputs have moved: is it the same?

At the start products of inputs or states may vanish, and laws that are not linear have one slope of
many. After some steps on moved inputs each input is changed for a last, short step of two lengths;
what does not fall with the length passes directly. Of a part that takes steps of one length only
these are four of them and one.
"""

import numpy as np

from herringbone.cosim.signature.amplitudes import unlike
from herringbone.cosim.signature.feedthrough.at_start import ROUNDING
from herringbone.cosim.signature.laboratory import Laboratory

_LEAD = 8
_MOVED = 64.0
_SHORTER = (4.0, 16.0)
_DIRECT = 0.4
"""Difference of the responses to both short steps over the last; 3 and more for states."""


def later_feedthrough(lab: Laboratory, changes: np.ndarray) -> np.ndarray:
    """(m, n) what passes directly there, 0 where nothing does; raises Refused."""
    moved = lab.start + _MOVED * unlike(changes)
    found = np.zeros((len(lab.outputs), len(lab.inputs)))
    shorter = _SHORTER if not lab.grain else (_SHORTER[0] / _SHORTER[1], 1.0)
    lengths = [lab.step / share for share in shorter]
    rests = [lab.after([moved] * _LEAD, moved, h) for h in lengths]
    for number, change in enumerate(changes):
        changed = moved.copy()
        changed[number] += change
        long, short = (
            lab.after([moved] * _LEAD, changed, h) - rest
            for h, rest in zip(lengths, rests, strict=True)
        )
        floor = ROUNDING * np.maximum(np.abs(rests[0]), np.abs(long))
        direct = (np.abs(short) > floor) & (np.abs(short - long) < _DIRECT * np.abs(short))
        found[:, number] = np.where(direct, short / change, 0.0)
    return found
