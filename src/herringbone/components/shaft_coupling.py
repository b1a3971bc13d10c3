"""Massless torsional spring-damper between two flanges; the torque transducer.

    torque = stiffness (phi_a - phi_b - phi_rel0) + damping (w_a - w_b)
    tau_a = -torque,  tau_b = +torque

`phi_rel0` is the twist at which there is no torque: in a closed loop of shafts, it locks one in.

`torque` is the torque that flange a hands to flange b, `speed` the mean of both speeds: what the
transducer shows. Both flanges' motions belong to the same instant: never hold one side's angle
against the other side's newer one.

A master that steps all FMUs in parallel sees this element one macro step h late; the pair of
rotors then is stable only for h < 4/3 zeta / w, with w, zeta of the local two-rotor oscillation.

Source: Modelica.Mechanics.Rotational.Components.SpringDamper (names and signs).
"""

import numpy as np

from herringbone.components.ports import MOTION, coupled_flanges, flange
from herringbone.core import Component, Declaration, Kernels, output, parameter
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.kernels import steppers
from herringbone.kernels.compiling.jit import kernel

_d = Declaration(
    "shaft_coupling",
    "Massless torsional spring-damper with torque and speed transducer",
    [
        *coupled_flanges(),
        output(
            "torque",
            "N.m",
            "torque handed from a to b",
            feedthrough=MOTION,
            quantity=Quantity.TORQUE,
        ),
        output("speed", "rad/s", "mean speed", feedthrough=("flange_a.w", "flange_b.w")),
        output("phi_rel", "rad", "twist", feedthrough=("flange_a.phi", "flange_b.phi")),
        output(
            "w_rel",
            "rad/s",
            "rate of the twist",
            feedthrough=("flange_a.w", "flange_b.w"),
            steady="zero",
        ),
        parameter(
            "stiffness",
            "N.m/rad",
            "torsional stiffness",
            6e4,
            minimum=0,
            quantity=Quantity.STIFFNESS,
        ),
        parameter(
            "damping",
            "N.m.s/rad",
            "torsional damping",
            5.0,
            minimum=0,
            quantity=Quantity.DAMPING,
        ),
        parameter("phi_rel0", "rad", "twist at which there is no torque", 0.0),
    ],
    work=steppers.element_work(len(MOTION)),
    roles=[Role.COUPLING],
    ports=[flange("flange_a"), flange("flange_b")],
)

_PHI_A, _W_A, _PHI_B, _W_B = _d.indices(*MOTION)
_TAU_A, _TAU_B, _TORQUE, _SPEED, _PHI_REL, _W_REL = _d.indices(
    "flange_a.tau", "flange_b.tau", "torque", "speed", "phi_rel", "w_rel"
)
_STIFFNESS, _DAMPING, _PHI_REL0, _DEGREE = _d.indices(
    "stiffness", "damping", "phi_rel0", "interface_degree"
)


@kernel
def _rhs(b: np.ndarray, t: float, dx: np.ndarray) -> None:
    pass


@kernel
def _out(b: np.ndarray, t: float) -> None:
    b[_PHI_REL] = b[_PHI_A] - b[_PHI_B]
    b[_W_REL] = b[_W_A] - b[_W_B]
    elastic = b[_STIFFNESS] * (b[_PHI_REL] - b[_PHI_REL0])
    b[_TORQUE] = elastic + b[_DAMPING] * b[_W_REL]
    b[_TAU_A], b[_TAU_B] = -b[_TORQUE], b[_TORQUE]
    b[_SPEED] = 0.5 * (b[_W_A] + b[_W_B])


_advance = steppers.element_stepper(_out, _d)


@kernel
def _step(b: np.ndarray, w: np.ndarray, t: float, h: float) -> int:
    return _advance(b, w, t, h, int(b[_DEGREE]))


SHAFT_COUPLING = Component(_d, Kernels(_step, _rhs, _out), __doc__)
