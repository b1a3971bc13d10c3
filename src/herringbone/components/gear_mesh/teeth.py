"""Contact of a flank whose teeth deviate: the sum over all pairs of teeth that touch."""

import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.resources import tooth_deviations
from herringbone.kernels import tooth_pair_law
from herringbone.kernels.compiling.jit import kernel, rare


@kernel
def _material(b: np.ndarray, side: int, flank: int, number: float) -> tuple[float, float, float]:
    """Position, profile and helix [m] of both teeth of the pair that enters as the number-th."""
    pinion = tooth_deviations.tooth(
        b, tooth_deviations.group(at.DEVIATIONS, side, flank, 0), number
    )
    gear = tooth_deviations.tooth(b, tooth_deviations.group(at.DEVIATIONS, side, flank, 1), number)
    return b[pinion] + b[gear], b[pinion + 1] - b[gear + 1], b[pinion + 2] + b[gear + 2]


@rare
def toothed(
    b: np.ndarray, side: int, flank: int, phase: float, depth: float, ramp: float
) -> tuple[float, float, float, float, float, float]:
    """Elastic contact of a flank whose teeth deviate.

    Args:
        b: block.
        side, flank: whose it is.
        phase: of the flank [mesh periods].
        depth: of ideal teeth [m].
        ramp: factor of the deviations.

    Returns:
        Force [N], tangent stiffness [N/m], dU/d(phase) and dU/d(ramp) [J], the mean depth where
        teeth press, weighted by the pressure [m], and the energy U [J].
    """
    law = at.LAW[0] + side * tooth_pair_law.TABLE_SIZE
    transverse, overlap = b[at.TRANSVERSE], b[at.OVERLAP]
    force, tangent, of_phase, of_ramp, weighted, energy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    newest = math.floor(phase - b[law] / b[law + 1])
    for k in range(int(b[law + 2] / b[law + 1]) + 1):
        q = phase - (newest - k)
        i, f, m, h, m_q, h_q = tooth_pair_law.line(b, law, q)
        if i >= 0:
            position, profile, helix = _material(b, side, flank, newest - k)
            lean = profile * overlap / transverse + helix
            along = (q - overlap * (1.0 - m)) / transverse - 0.5
            beyond = position + profile * along + helix * (m - 0.5)
            x, y = depth + ramp * beyond, ramp * h * lean
            if tooth_pair_law.touches(x, y):
                per_x, stiffness, per_y, per_q, stored = tooth_pair_law.law(b, law, i, f, x, y)
                x_q = profile / transverse + lean * m_q
                force += per_x
                tangent += stiffness
                of_phase += per_q + ramp * (per_x * x_q + per_y * lean * h_q)
                of_ramp += per_x * beyond + per_y * h * lean
                weighted += per_x * x + per_y * y
                energy += stored
    mean = weighted / force if force > 0.0 else 0.0
    return force, tangent, of_phase, of_ramp, mean, energy
