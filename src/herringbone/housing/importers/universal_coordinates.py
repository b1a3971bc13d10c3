"""Coordinate systems of universal files (data sets 18 and 2420): which are the global one."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

KINDS = {18, 2420}
_GLOBAL = {0, 1}
"""Labels by which programs mean the global coordinate system, unless a data set says otherwise."""
_DIGITS = 1e-6
_SAME = np.vstack([np.eye(3), np.zeros(3)])


def why_local(sets: Sequence[Mapping[str, Any]], label: int) -> str:
    """Why a label is not that of the global coordinate system; "" if it is.

    Args:
        sets: data sets of the file; others than coordinate systems are passed over.
        label: of the system.
    """
    if label not in _GLOBAL:
        return "which is none of the labels of the global one, 0 and 1"
    for item in sets:
        read = {18: _by_points, 2420: _by_matrix}.get(item["type"])
        systems = read(item) if read else {}
        if label in systems and not np.allclose(systems[label], _SAME, atol=_DIGITS):
            return f"which data set {item['type']} turns, moves, or gives other coordinates"
    return ""


def _by_matrix(item: Mapping[str, Any]) -> dict[int, np.ndarray]:
    """(4, 3) axes and origin by label, NaN of systems that are not Cartesian; of data set 2420."""
    found = zip(item["CS_sys_labels"], item["CS_types"], item["CS_matrices"], strict=True)
    return {
        int(label): np.asarray(matrix, float) if kind == 0 else np.full((4, 3), np.nan)
        for label, kind, matrix in found
    }


def _by_points(item: Mapping[str, Any]) -> dict[int, np.ndarray]:
    """As `_by_matrix`, from the origin, a point on x and one in the x-z plane; of data set 18.

    NaN, too, where these are given in another system than the global one, 0.
    """
    names = ("cs_num", "cs_type", "ref_cs_num", "ref_o", "x_point", "xz_point")
    found = {}
    rows = zip(*(item[name] for name in names), strict=True)
    for label, kind, reference, origin, on_x, in_xz in rows:
        x = (on_x - origin) / np.linalg.norm(on_x - origin)
        y = np.cross(in_xz - origin, x)
        y /= np.linalg.norm(y)
        axes = np.vstack([x, y, np.cross(x, y), origin])
        found[int(label)] = axes if kind == reference == 0 else np.full((4, 3), np.nan)
    return found
