"""Housing as oscillators: modes with shapes at the four bearing seats.

    q_i'' + 2 zeta_i w_i q_i' + w_i^2 q_i = sum over seats s and axes d of  shape_i(s, d) f(s, d)
    s(s, d) = sum_i shape_i(s, d) q_i,   v(s, d) = sum_i shape_i(s, d) q_i'

Shapes are mass-normalised [kg^-1/2]. f is the force on the housing. Each oscillator is propagated
exactly for forces that are polynomials over the macro step (see `kernels.modal`), for any step.
Positions and velocities never depend on the inputs directly; the accelerations do.

`start.<seat>.f_x` ... are the forces under which the housing is at rest at the start.

Modes of kind "residual" are pseudo modes that make the static compliance at the seats exact;
"rigid" modes have no stiffness. The data that come along are described in HOUSING.md.

The seats are about as soft as the bearings, so the coupling has to go both ways. On the test rig
(scene loaded), the motion of the seats changes the vibration of the bearing forces (rms about the
mean) by a factor of 0.68 radially at the pinion, 2.77 radially and 5.94 axially at the wheel,
against bearings on rigid ground whose forces only drive the housing. Below 300 Hz, the structural
modes of the rig on rigid ground and of the housing alone lie at 174.1 and 249.3 Hz; coupled, they
lie at 170.1 and 173.3 Hz.

Source: K. S. Bathe, Finite Element Procedures, section 9.3 (mode superposition).
"""

import math

import numpy as np

from herringbone.components import modal_data
from herringbone.components.ports import HALVES
from herringbone.components.resource_loader import ResourceLoader
from herringbone.core import (
    Component,
    Declaration,
    Kernels,
    Text,
    Variable,
    input_,
    output,
    parameter,
)
from herringbone.kernels import modal
from herringbone.kernels.jit import kernel
from herringbone.kernels.signals import STRIDE, all_finite, monomial, shift, store_node
from herringbone.kernels.steppers import NOT_FINITE

MODES = 64
"""Most modes that the component takes."""
_DOFS = tuple((seat, axis) for seat in HALVES for axis in "xyz")
_N = len(_DOFS)
_FORCES = tuple(f"{seat}.f_{axis}" for seat, axis in _DOFS)


def _port(seat: str, axis: str) -> list[Variable]:
    at = f"of {seat} along {axis}"
    return [
        input_(f"{seat}.f_{axis}", "N", f"force on the housing at {seat} along {axis}"),
        output(f"{seat}.s_{axis}", "m", f"position {at}", nodes=True),
        output(f"{seat}.v_{axis}", "m/s", f"velocity {at}", nodes=True),
        output(f"{seat}.a_{axis}", "m/s2", f"acceleration {at}", feedthrough=_FORCES),
        parameter(f"start.{seat}.f_{axis}", "N", "force under which the start is at rest", 0.0),
    ]


# Tables: number of modes, angular frequency, damping ratio, shapes by mode.
_TABLE_SIZE = 1 + MODES * (2 + _N)
STEPS = 24
"""Steps whose propagators are kept, for masters that come back to a step."""
# Work: slots filled so far, step of each slot, slots of propagators, scratch, polynomial forces.
_FILLED, _STEP_OF = 0, 1
_PROPAGATORS = _STEP_OF + STEPS
_SLOT = MODES * modal.PROPAGATOR
_SCRATCH = _PROPAGATORS + STEPS * _SLOT
_POLYNOMIALS = _SCRATCH + modal.SCRATCH_SIZE
_MODAL_FORCE = _POLYNOMIALS + _N * STRIDE
_WORK = _MODAL_FORCE + STRIDE

_d = Declaration(
    "modal_housing",
    "Gearbox housing as oscillators with shapes at the four bearing seats",
    [v for seat, axis in _DOFS for v in _port(seat, axis)],
    texts=[
        Text("modes", "frequencies and damping, CSV", "modes.csv", modal_data.MODE_COLUMNS),
        Text(
            "shapes",
            "mass-normalised shapes at the seats, CSV",
            "shapes.csv",
            modal_data.shape_columns(_DOFS),
        ),
    ],
    hidden_states=2 * MODES,
    tables=_TABLE_SIZE,
    work=_WORK,
)

_F, _START = _d.indices(*_FORCES), _d.indices(*(f"start.{name}" for name in _FORCES))
_S, _V, _A = (_d.indices(*(f"{seat}.{q}_{axis}" for seat, axis in _DOFS)) for q in "sva")
_FIRST_INPUT, _FIRST_OUTPUT, _OUTPUTS = _d.first_input, _d.first_output, len(_d.node_outputs)
_DEGREE = _d.index["interface_degree"]
_COUNT = _d.first_table
_OMEGA = _COUNT + 1
_ZETA = _OMEGA + MODES
_SHAPES = _ZETA + MODES


@kernel
def _force(b: np.ndarray, mode: int) -> float:
    """Modal force at the present inputs."""
    total = 0.0
    for k in range(_N):
        total += b[_SHAPES + mode * _N + k] * b[_F[k]]
    return total


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    count = int(b[_COUNT])
    for i in range(MODES):
        dx[i] = b[MODES + i]
        dx[MODES + i] = 0.0
    for i in range(count):
        w = b[_OMEGA + i]
        dx[MODES + i] = _force(b, i) - w * (2.0 * b[_ZETA + i] * b[MODES + i] + w * b[i])


@kernel
def _motion(b: np.ndarray) -> None:
    """Write positions and velocities of the seats."""
    for k in range(_N):
        b[_S[k]] = b[_V[k]] = 0.0
    for i in range(int(b[_COUNT])):
        row = _SHAPES + i * _N
        for k in range(_N):
            b[_S[k]] += b[row + k] * b[i]
            b[_V[k]] += b[row + k] * b[MODES + i]


@kernel
def _out(b: np.ndarray, t: float) -> None:
    _motion(b)
    for k in range(_N):
        b[_A[k]] = 0.0
    for i in range(int(b[_COUNT])):
        w = b[_OMEGA + i]
        a = _force(b, i) - w * (2.0 * b[_ZETA + i] * b[MODES + i] + w * b[i])
        for k in range(_N):
            b[_A[k]] += b[_SHAPES + i * _N + k] * a


@kernel
def _propagators(b: np.ndarray, w: np.ndarray, h: float) -> int:
    """Place in the work space of the propagators of a step; the oldest ones make room."""
    filled = int(w[_FILLED])
    for k in range(min(filled, STEPS)):
        if w[_STEP_OF + k] == h:
            return _PROPAGATORS + k * _SLOT
    slot = filled % STEPS
    scratch = w[_SCRATCH:_POLYNOMIALS]
    for i in range(int(b[_COUNT])):
        at = _PROPAGATORS + slot * _SLOT + i * modal.PROPAGATOR
        modal.propagator(b[_OMEGA + i], b[_ZETA + i], h, w, at, scratch)
    w[_STEP_OF + slot], w[_FILLED] = h, filled + 1.0
    return _PROPAGATORS + slot * _SLOT


@kernel
def _propagate(b: np.ndarray, w: np.ndarray, propagators: int, degree: int) -> None:
    """Advance all modes by the step of the propagators, under the forces in the work space."""
    for i in range(int(b[_COUNT])):
        at = propagators + i * modal.PROPAGATOR
        q = w[at] * b[i] + w[at + 1] * b[MODES + i]
        v = w[at + 2] * b[i] + w[at + 3] * b[MODES + i]
        for j in range(degree + 1):
            force = 0.0
            for k in range(_N):
                force += b[_SHAPES + i * _N + k] * w[_POLYNOMIALS + k * STRIDE + j]
            q += w[at + 4 + 2 * j] * force
            v += w[at + 5 + 2 * j] * force
        b[i], b[MODES + i] = q, v


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    degree = int(b[_DEGREE])
    intervals = max(degree, 1)
    propagators = _propagators(b, w, h / intervals)
    for node in range(1, intervals + 1):
        for k in range(_N):
            at = _POLYNOMIALS + k * STRIDE
            monomial(b, _F[k], degree, w, at)
            shift(w, at, degree, (node - 1.0) / intervals, 1.0 / intervals)
        _propagate(b, w, propagators, degree)
        if node < intervals:
            _motion(b)
            store_node(b, _FIRST_OUTPUT, _OUTPUTS, node)
    for k in range(_N):
        w[_POLYNOMIALS + k] = b[_F[k]]
        b[_F[k]] = b[_F[k] + degree]
    _out(b, t + h)
    store_node(b, _FIRST_OUTPUT, _OUTPUTS, intervals)
    for k in range(_N):
        b[_F[k]] = w[_POLYNOMIALS + k]
    return 0 if all_finite(b, 0, 2 * MODES) else NOT_FINITE


@kernel
def _start(b: np.ndarray) -> None:
    """Static deflection under the start forces; rigid modes stay at zero."""
    for i in range(2 * MODES):
        b[i] = 0.0
    for i in range(int(b[_COUNT])):
        w = b[_OMEGA + i]
        if w > 0.0:
            force = 0.0
            for k in range(_N):
                force += b[_SHAPES + i * _N + k] * b[_START[k]]
            b[i] = force / (w * w)


_WANTED = modal_data.wanted_rows(_DOFS)


@kernel
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    refusal = modal_data.collect(values, shape, _WANTED, MODES, b, _COUNT, report)
    if refusal == 0:
        for i in range(int(b[_COUNT])):
            b[_OMEGA + i] *= 2.0 * math.pi
    return refusal


_LOADER = ResourceLoader(_d.texts, _load, modal_data.refusals(_DOFS, MODES), scratch=1)

MODAL_HOUSING = Component(_d, Kernels(_step, _rhs, _out), __doc__, load=_LOADER, start=_start)
