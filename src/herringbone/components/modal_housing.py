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
(scene loaded), the motion of the seats changes the vibration of the bearing forces (rms about the
mean) by a factor of 0.68 radially at the pinion, 2.08 radially and 9.29 axially at the wheel,
against bearings on rigid ground whose forces only drive the housing. Below 300 Hz, the structural
modes of the rig on rigid ground and of the housing alone lie at 174.1 and 249.3 Hz; coupled, they
lie at 170.1 and 173.3 Hz.

Source: K. S. Bathe, Finite Element Procedures, section 9.3 (mode superposition).
"""

import math

import numpy as np

from herringbone.components.ports import HALVES, seats
from herringbone.components.resources import modal_data
from herringbone.components.resources.loader import ResourceLoader
from herringbone.core import (
    Component,
    Declaration,
    Kernels,
    StateVector,
    Text,
    Variable,
    input_,
    output,
    parameter,
)
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import modal
from herringbone.kernels.compiling.jit import kernel, seldom
from herringbone.kernels.signals import STRIDE, all_finite, monomial, shift, store_node
from herringbone.kernels.steppers import NOT_FINITE, TOO_LONG

MODES = 64
"""Most modes that the component takes."""
_USUAL_FORCE = 1e3
"""Force [N] along each degree of freedom, for the usual sizes of the modal coordinates."""
_LONGEST_STEP = 1e6
"""Longest step [s] of a housing whose modes would all take more."""
_SLOWEST, _SMALLEST_SHAPE = 2.0 * math.pi * 10.0, 1e-6
"""What rigid modes [rad/s], and modes that do not move the seats [kg^-1/2], count as there."""
_DOFS = tuple((seat, axis) for seat in HALVES for axis in "xyz")
_N = len(_DOFS)
_AXES = 3
_SEATS = _N // _AXES
_FORCES = tuple(f"{seat}.f_{axis}" for seat, axis in _DOFS)


def _port(seat: str, axis: str) -> list[Variable]:
    at = f"of {seat} along {axis}"
    force, s, v, a = (f"{seat}.{q}_{axis}" for q in "fsva")
    return [
        input_(force, "N", f"force on the housing at {seat} along {axis}"),
        output(s, "m", f"position {at}", nodes=True, rate=v),
        output(v, "m/s", f"velocity {at}", nodes=True, rate=a),
        output(a, "m/s2", f"acceleration {at}", feedthrough=_FORCES),
        parameter(
            f"start.{force}", "N", "force under which the start is at rest", 0.0, at_rest=force
        ),
    ]


# Tables: number of modes, angular frequency, damping ratio, shapes by dof, modal accelerations,
# partial sums of a degree of freedom.
_PARTIAL = 8
_TABLE_SIZE = 1 + MODES * (2 + _N + 1) + _PARTIAL
STEPS = 24
"""Steps whose propagators are kept, for masters that come back to a step."""
# Work: slots filled so far, step of each slot, slots of propagators (by entry, then by mode), room
# for one propagator and for its making, polynomial forces by dof, the same by mode.
_FILLED, _STEP_OF = 0, 1
_PROPAGATORS = _STEP_OF + STEPS
_SLOT = MODES * modal.PROPAGATOR
_ONE = _PROPAGATORS + STEPS * _SLOT
_SCRATCH = _ONE + modal.PROPAGATOR
_POLYNOMIALS = _SCRATCH + modal.SCRATCH_SIZE
_MODAL = _POLYNOMIALS + _N * STRIDE
_WORK = _MODAL + modal.DEGREES * MODES

_d = Declaration(
    "modal_housing",
    "Gearbox housing as oscillators with shapes at the four bearing seats",
    [v for seat, axis in _DOFS for v in _port(seat, axis)],
    texts=[
        Text(
            "modes",
            "frequencies and damping, CSV",
            "modes.csv",
            modal_data.MODE_COLUMNS,
            Quantity.MODES,
        ),
        Text(
            "shapes",
            "mass-normalised shapes at the seats, CSV",
            "shapes.csv",
            modal_data.shape_columns(_DOFS),
            Quantity.SHAPES,
        ),
    ],
    vectors=[
        StateVector(name, unit, f"modal {what}", MODES, "modes", "modes")
        for name, unit, what in (
            ("q", "kg^1/2.m", "coordinate"),
            ("der(q)", "kg^1/2.m/s", "velocity"),
        )
    ],
    tables=_TABLE_SIZE,
    work=_WORK,
    roles=[Role.HOUSING],
    ports=seats(),
)

_START = _d.index[f"start.{_FORCES[0]}"]
_S, _V, _A = (_d.index[f"{_DOFS[0][0]}.{q}_{_DOFS[0][1]}"] for q in "sva")
"""Motion of the first degree of freedom; the next ones follow, 2 STRIDE apart, accelerations 1."""
_FIRST_INPUT, _FIRST_OUTPUT, _OUTPUTS = _d.first_input, _d.first_output, len(_d.node_outputs)
_DEGREE = _d.index["interface_degree"]
_COUNT = _d.first_table
_OMEGA = _COUNT + 1
_ZETA = _OMEGA + MODES
_SHAPES = _ZETA + MODES
_ACCELERATIONS = _SHAPES + _N * MODES
_SUMS = _ACCELERATIONS + MODES


@kernel
def _count(b: np.ndarray) -> int:
    """Number of modes; with the bound, the compiler sees that no index is negative."""
    return min(int(b[_COUNT]), MODES)


@kernel
def _modal_force(b: np.ndarray, mode: int, forces: np.ndarray, stride: int) -> float:
    """Force on a mode, under forces at the seats that lie `stride` apart."""
    total = 0.0
    for k in range(_N):
        total += b[_SHAPES + k * MODES + mode] * forces[k * stride]
    return total


@kernel
def _acceleration(b: np.ndarray, mode: int, force: float) -> float:
    w = b[_OMEGA + mode]
    return force - w * (2.0 * b[_ZETA + mode] * b[MODES + mode] + w * b[mode])


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    for i in range(MODES):
        dx[i] = b[MODES + i]
        dx[MODES + i] = 0.0
    forces = b[_FIRST_INPUT:_FIRST_OUTPUT]
    for i in range(_count(b)):
        dx[MODES + i] = _acceleration(b, i, _modal_force(b, i, forces, STRIDE))


@kernel
def _motion(b: np.ndarray) -> None:
    """Write position and velocity of the seats from those of the modes.

    Every fourth mode is summed apart, so that additions go side by side. The sums are then stored,
    which lets the compiler keep them together in the loop.
    """
    sums = b[_SUMS : _SUMS + _PARTIAL]
    fours = (_count(b) + 3) // 4
    for k in range(_N):
        row = b[_SHAPES + k * MODES : _SHAPES + (k + 1) * MODES]
        s_0, s_1, s_2, s_3 = 0.0, 0.0, 0.0, 0.0
        v_0, v_1, v_2, v_3 = 0.0, 0.0, 0.0, 0.0
        for four in range(fours):
            i = 4 * four
            s_0 += row[i] * b[i]
            s_1 += row[i + 1] * b[i + 1]
            s_2 += row[i + 2] * b[i + 2]
            s_3 += row[i + 3] * b[i + 3]
            v_0 += row[i] * b[MODES + i]
            v_1 += row[i + 1] * b[MODES + i + 1]
            v_2 += row[i + 2] * b[MODES + i + 2]
            v_3 += row[i + 3] * b[MODES + i + 3]
        sums[0], sums[1], sums[2], sums[3] = s_0, s_1, s_2, s_3
        sums[4], sums[5], sums[6], sums[7] = v_0, v_1, v_2, v_3
        b[_S + 2 * STRIDE * k] = (sums[0] + sums[2]) + (sums[1] + sums[3])
        b[_V + 2 * STRIDE * k] = (sums[4] + sums[6]) + (sums[5] + sums[7])


@kernel
def _accelerate(b: np.ndarray, forces: np.ndarray) -> None:
    """Write the accelerations of modes and seats under the forces on the modes."""
    for i in range(_count(b)):
        b[_ACCELERATIONS + i] = _acceleration(b, i, forces[i])
    sums = b[_SUMS : _SUMS + _PARTIAL]
    fours = (_count(b) + 3) // 4
    for k in range(_N):
        row = b[_SHAPES + k * MODES : _SHAPES + (k + 1) * MODES]
        a_0, a_1, a_2, a_3 = 0.0, 0.0, 0.0, 0.0
        for four in range(fours):
            i = 4 * four
            a_0 += row[i] * b[_ACCELERATIONS + i]
            a_1 += row[i + 1] * b[_ACCELERATIONS + i + 1]
            a_2 += row[i + 2] * b[_ACCELERATIONS + i + 2]
            a_3 += row[i + 3] * b[_ACCELERATIONS + i + 3]
        sums[0], sums[1], sums[2], sums[3] = a_0, a_1, a_2, a_3
        b[_A + k] = (sums[0] + sums[2]) + (sums[1] + sums[3])


@kernel
def _out(b: np.ndarray, t: float) -> None:
    forces = b[_FIRST_INPUT:_FIRST_OUTPUT]
    of_modes = b[_ACCELERATIONS : _ACCELERATIONS + MODES]
    for i in range(_count(b)):
        of_modes[i] = _modal_force(b, i, forces, STRIDE)
    _motion(b)
    _accelerate(b, of_modes)


@kernel
def _longest_step(b: np.ndarray) -> float:
    """Step [s] in which no mode turns by more than `modal.LONGEST_PHASE`."""
    longest = _LONGEST_STEP
    for i in range(_count(b)):
        w = b[_OMEGA + i]
        longest = min(longest, modal.LONGEST_PHASE / max(w + 2.0 * b[_ZETA + i] * w, _SLOWEST))
    return longest


@kernel
def _propagators(b: np.ndarray, w: np.ndarray, h: float) -> int:
    """Place in the work space of the propagators of a step; the oldest ones make room.

    0 if the step is too long for them.
    """
    filled = int(w[_FILLED])
    for k in range(min(filled, STEPS)):
        if w[_STEP_OF + k] == h:
            return _PROPAGATORS + k * _SLOT
    if not h <= _longest_step(b):
        return 0
    slot = filled % STEPS
    at = _PROPAGATORS + slot * _SLOT
    scratch = w[_SCRATCH:_POLYNOMIALS]
    for i in range(_count(b)):
        modal.propagator(b[_OMEGA + i], b[_ZETA + i], h, w, _ONE, scratch)
        for entry in range(modal.PROPAGATOR):
            w[at + entry * MODES + i] = w[_ONE + entry]
    w[_STEP_OF + slot], w[_FILLED] = h, filled + 1.0
    return at


@kernel
def _push(b: np.ndarray, seat: int, forces: np.ndarray, to: np.ndarray) -> None:
    """Add what one power of the forces at a seat does to the modes.

    The three forces are read before the loop, which lets the compiler take modes side by side.
    """
    first = seat * _AXES
    f_x, f_y, f_z = (
        forces[first * STRIDE],
        forces[(first + 1) * STRIDE],
        forces[(first + 2) * STRIDE],
    )
    x = b[_SHAPES + first * MODES : _SHAPES + (first + _AXES) * MODES]
    for i in range(_count(b)):
        to[i] += x[i] * f_x + x[MODES + i] * f_y + x[2 * MODES + i] * f_z


@kernel
def _project(b: np.ndarray, w: np.ndarray, degree: int) -> None:
    """Write the forces on the modes as polynomials of the time in intervals between nodes.

    By power, then by mode; powers above the degree that `modal.advance` takes are zero.
    """
    forces, of_modes = w[_POLYNOMIALS:_MODAL], w[_MODAL:]
    for k in range(_N):
        monomial(b, _FIRST_INPUT + k * STRIDE, degree, forces, k * STRIDE)
        shift(forces, k * STRIDE, degree, 0.0, 1.0 / max(degree, 1))
    for i in range(modal.powers_of(degree) * MODES):
        of_modes[i] = 0.0
    for j in range(degree + 1):
        for seat in range(_SEATS):
            _push(b, seat, forces[j:], of_modes[j * MODES : (j + 1) * MODES])


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    degree = int(b[_DEGREE])
    intervals = max(degree, 1)
    at = _propagators(b, w, h / intervals)
    if at == 0:
        return TOO_LONG
    phi, forces = w[at : at + _SLOT], w[_MODAL:]
    _project(b, w, degree)
    for node in range(1, intervals + 1):
        modal.advance(b, phi, forces, degree, MODES, _count(b))
        modal.next_interval(forces, degree, MODES, _count(b))
        _motion(b)
        store_node(b, _FIRST_OUTPUT, _OUTPUTS, node)
    _accelerate(b, forces)
    return 0 if all_finite(b, 0, 2 * MODES) else NOT_FINITE


@kernel
def _start(b: np.ndarray) -> None:
    """Static deflection under the start forces; rigid modes stay at zero."""
    for i in range(2 * MODES):
        b[i] = 0.0
    forces = b[_START : _START + _N]
    for i in range(_count(b)):
        w = b[_OMEGA + i]
        if w > 0.0:
            b[i] = _modal_force(b, i, forces, 1) / (w * w)


_WANTED = modal_data.wanted_rows(_DOFS)


@seldom
def _load(
    values: np.ndarray, shape: np.ndarray, b: np.ndarray, s: np.ndarray, report: np.ndarray
) -> int:
    refusal = modal_data.collect(values, shape, _WANTED, MODES, b, _COUNT, report)
    if refusal == 0:
        for i in range(_count(b)):
            b[_OMEGA + i] *= 2.0 * math.pi
    return refusal


_LOADER = ResourceLoader(_d.texts, _load, modal_data.refusals(_DOFS, MODES), scratch=1)


def _nominals(b: np.ndarray) -> np.ndarray:
    """Deflections under the usual force at all seats, and their rates at the natural frequency."""
    omega = np.maximum(b[_OMEGA : _OMEGA + MODES], _SLOWEST)
    shapes = b[_SHAPES : _SHAPES + _N * MODES].reshape(_N, MODES)
    force = _USUAL_FORCE * np.maximum(np.linalg.norm(shapes, axis=0), _SMALLEST_SHAPE)
    return np.concatenate([force / omega**2, force / omega])


MODAL_HOUSING = Component(
    _d,
    Kernels(_step, _rhs, _out),
    __doc__,
    load=_LOADER,
    start=_start,
    motion=_motion,
    nominals=_nominals,
    longest_step=_longest_step,
)
