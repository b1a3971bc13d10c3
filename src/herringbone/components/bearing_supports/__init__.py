r"""Massless bearings of the four gear halves, between shaft (gear frame) and seat (housing frame).

The gear's y is the line of action of the flank that carries. In the housing frame (x toward the
wheel, y up, z axial) it is the unit vector n = (flank sin(alpha_wt), cos(alpha_wt), 0), for a
pinion whose driving rotation is about +z; flank is 1 (drive) or -1 (coast), the same as at the
gear. With the seat motion projected on n, each half has

    d = s_y - n . s_seat,   f = radial_stiffness gap(d) + radial_damping g d'
    force on the shaft: -f along y;   force on the seat: +f n

and the same along z with the axial stiffness, without n. The same vector carries motion in and
force out, so that no power is created. With a radial clearance c,

    gap(d) = d - max(-c/2, min(d, c/2)),   g = min(1, |gap(d)| / (c/10))

so that the damping acts only on the loaded part, and f = 0 where its sign is not that of gap(d): a
bearing with clearance never pulls. Without clearance g = 1, and f may have any sign.

With `seat_motion` 0 the bearings stand on rigid ground: s_seat and its rate count as zero, while
the forces drive the housing as before. This is the one-way procedure of the thesis, chapter 4.
Power is not balanced then: what the housing takes up nobody has given.

A master that steps all FMUs in parallel sees this element one macro step h late; gear and seat then
are stable only for h < 4/3 zeta / w with the local w, zeta; `herringbone stability` computes the
limit of a system. A master that steps it after the bodies, over the same interval, has no delay.

Source: the thesis, table 3.1 (radial 6.34e8 N/m, axial 2.03e8 N/m, read as per half of the wheel);
damping 2 % of the local critical damping of a half-body, a choice of this project. With
`axial_per_shaft` 1 the axial ratio is 1.41 %, 2 % / sqrt(2): stiffness and damping are halved, and
the ratio goes by damping / sqrt(stiffness).
"""

import numpy as np

from herringbone.components.bearing_supports import layout as at
from herringbone.components.bearing_supports.forces import (
    approach,
    line_of_action,
    radial_force,
    write_forces,
)
from herringbone.components.bearing_supports.laws import LAWS
from herringbone.core import Component, Kernels
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _out(b: np.ndarray, t: float) -> None:
    n_x, n_y = line_of_action(b)
    for i in range(4):
        d, rate = approach(b, i, n_x, n_y)
        write_forces(b, i, n_x, n_y, radial_force(b, i // 2, d, rate))


_advance = steppers.element_stepper(_out, at.DECLARATION)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[at.DEGREE]))


BEARING_SUPPORTS = Component(
    at.DECLARATION, Kernels(_step, _rhs, _out), __doc__, of_pair=at.of_pair, laws=LAWS
)
