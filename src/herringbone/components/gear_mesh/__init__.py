r"""Herringbone gear pair: four half-bodies, two gap shafts, two meshes, 12 degrees of freedom.

**Bodies.** 1 pinion left, 2 pinion right, 3 wheel left, 4 wheel right; each moves along the line
of action (y), along the axis (z) and about it (theta). y points where the driving pinion flank
pushes the wheel; z from the right half to the left one; rotations are positive in driving sense, so
that a positive rotation of either gear moves its flank to +y. s = +1 left, -1 right; beta_b is the
base helix angle.

**Deflection** of the meshes, normal to the flank, compression positive:

    delta_L = cos(beta_b) (y1 - y3 + rb1 theta1 - rb2 theta3) + sin(beta_b) (z1 - z3 + eps_z)
    delta_R = cos(beta_b) (y2 - y4 + rb1 theta2 - rb2 theta4) - sin(beta_b) (z2 - z4 + eps_z)

    eps_z = f_A (c0 + c1 cos(theta1 + phi1) + c2 cos(theta3 + phi2))

f_A is the symmetry deviation: the axial offset of the chevron's apex, with a constant part and the
run-outs of pinion and wheel. It also shifts the contact lines by +-f_A tan(beta_b) / p_bt of a mesh
period. It is never inside the stiffness table.

**Normal force** from the force law F of the table (see `kernels.force_law`), with its tangent k:

    drive side, delta > 0:          N = max(0,  F(p, delta) + C g delta')
    open,   -backlash <= delta <= 0: N = 0
    coast side, e = -backlash - delta > 0:  N = min(0, -F(p, e) + C g delta')

    C = 2 zeta sqrt(k m_e),   m_e = 1 / (rb1^2 / I_pinion + rb2^2 / I_wheel)

This is the corrected form of the thesis' mesh damping, whose base radii are swapped; g rises
smoothly from 0 to 1 over `damping_transition`, so that no force jumps at contact. The phase p
counts mesh periods of the pinion's left half; the right half is ahead by `stagger`. An optional
meshing impact adds a raised-cosine pulse at the start of each mesh period, inside N, on the drive
side.

**Equations of motion** (virtual work; left pair 1-3, right pair 2-4; f, tau are the inputs):

    m y1'' = f_y1 - k_y (y1 - y2) - c_y (y1' - y2') - cos(beta_b) N_L       (wheel: + cos(beta_b) N)
    m z1'' = f_z1 - k_z (z1 - z2) - c_z (z1' - z2') - s sin(beta_b) N_L - restraint
    I theta1'' = share tau + k_t (theta2 - theta1) + c_t (theta2' - theta1') - rb1 cos(beta_b) N_L

`restraint` holds the pinion axially against ground, at the mean of its halves (0: it floats), and
`pinion_axial_drag` damps each half. States are the angle of body 1,
the twists theta2 - theta1 and theta4 - theta3, and rb1 theta1 - rb2 theta3 ("approach"), so that
precision does not decay with the number of revolutions. A flange moves with the mean of its two
halves, weighted by their torque shares: otherwise power would be created.

**Integration**: classical Runge-Kutta with `micro_step`. The default keeps the error of the bearing
forces below 1e-4 also when teeth separate. On the test rig, against micro steps of 0.3 us:

    micro step      2.5 us    3.3 us    5 us      10 us
    loaded teeth    3.7e-8    1.2e-7    5.9e-7    9.4e-6
    separation      5.8e-5    4.4e-5    1.7e-4    1.4e-4

**Limits.** Only the drive-side line of action is modelled: on coast contact the direction of the
separating force is wrong. No friction, no tilting of the bodies.

Sources: the thesis, chapter 3, with the corrections derived from virtual work. Geometry, masses,
shaft stiffnesses and the stiffness table are those of the pair in `gear_pair.toml`; `herringbone
gear` computes them, and those of other pairs.
"""

import inspect
import math

import numpy as np

from herringbone.components.gear_mesh import layout as at
from herringbone.components.gear_mesh import motion
from herringbone.components.gear_mesh.frozen import freeze_mesh
from herringbone.components.resources import stiffness_table
from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import Component, Kernels
from herringbone.kernels import force_law, steppers
from herringbone.kernels.jit import kernel

_CLOSED = 5e-6  # a usual deflection [m], where the search for an equilibrium begins


@kernel
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    """Turn the stiffness table into the force laws of both meshes."""
    for side in range(2):
        refusal, loads, phases = stiffness_table.collect(values, shape[0], side, s, report)
        if refusal:
            return refusal
        stiffness, scratch = s[stiffness_table.GRID :], s[stiffness_table.SCRATCH_SIZE :]
        table = at.TABLE[0] + side * force_law.TABLE_SIZE
        force_law.build(s[:loads], stiffness, phases, b, table, scratch)
    return 0


def _guess(block: np.ndarray) -> None:
    """Both meshes closed on the flank that carries, whatever the symmetry deviation."""
    closed = abs(block[at.F_A]) * math.tan(abs(block[at.BETA])) + _CLOSED
    if block[at.FLANK] < 0.0:
        closed = -closed - block[at.BACKLASH] / math.cos(block[at.BETA])
    block[at.APPROACH] = closed


_LOADER = ResourceLoader(
    at.DECLARATION.texts,
    _load,
    stiffness_table.REFUSALS,
    stiffness_table.SCRATCH_SIZE + force_law.SCRATCH_SIZE,
)

GEAR_MESH = Component(
    at.DECLARATION,
    Kernels(motion.step, motion.rhs, motion.out),
    f"{__doc__}\n# Force law\n\n{inspect.cleandoc(force_law.__doc__)}",
    load=_LOADER,
    guess=_guess,
    indicators=motion.indicators,
    indicator_count=4,
    longest_step=steppers.longest_step(at.DECLARATION, "micro_step"),
    freeze=freeze_mesh,
)
