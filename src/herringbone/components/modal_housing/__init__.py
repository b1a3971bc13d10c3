"""Housing as oscillators: modes with shapes at the four bearing seats.

    q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i = sum over seats s and axes d of  shape_i(s, d) f(s, d)
    s(s, d) = sum_i shape_i(s, d) q_i,   v(s, d) = sum_i shape_i(s, d) q_i'

Shapes are mass-normalised [kg^-1/2]. f is the force on the housing. Each oscillator is propagated
exactly for forces that are polynomials over the macro step (see `kernels.modal`), for any step.
Positions and velocities never depend on the inputs directly; the accelerations do.

`start.<seat>.f_x` ... are the forces under which the housing is at rest at the start, with
q_i = sum of shape_i f / w_i^2 (rigid modes: 0).

In model exchange the modal coordinates q[i] are continuous states: as many as the data have with
which the FMU was built. With other data of another number of modes, such an instance is refused;
co-simulation takes any data.

Modes of kind "residual" are pseudo modes that make the static compliance at the seats exact;
"rigid" modes have no stiffness. The data that come along are described in HOUSING.md.

The seats are about as soft as the bearings, so the coupling has to go both ways. On the test rig
(scene loaded, steady rotation), the motion of the seats changes the vibration of the bearing forces
(rms about the mean) by a factor of 0.676 radially at the pinion, 2.05 radially and 9.18 axially at
the wheel, against bearings on rigid ground whose forces only drive the housing. On rigid ground the
wheel on its axial bearing has its mode at 305.0 Hz, the housing alone its lowest at 249.3 Hz;
coupled, the lowest mode of both lies at 170.1 Hz. The torsional mode of drive motor and coupling
hardly changes: from 174.1 to 173.3 Hz.

Source: K. S. Bathe, Finite Element Procedures, section 9.3 (mode superposition).
"""

import math

import numpy as np

from herringbone.components.modal_housing import layout as at
from herringbone.components.modal_housing.motion import count, out, rhs, start, write_motion
from herringbone.components.modal_housing.stepping import SLOWEST, longest_step, step
from herringbone.components.resources import modal_data
from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import Component, Kernels
from herringbone.kernels.compiling.jit import seldom

_USUAL_FORCE = 1e3
"""Force [N] along each degree of freedom, for the usual sizes of the modal coordinates."""
_SMALLEST_SHAPE = 1e-6
"""What modes count as, among these, that do not move the seats [kg^-1/2]."""
_WANTED = modal_data.wanted_rows(at.DOFS)


@seldom
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    refusal = modal_data.collect(values, shape, _WANTED, at.MODES, b, at.COUNT, report)
    if refusal == 0:
        for i in range(count(b)):
            b[at.OMEGA + i] *= 2.0 * math.pi
    return refusal


_LOADER = ResourceLoader(
    at.DECLARATION.texts, _load, modal_data.refusals(at.DOFS, at.MODES), scratch=1
)


def _nominals(b: np.ndarray) -> np.ndarray:
    """Deflections under the usual force at all seats, and their rates at the natural frequency."""
    omega = np.maximum(b[at.OMEGA : at.OMEGA + at.MODES], SLOWEST)
    shapes = b[at.SHAPES : at.SHAPES + at.DOF_COUNT * at.MODES].reshape(at.DOF_COUNT, at.MODES)
    force = _USUAL_FORCE * np.maximum(np.linalg.norm(shapes, axis=0), _SMALLEST_SHAPE)
    return np.concatenate([force / omega**2, force / omega])


MODAL_HOUSING = Component(
    at.DECLARATION,
    Kernels(step, rhs, out),
    __doc__,
    load=_LOADER,
    start=start,
    motion=write_motion,
    nominals=_nominals,
    longest_step=longest_step,
)
