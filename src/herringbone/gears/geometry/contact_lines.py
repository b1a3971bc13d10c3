"""Contact lines of one half in the plane of action, cut into slices."""

import math

import numpy as np

from herringbone.gears.geometry.gear_pair import GearPair

_SPUR = 1e-9
"""Slices that lean less than this share of a base pitch touch at once over their width."""


def cut_lines(
    pair: GearPair, slices: int, phases: np.ndarray, low: float, high: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where the slices of all lines lie that reach between two limits of the path of contact.

    Args:
        pair: gear pair.
        slices: number of slices across the face.
        phases: (n,) mesh periods.
        low, high: limits, from the start of the path of contact [m].

    Returns:
        Middle of each slice's part between the limits, on path and face [m], and this part's share
        of the slice; each (n, lines * slices).
    """
    width = pair.face_width / slices
    slope = math.tan(abs(pair.base_helix_angle))
    pitch, across = pair.transverse_base_pitch, pair.face_width * slope
    lines = np.arange(math.floor(low / pitch) - 1, math.ceil((high + across) / pitch) + 1)
    face = np.arange(slices) * width
    begin = (np.asarray(phases)[:, None, None] + lines[None, :, None]) * pitch
    begin = begin + face * slope - across
    if slope * width < _SPUR * pitch:
        middle, share = begin, ((begin >= low) & (begin <= high)).astype(float)
        face = face + 0.5 * width + np.zeros_like(begin)
    else:
        first = np.clip(begin, low, max(low, high))
        last = np.clip(begin + slope * width, low, max(low, high))
        middle, share = 0.5 * (first + last), (last - first) / (slope * width)
        face = face + (middle - begin) / slope
    flat = (len(begin), -1)
    return middle.reshape(flat), face.reshape(flat), share.reshape(flat)
