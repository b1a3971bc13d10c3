"""Ports that several components share."""

from herringbone.core import Variable, input_, output
from herringbone.core.declaring.roles import HALVES, Port, PortKind, Quantity

__all__ = [
    "HALVES",
    "MOTION",
    "coupled_flanges",
    "flange",
    "flange_body",
    "journals",
    "seats",
]

MOTION = ("flange_a.phi", "flange_a.w", "flange_b.phi", "flange_b.w")
"""What a part between two bodies takes, see `coupled_flanges`."""


def flange_body(port: str, *, more: tuple[str, ...] = ()) -> tuple[Variable, ...]:
    """The rotational port of a body: it gives motion and takes torque.

    Args:
        port: its name.
        more: inputs besides the torque on which its acceleration depends directly.
    """
    phi, w, a = (f"{port}.{q}" for q in ("phi", "w", "a"))
    return (
        input_(f"{port}.tau", "N.m", f"torque on the body at {port}"),
        output(phi, "rad", f"angle of {port}, positive in driving direction", nodes=True, rate=w),
        output(
            w,
            "rad/s",
            f"angular velocity of {port}",
            nodes=True,
            rate=a,
            quantity=Quantity.SPEED,
            place=port,
        ),
        output(a, "rad/s2", f"angular acceleration of {port}", feedthrough=(f"{port}.tau", *more)),
    )


def coupled_flanges() -> tuple[Variable, ...]:
    """The flanges of a massless part between two bodies: it takes motions and gives torques."""
    motions = (
        variable
        for side in ("a", "b")
        for variable in (
            input_(f"flange_{side}.phi", "rad", f"angle of flange {side}"),
            input_(f"flange_{side}.w", "rad/s", f"angular velocity of flange {side}"),
        )
    )
    torques = (
        output(
            f"flange_{side}.tau",
            "N.m",
            f"torque on the body at {side}",
            feedthrough=MOTION,
            nodes=True,
        )
        for side in ("a", "b")
    )
    return (*motions, *torques)


def flange(name: str, place: str = "") -> Port:
    """The end of a shaft."""
    return Port(name, PortKind.FLANGE, place)


def journals(prefix: str = "") -> tuple[Port, ...]:
    """The gear halves in their bearings."""
    return tuple(Port(f"{prefix}{half}", PortKind.JOURNAL, half) for half in HALVES)


def seats(prefix: str = "") -> tuple[Port, ...]:
    """The bearings in the housing."""
    return tuple(Port(f"{prefix}{half}", PortKind.SEAT, half) for half in HALVES)
