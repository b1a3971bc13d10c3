"""Largest stable communication steps of a gearbox, by what the host has at a flange.

The equations are linearised in the equilibrium of the start, and averaged over a mesh period; of
motions those are kept that the flange feels most, the others follow it at once. What the host does
is in `flange.hosted_flange`.

A loop of one's own finds the same limits where it looks closely enough: bands of unstable steps can
be a few per cent wide, where a motion meets its mirror image at half the rate of the communication
points, and beyond a limit a motion may grow by e in a second.
"""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.flange.hosted_flange import Host, host_limits
from herringbone.analysis.hosted.boundary import HostFlange
from herringbone.analysis.hosted.flange_model import averaged, reduced, started
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.twin.composite import Composite
from herringbone.core.declaring.hosting import Given

INERTIAS = (0.02, 0.1, 1.0)
"""Of the host at the flange [kg.m2]."""
SHAFT = (6e4, 5.0)
"""Of the host where the gearbox takes torque [N.m/rad, N.m.s/rad]."""
_NARROW = 1.2
"""A band of unstable steps is told that ends sooner, if steps beyond it are stable for longer."""


_HEAD = ("flange", "host gives", "what the host has there", "held", "with derivatives")


Models = dict[str, tuple[Given, LinearModel]]
"""By flange: what the host gives, and the equations as the flange feels them."""


def advice(models: Models) -> list[tuple[str, ...]]:
    """The limits as a table; see `Hosting.advice`."""
    rows: dict[tuple[str, ...], list[str]] = {}
    for limit in step_limits(models):
        there = f"{limit.inertia:g} kg.m2"
        if limit.given is Given.TORQUE:
            there += f" behind a shaft of {SHAFT[0]:g} N.m/rad, {SHAFT[1]:g} N.m.s/rad"
        row = limit.flange, limit.given.value, there
        rows.setdefault(row, []).append(_cell(limit))
    return [_HEAD, *((*row, *steps) for row, steps in rows.items())]


def _cell(limit: "StepLimit") -> str:
    """The limit, and beyond a narrow band of unstable steps where steps are stable again."""
    start, end = limit.again
    text = f"{1e6 * limit.step:.0f} us"
    if start < _NARROW * limit.step < end:
        text += f", and from {1e6 * start:.0f} to {1e6 * end:.0f} us"
    return text


class StepLimit(NamedTuple):
    """Largest stable communication step.

    Attributes:
        flange, given: of the gearbox.
        inertia: of the host [kg.m2].
        order: 0: what is exchanged is held; 1: its derivatives are given.
        step: [s].
        again: steps [s] between which all is stable again, behind the first unstable band.
    """

    flange: str
    given: Given
    inertia: float
    order: int
    step: float
    again: tuple[float, float]


def models_of(composite: Composite, flanges: tuple[HostFlange, ...]) -> Models:
    """The models at the start."""
    block = started(composite)
    return {f.name: (f.given, reduced(averaged(composite, block, f))) for f in flanges}


def step_limits(models: Models) -> list[StepLimit]:
    """Limits at every flange, where the host evaluates its shaft at the communication points."""
    found = []
    for name, (given, model) in models.items():
        takes_torque = given is Given.TORQUE
        for inertia in INERTIAS:
            host = Host(inertia, *(SHAFT if takes_torque else (0.0, 0.0)))
            for limit in host_limits(model, host, takes_torque=takes_torque):
                if not limit.parallel and limit.order <= 1:
                    row = name, given, inertia, limit.order, limit.limit
                    found.append(StepLimit(*row, _again(limit.unstable_bands)))
    return found


def _again(bands: tuple[tuple[float, float], ...]) -> tuple[float, float]:
    """Steps between the first two unstable bands; infinite where there is one alone."""
    return (bands[0][1], bands[1][0]) if len(bands) > 1 else (np.inf, np.inf)
