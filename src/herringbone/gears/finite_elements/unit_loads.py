"""Unit loads at the stations of a flank, and measures of deflection at the depth behind them."""

import math

import numpy as np

from herringbone.gears.finite_elements.section import Section
from herringbone.gears.geometry.gear_pair import GearPair


def sweep_lead(pair: GearPair, gear: int) -> float:
    """Rotation of the sections over the face [rad/m], positive towards +x, the loaded flank.

    The driving flank of the pinion turns towards its outward normal, the driven flank of the wheel
    away from it: contact lines run to the pinion's tip with rising position on the face.
    """
    lead = math.tan(abs(pair.base_helix_angle)) / pair.base_radius[gear]
    return lead if gear == 0 else -lead


def unit_loads(
    pair: GearPair,
    gear: int,
    section: Section,
    unknowns: np.ndarray,
    path: np.ndarray,
    ahead: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Unit loads on the flank, and measures on the axes of this tooth and of those ahead.

    Shapes (n, stations) and (n, teeth stations).
    """
    points, profile = pair.path_of_contact, pair.tooth_profile(gear)
    reach = points.start + path
    reach = reach if gear == 0 else points.tangent_length - reach
    base, helix = pair.base_radius[gear], abs(pair.base_helix_angle)
    sense = 1 if gear == 0 else -1
    teeth = [sense * q for q in range(ahead + 1)]
    loads = np.zeros((unknowns.max() + 1, path.size))
    measures = np.zeros((unknowns.max() + 1, len(teeth), path.size))
    for i, distance in enumerate(reach):
        radius = math.hypot(base, distance)
        half_angle = profile.half_angle(radius)
        gamma = math.atan2(distance, base) - half_angle
        x, y = radius * math.sin(half_angle), radius * math.cos(half_angle)
        nodes, weights = _shape(section.points[1], section.flank, y)
        loads[unknowns[nodes], i] = np.outer(weights, _normal(gamma, helix, sense))
        for j, tooth in enumerate(teeth):
            turn = tooth * profile.pitch_angle
            radial = math.sin(turn) * section.points[0] + math.cos(turn) * section.points[1]
            nodes, weights = _shape(radial, section.axes[tooth], y - x * math.tan(gamma))
            normal = _normal(gamma - turn, helix, sense)
            measures[unknowns[nodes], j, i] = np.outer(weights, normal)
    return loads, measures.reshape(len(measures), -1)


def _normal(gamma: float, helix: float, sense: int) -> list[float]:
    """Outward normal of the flank."""
    return [
        math.cos(helix) * math.cos(gamma),
        math.cos(helix) * math.sin(gamma),
        -sense * math.sin(helix),
    ]


def _shape(y: np.ndarray, edges: np.ndarray, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of the edge that reaches a height, and their quadratic shape functions there."""
    edge = edges[np.clip(np.searchsorted(y[edges[:, 0]], height, "right") - 1, 0, len(edges) - 1)]
    first, middle, last = y[edge]
    a, b, c = 2.0 * (first - 2.0 * middle + last), 4.0 * middle - 3.0 * first - last, first - height
    at = -2.0 * c / (b + math.sqrt(b * b - 4.0 * a * c))
    return edge, np.array([(1.0 - at) * (1.0 - 2.0 * at), 4.0 * at * (1.0 - at), at * (2 * at - 1)])
