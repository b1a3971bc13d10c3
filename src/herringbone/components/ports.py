"""Names that several components share: the four halves and the ports."""

from herringbone.core import Variable, input_, output

HALVES = ("pinion_left", "pinion_right", "wheel_left", "wheel_right")
"""The four gear half-bodies and their bearing seats, in the thesis' order 1 ... 4. Left is +z."""


def flange_body(port: str) -> tuple[Variable, ...]:
    """The rotational port of a body: it gives motion and takes torque."""
    return (
        input_(f"{port}.tau", "N.m", f"torque on the body at {port}"),
        output(f"{port}.phi", "rad", f"angle of {port}, positive in driving direction", nodes=True),
        output(f"{port}.w", "rad/s", f"angular velocity of {port}", nodes=True),
        output(
            f"{port}.a", "rad/s2", f"angular acceleration of {port}", feedthrough=(f"{port}.tau",)
        ),
    )
