"""Where models of foreign parts are linear: speed and torque at flanges, and their slope there."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.analysis.flange.guess import by_ports, by_units
from herringbone.analysis.stability.surrogates.free_rotation import for_good
from herringbone.analysis.stability.surrogates.identification import LinearModel
from herringbone.analysis.stability.surrogates.stand_in import Stranger
from herringbone.analysis.stability.surrogates.surrogate import Surrogate

_FEELABLE = 1e-3
"""Speeds [rad/s], torques [N m] and slopes below which a line shows 0."""
UNLOADED = (
    "no foreign part gives or takes a torque where the run starts: limits are those of teeth that "
    "stay in contact; where nothing else loads them and they rattle, runs may grow below, and need "
    "not above"
)
_HOLDS = 1e-2
"""Torque that an angle keeps up for good, over what it makes at once: above, it is no shaft's."""


@dataclass(frozen=True)
class FlangePoint:
    """A flange of a foreign part at the point at which its model is linear.

    Attributes:
        name: of the port.
        speed: [rad/s]; NaN: it has none.
        torque: that it gives or takes [N m].
        slope: of the steady torque over speed [N m s/rad]; NaN: it takes torque, or has none.
    """

    name: str
    speed: float
    torque: float
    slope: float

    def __str__(self) -> str:
        speed = "" if math.isnan(self.speed) else f"{_shown(self.speed):.5g} rad/s, "
        told = f", torque over speed {_shown(self.slope):.3g} N m s/rad"
        slope = "" if math.isnan(self.slope) else told
        return f"{self.name} at {speed}{_shown(self.torque):.4g} N m{slope}"


def flange_points(stranger: Stranger) -> tuple[FlangePoint, ...]:
    """Flanges among the connected variables of a part, by ports or units; empty without."""
    surrogate, known = stranger.surrogate, stranger.part.variables
    names = (*surrogate.inputs, *surrogate.outputs)
    values = dict(zip(names, (*surrogate.start, *surrogate.start_outputs), strict=False))
    variables = {name: known[name] for name in names if name in known}
    found = []
    for given in by_ports(variables) or by_units(variables):
        if "tau" not in given:
            continue
        slope = math.nan
        if (
            isinstance(surrogate, Surrogate)
            and surrogate.model
            and given["tau"] in surrogate.outputs
        ):
            row = surrogate.outputs.index(given["tau"])
            motion = [_place(surrogate.inputs, given.get(q)) for q in ("phi", "w")]
            slope = steady_slope(surrogate.model, row, *motion)
        speed = values.get(given.get("w", ""), math.nan)
        port = given["tau"].rpartition(".")[0] or given["tau"]
        found.append(FlangePoint(port, float(speed), float(values[given["tau"]]), slope))
    return tuple(found)


def steady_slope(model: LinearModel, tau: int, phi: int, w: int) -> float:
    """What a faster shaft makes of a torque for good [N m s/rad]; NaN if there is no such torque.

    With G the transfer functions from angle and speed, and the angle that of the speed,
    the limit of G_phi(s) / s + G_w(s) for s to 0.

    Args:
        model: of the part.
        tau: number of the output.
        phi, w: numbers of the inputs, -1 if the part has none.
    """
    found = 0.0
    if phi >= 0:
        held = abs(for_good(model, phi)[tau])
        if not held <= _HOLDS * abs(model.d[tau, phi]):
            return math.nan
        if len(model.a):
            twice = np.linalg.solve(model.a, np.linalg.solve(model.a, model.b[:, phi]))
            found -= float(model.c[tau] @ twice)
    if w >= 0:
        found += float(for_good(model, w)[tau])
    return found if phi >= 0 or w >= 0 else math.nan


def linear_at(strangers: Mapping[str, Stranger]) -> Iterator[str]:
    """A line for each foreign part on where its model is linear; and on teeth without load."""
    for name, stranger in strangers.items():
        yield f"{name} is linear {where(stranger)}"
    started = [flange_points(s) for s in strangers.values() if s.at_start]
    torques = [abs(point.torque) for points in started for point in points]
    if torques and max(torques) < _FEELABLE:
        yield UNLOADED


def where(stranger: Stranger) -> str:
    """At which point a part's model is linear, in words."""
    at = (
        "in the steady rotation in which the run starts"
        if stranger.at_start
        else "at the values that it declares"
    )
    points = "; ".join(map(str, flange_points(stranger)))
    return f"{at}: {points}" if points else at


def _shown(value: float) -> float:
    """A number as lines show it: what nobody feels is nothing, without a minus."""
    return value if abs(value) >= _FEELABLE else 0.0


def _place(names: Sequence[str], name: str | None) -> int:
    return names.index(name) if name in names else -1
