"""Lumped values of a gear: mass and inertia of a half, stiffness of the shaft between the halves.

A half is a cylinder of the reference diameter and the face width, half of the gap's shaft, and a
shaft stub; a bore goes through gear and gap. The gap shaft reaches from mid plane to mid plane:
half a face width of the root diameter, the gap with its groove diameter, half a face width again.
It is in tension, in torsion, or bent between ends that do not tilt:

    1/k_z = sum L / (E A),    1/k_t = sum L / (G J),
    1/k_y = integral (x - L/2)^2 / (E I) + 1 / (0.9 G A) dx

with the shear coefficient 0.9 of a full circle, taken for bored sections as well.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.gears.geometry.gear_pair import GearPair

_SHEAR = 0.9


@dataclass(frozen=True)
class HalfBody:
    """One half of a gear.

    Attributes:
        mass: [kg].
        inertia: about the axis [kg m2].
    """

    mass: float
    inertia: float


@dataclass(frozen=True)
class GapShaft:
    """Shaft between the mid planes of both halves.

    Attributes:
        axial: tension [N/m].
        radial: bending and shear without tilt of the ends [N/m].
        torsional: [N m/rad].
    """

    axial: float
    radial: float
    torsional: float


def half_body(pair: "GearPair", gear: int) -> HalfBody:
    """Mass and inertia of one half of the pinion (0) or wheel (1)."""
    bore = pair.bore_diameter[gear]
    gap = 0.5 * pair.gap_width if pair.halves == 2 else 0.0
    mass = inertia = 0.0
    for outer, inner, length in (
        (2.0 * pair.reference_radius[gear], bore, pair.face_width),
        (pair.groove_diameter[gear], bore, gap),
        (pair.shaft_diameter[gear], 0.0, pair.stub_length[gear]),
    ):
        mass += pair.density * length * _area(outer, inner)
        inertia += pair.density * length * 2.0 * _second_moment(outer, inner)
    return HalfBody(mass, inertia)


def gap_shaft(pair: "GearPair", gear: int) -> GapShaft:
    """Stiffnesses of the gap shaft of the pinion (0) or wheel (1)."""
    if pair.halves != 2:
        raise ParameterError(f"a pair with halves = {pair.halves} has no gap shaft")
    bore = pair.bore_diameter[gear]
    half, gap = 0.5 * pair.face_width, pair.gap_width
    middle = half + 0.5 * gap
    segments = [
        (2.0 * pair.root_radius[gear], -middle, -0.5 * gap),
        (pair.groove_diameter[gear], -0.5 * gap, 0.5 * gap),
        (2.0 * pair.root_radius[gear], 0.5 * gap, middle),
    ]
    e = pair.youngs_modulus
    g = e / (2.0 * (1.0 + pair.poissons_ratio))
    axial = radial = torsional = 0.0
    for outer, begin, end in segments:
        area, moment = _area(outer, bore), _second_moment(outer, bore)
        axial += (end - begin) / (e * area)
        torsional += (end - begin) / (g * 2.0 * moment)
        radial += (end**3 - begin**3) / (3.0 * e * moment) + (end - begin) / (_SHEAR * g * area)
    return GapShaft(1.0 / axial, 1.0 / radial, 1.0 / torsional)


def _area(outer: float, inner: float) -> float:
    return 0.25 * math.pi * (outer**2 - inner**2)


def _second_moment(outer: float, inner: float) -> float:
    return math.pi / 64.0 * (outer**4 - inner**4)
