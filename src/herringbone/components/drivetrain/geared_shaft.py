"""Massless elastic shaft with a gear stage of a ratio and an efficiency.

    phi_rel = phi_a - ratio phi_b,   w_rel = w_a - ratio w_b
    torque = stiffness (phi_rel - phi_rel0) + damping w_rel
    tau_a = -torque,   tau_b = +ratio factor torque

`ratio` is speed of a over speed of b (both positive in driving direction), `torque` what flange a
gives; stiffness and damping are those that flange a sees. `factor` is `efficiency` when power flows
from a to b and 1 / `efficiency` when it flows back, at speeds far beyond `smooth_speed`. Through
standstill, with W = ratio w_b and s = W / sqrt(W^2 + smooth_speed^2), negated where torque < 0,

    factor = 1 + s ((e - 1/e) / 2 + s ((e + 1/e) / 2 - 1)),   e: efficiency
    loss_power = damping w_rel^2 + torque W (1 - factor)

which is never negative, and all that the powers of both flanges and the spring's energy leave.

Both flanges' motions belong to the same instant, as in a shaft coupling, which this is for ratio 1.

Sources: Modelica.Mechanics.Rotational.Components.IdealGear, SpringDamper and LossyGear (names,
signs, efficiency by the direction of power).
"""

import math

import numpy as np

from herringbone.components.ports import MOTION, coupled_flanges, flange
from herringbone.core import Component, Declaration, Kernels, Laws, output, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_d = Declaration(
    "geared_shaft",
    "Massless elastic shaft with a gear ratio and an efficiency",
    [
        *coupled_flanges(),
        output("torque", "N.m", "torque that flange a gives", feedthrough=MOTION,
               quantity=Quantity.TORQUE),
        output("phi_rel", "rad", "twist as seen at a",
               feedthrough=("flange_a.phi", "flange_b.phi")),
        output("w_rel", "rad/s", "rate of the twist", feedthrough=("flange_a.w", "flange_b.w"),
               steady="zero"),
        output("loss_power", "W", "power taken by damping and efficiency", feedthrough=MOTION,
               quantity=Quantity.LOSS_POWER),
        parameter("ratio", "1", "speed of a over speed of b", 1.0, minimum=1e-6),
        parameter("efficiency", "1", "power out over power in", 1.0, minimum=0.01, maximum=1),
        parameter("stiffness", "N.m/rad", "torsional, as seen at a", 6e4, minimum=0,
                  quantity=Quantity.STIFFNESS),
        parameter("damping", "N.m.s/rad", "torsional, as seen at a", 5.0, minimum=0,
                  quantity=Quantity.DAMPING),
        parameter("phi_rel0", "rad", "twist at which there is no torque", 0.0),
        parameter("smooth_speed", "rad/s", "speed at a below which losses fade", 1.0,
                  minimum=1e-6),
    ],
    work=steppers.element_work(len(MOTION)),
    roles=[Role.COUPLING],
    ports=[flange("flange_a"), flange("flange_b")],
)  # fmt: skip

_PHI_A, _W_A, _PHI_B, _W_B = _d.indices(*MOTION)
_TAU_A, _TAU_B, _TORQUE, _PHI_REL, _W_REL, _LOSS = _d.indices(
    "flange_a.tau", "flange_b.tau", "torque", "phi_rel", "w_rel", "loss_power"
)
_RATIO, _EFFICIENCY, _STIFFNESS, _DAMPING, _PHI_REL0, _SMOOTH, _DEGREE = _d.indices(
    "ratio", "efficiency", "stiffness", "damping", "phi_rel0", "smooth_speed", "interface_degree"
)


@kernel
def _factor(b: np.ndarray, torque: float) -> float:
    """Torque that arrives at b, over what an ideal stage would hand on."""
    e, w = b[_EFFICIENCY], b[_RATIO] * b[_W_B]
    s = w / math.sqrt(w * w + b[_SMOOTH] * b[_SMOOTH])
    if torque < 0.0:
        s = -s
    return 1.0 + s * (0.5 * (e - 1.0 / e) + s * (0.5 * (e + 1.0 / e) - 1.0))


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _ideal(b: np.ndarray) -> float:
    """Write the twist and its rate; the torque [N m] that flange a gives."""
    b[_PHI_REL] = b[_PHI_A] - b[_RATIO] * b[_PHI_B]
    b[_W_REL] = b[_W_A] - b[_RATIO] * b[_W_B]
    return b[_STIFFNESS] * (b[_PHI_REL] - b[_PHI_REL0]) + b[_DAMPING] * b[_W_REL]


@kernel
def _out(b: np.ndarray, t: float) -> None:
    ratio, torque = b[_RATIO], _ideal(b)
    factor = _factor(b, torque)
    b[_TORQUE] = torque
    b[_TAU_A] = -torque
    b[_TAU_B] = ratio * factor * torque
    b[_LOSS] = b[_DAMPING] * b[_W_REL] * b[_W_REL] + torque * ratio * b[_W_B] * (1.0 - factor)


_advance = steppers.element_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[_DEGREE]))


@kernel
def _gather(b: np.ndarray, z: np.ndarray) -> None:
    z[0], z[1] = _ideal(b), b[_W_B]


@kernel
def _evaluate(b: np.ndarray, z: np.ndarray, f: np.ndarray, k: np.ndarray, e: np.ndarray) -> None:
    b[_W_B] = z[1]
    k[0] = b[_RATIO] * (_factor(b, z[0]) - 1.0)
    f[0], e[0] = k[0] * z[0], z[0]


@kernel
def _apply(b: np.ndarray, t: float, f: np.ndarray, dx: np.ndarray) -> None:
    torque = _ideal(b)
    b[_TORQUE] = torque
    b[_TAU_A], b[_TAU_B] = -torque, b[_RATIO] * torque + f[0]


def _along_torque(block: np.ndarray) -> np.ndarray:
    del block
    return np.array([[1.0, 0.0]])


def _mean(block: np.ndarray) -> np.ndarray:
    """Power flows from a to b, beyond the smooth speed."""
    return np.array([block[_RATIO] * (block[_EFFICIENCY] - 1.0)])


def _loses(block: np.ndarray) -> bool:
    return bool(block[_EFFICIENCY] != 1.0)


_LAWS = Laws(
    arguments=("torque that flange a gives", "angular velocity of flange b"),
    values=("torque that is lost at flange b",),
    stiff=(0,),
    kinks=1,
    gather=_gather,
    evaluate=_evaluate,
    apply=_apply,
    directions=_along_torque,
    mean=_mean,
    needed=_loses,
)

GEARED_SHAFT = Component(_d, Kernels(_step, _rhs, _out), __doc__, laws=_LAWS)
