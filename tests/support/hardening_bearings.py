"""A second bearing, for tests: radially hardening, with other names than the shipped one.

With d the displacement of the journal against the mount along the line of action n, as that of the
shipped bearing,

    f = support_stiffness d (1 + (d / hardening_deflection)^2) + c d'
    force on the journal: -f along y;   force on the mount: +f n

and the same along z with `thrust_stiffness` at the wheel, without hardening. c is 2 % of the
critical damping of a half-body and no parameter: this bearing does not answer how much it damps.

As a component it is this module, one line of the registry, and what is generated.
"""

import math

import numpy as np

from herringbone.components.ports import HALVES, journals, seats
from herringbone.core import Component, Declaration, Kernels, Variable, input_, output, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.elementary import cosine, sine

_STIFFNESS, _THRUST_STIFFNESS = 6.34e8, 2.03e8
_DAMPING = tuple(0.04 * math.sqrt(_STIFFNESS * mass) for mass in (6.5, 47.739))
_THRUST_DAMPING = 0.04 * math.sqrt(_THRUST_STIFFNESS * 47.739)
_ANGLE_START = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(30.0)))


def _side(side: str, half: str, axes: str, feedthrough: tuple[str, ...]) -> list[Variable]:
    motions = [
        input_(f"{side}.{half}.{q}_{axis}", unit, f"motion of the {side} at {half}, {axis}")
        for axis in axes
        for q, unit in (("s", "m"), ("v", "m/s"))
    ]
    forces = [
        output(
            f"{side}.{half}.f_{axis}",
            "N",
            f"force on the {side} at {half} along {axis}",
            feedthrough=feedthrough,
            nodes=True,
        )
        for axis in axes
    ]
    return motions + forces


def _bearing(half: str) -> list[Variable]:
    inputs = tuple(
        f"{side}.{half}.{q}_{axis}"
        for side, axes in (("journal", "yz"), ("mount", "xyz"))
        for axis in axes
        for q in "sv"
    )
    return [*_side("journal", half, "yz", inputs), *_side("mount", half, "xyz", inputs)]


_d = Declaration(
    "hardening_bearings",
    "Massless bearings that harden, between line of action and housing frame",
    [
        *(v for half in HALVES for v in _bearing(half)),
        parameter("support_stiffness", "N/m", "radial, per half", _STIFFNESS, minimum=0,
                  quantity=Quantity.STIFFNESS),
        parameter("thrust_stiffness", "N/m", "axial, per half of the wheel", _THRUST_STIFFNESS,
                  minimum=0, quantity=Quantity.STIFFNESS),
        parameter("hardening_deflection", "m", "at which the stiffness is twice as much", 5e-5,
                  minimum=1e-9),
        parameter("line_of_action", "rad", "working transverse pressure angle", _ANGLE_START,
                  minimum=-math.pi, maximum=math.pi),
    ],
    work=steppers.element_work(10 * len(HALVES)),
    roles=[Role.BEARING],
    ports=[*journals("journal."), *seats("mount.")],
)  # fmt: skip

_S_Y, _V_Y, _S_Z, _V_Z, _F_Y, _F_Z = (
    _d.indices(*(f"journal.{h}.{q}" for h in HALVES))
    for q in ("s_y", "v_y", "s_z", "v_z", "f_y", "f_z")
)
_MOUNT_S, _MOUNT_V, _MOUNT_F = (
    tuple(_d.indices(*(f"mount.{h}.{q}_{axis}" for axis in "xyz")) for h in HALVES) for q in "svf"
)
_K, _K_THRUST, _HARDENING, _ANGLE, _DEGREE = _d.indices(
    "support_stiffness", "thrust_stiffness", "hardening_deflection", "line_of_action",
    "interface_degree",
)  # fmt: skip


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _out(b: np.ndarray, t: float) -> None:
    n_x, n_y = sine(b[_ANGLE]), cosine(b[_ANGLE])
    for i in range(4):
        s, v, f = _MOUNT_S[i], _MOUNT_V[i], _MOUNT_F[i]
        d = b[_S_Y[i]] - (n_x * b[s[0]] + n_y * b[s[1]])
        rate = b[_V_Y[i]] - (n_x * b[v[0]] + n_y * b[v[1]])
        share = d / b[_HARDENING]
        radial = b[_K] * d * (1.0 + share * share) + _DAMPING[i // 2] * rate
        thrust = 0.0
        if i >= 2:
            thrust = b[_K_THRUST] * (b[_S_Z[i]] - b[s[2]])
            thrust += _THRUST_DAMPING * (b[_V_Z[i]] - b[v[2]])
        b[_F_Y[i]], b[_F_Z[i]] = -radial, -thrust
        b[f[0]], b[f[1]], b[f[2]] = radial * n_x, radial * n_y, thrust


_advance = steppers.element_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[_DEGREE]))


HARDENING_BEARINGS = Component(_d, Kernels(_step, _rhs, _out), __doc__)
