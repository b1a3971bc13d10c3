"""The gear pair with its meshes frozen at an operating point, as linear analysis takes it.

At the operating point each mesh has a normal force N, a depth d of the flanks that carry and, over
a mesh period, tangent stiffnesses. The frozen mesh keeps the operating point and has one stiffness
K:

    F(p, depth) = N + K (depth - d),    depth >= d / 2 - 15 um

so that the states at which the mesh was frozen are still an equilibrium. The axial offset of the
chevron's apex, the given transmission error and the reactions on what moved them stay at their
values; meshing impact and unbalance are off. Teeth that deviate become ideal ones, as deep in each
other as the deviating ones press in the mean; a constant error makes up for the difference.
"""

from collections.abc import Callable

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh.contact import meshes
from herringbone.components.gear_mesh.ramp import ramp
from herringbone.components.resources import tooth_deviations, transmission_error
from herringbone.core import Instance, ParameterError
from herringbone.core.declaring.roles import GEARS, SIDES
from herringbone.kernels import force_law

_LAST = force_law.DEFLECTIONS - 1
_DEEPER = 3e-5
"""By what flanks are deeper in each other than they are, with the same force, so that the line goes
on below no force [m]: parts may be far from equilibrium where a linear analysis steps them."""


def _carrying(gear: Instance) -> int:
    """0 if the drive flank carries, 1 if the coast flank does."""
    return 1 if gear["flank"] < 0.0 else 0


def _depth(gear: Instance, side: int) -> float:
    """Depth [m] of the flanks that carry; of those that deviate where they press."""
    if tooth_deviations.given(gear.block, at.DEVIATIONS, side, _carrying(gear)):
        return float(gear.block[at.PRESSED + 2 * side + _carrying(gear)])
    return _approach(gear, side)


def _approach(gear: Instance, side: int) -> float:
    """Depth [m] of ideal flanks."""
    deflection = gear[f"mesh_{SIDES[side]}.deflection"]
    return -gear["backlash"] - deflection if _carrying(gear) else deflection


def tangent_stiffness(gear: Instance, side: int) -> np.ndarray:
    """Tangent stiffness [N/m] of mesh 0 (left) or 1 (right) over a period, at its depth."""
    depth = _depth(gear, side)
    phases = np.arange(force_law.PHASES) / force_law.PHASES
    return np.array([force_law.law(gear.block, at.TABLE[side], p, depth)[1] for p in phases])


def freeze_mesh(gear: Instance, stiffness: Callable[[np.ndarray], float]) -> None:
    """Replace the force laws of a gear pair by straight lines through its operating point.

    Args:
        gear: at the operating point.
        stiffness: makes one stiffness [N/m] of the tangents over a mesh period.

    Raises:
        ParameterError: a mesh is open at the operating point.
    """
    offset, share = gear["axial_offset"], gear["symmetry_deviation"]
    index = gear.component.declaration.index
    for name in ("impact_force", *(f"{g}.unbalance" for g in GEARS)):
        gear.block[index[name]] = 0.0
    reactions = _reactions(gear)
    missing = [_approach(gear, side) - _depth(gear, side) - _DEEPER for side in range(2)]
    _ungate_damping(gear)
    for side, name in enumerate(SIDES):
        depth, force = _depth(gear, side), abs(gear[f"mesh_{name}.force"])
        if depth <= 0.0 or force <= 0.0:
            raise ParameterError(
                f"{gear.name}: the {name} mesh is open (deflection "
                f"{gear[f'mesh_{name}.deflection']:g} m) where stability is wanted; choose a scene "
                "that starts in equilibrium under load"
            )
        tangent = stiffness(tangent_stiffness(gear, side))
        _write_line(gear.block, at.TABLE[side], depth + _DEEPER, force, tangent)
    _hold_errors(gear, missing)
    gear.block[at.DEVIATIONS : at.DEVIATIONS + tooth_deviations.TABLE_SIZE] = 0.0
    gear.block[at.HELD : at.HELD + len(reactions)] = reactions
    gear.block[index["symmetry_pinion"]] = gear.block[index["symmetry_wheel"]] = 0.0
    gear.block[index["symmetry_constant"]] = offset / share if share else 0.0


def _ungate_damping(gear: Instance) -> None:
    """Damping as it is at the operating point, in the mean of both meshes, at any depth."""
    block = gear.block
    if block[at.GATE] == 0.0:
        return
    over = np.array(
        [min(1.0, max(0.0, _depth(gear, side)) / block[at.TRANSITION]) for side in (0, 1)]
    )
    block[at.ZETA] *= float(np.mean(over * over * (3.0 - 2.0 * over)))
    block[at.GATE] = 0.0


def _reactions(gear: Instance) -> list[float]:
    """dU/d(phase) [J] of both meshes, and the torques [N m] of what moves the flanks."""
    block = gear.block
    _, *forces = meshes(block)
    slopes = [
        (push - block[at.COS] * normal) / block[at.PER_PITCH]
        for normal, push in zip(forces[:2], forces[2:], strict=True)
    ]
    return [*slopes, *block[at.TORQUE : at.TORQUE + 4]]


def _hold_errors(gear: Instance, missing: list[float]) -> None:
    """Make a constant of the transmission error of each flank; add what the deviations take [m]."""
    share, _ = ramp(gear.block)
    pinion = gear["angle"]
    wheel = gear["pinion.base_radius"] * pinion - gear["approach"]
    wheel /= gear["wheel.base_radius"]
    for side in range(2):
        angles = pinion + side * gear["pinion_twist"], wheel + side * gear["wheel_twist"]
        for flank in range(2):
            group = transmission_error.group(at.ERRORS, side, flank)
            e = share * transmission_error.error(gear.block, group, *angles)[0]
            if flank == _carrying(gear):
                e += missing[side]
            if e != 0.0 or gear.block[group] > 0.0:
                gear.block[at.ERRORS] = 1.0
                gear.block[group : group + 5] = 1.0, 0.0, 0.0, e, 0.0
    gear.block[at.RAMP_TURNS] = 0.0


def _write_line(block: np.ndarray, first: int, depth: float, force: float, tangent: float) -> None:
    """Table part whose law above half the depth is a line; below, the secant is constant."""
    limit = 0.5 * depth
    secant = (force - tangent * (depth - limit)) / limit
    end = first + force_law.TABLE_SIZE
    block[first:end] = 0.0
    block[first], block[first + 1] = limit, 0.0
    nodes = block[first + 2 : end].reshape(force_law.PHASES, -1, force_law.NODE)
    nodes[:, :, 0] = secant
    nodes[:, _LAST, 2] = (tangent - secant) / (0.5 * _LAST)
