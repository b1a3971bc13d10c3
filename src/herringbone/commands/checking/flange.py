"""`stability X.fmu --flange PORT`: the largest communication step at a host."""

import argparse
import math
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from herringbone.commands.answers import Told
from herringbone.commands.options import start_values
from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.running.foreign.hosted_flange import HostedFlange

_WIDTH = 100
_ROUGH = 0.1
"""Residual of the FMU's model above which its limits are orders of magnitude."""
_NAMES = {
    False: "shaft evaluated at the communication points",
    True: "shaft stepped in parallel, one step late",
}
_ONLY_HERE = ("inertia", "stiffness", "damping")
_NOT_HERE = (
    "scene", "speed", "torque", "algorithm", "step", "simulate", "atlas", "output", "gear",
    "housing", "replace",
)  # fmt: skip


def add_options(sub: argparse.ArgumentParser) -> None:
    """Declare what is asked of one FMU."""
    sub.add_argument(
        "--flange", metavar="PORT",
        help="of an FMU in place of a system: the port that a host couples to an inertia, or "
        "tau=NAME,phi=NAME,w=NAME; guessed",
    )  # fmt: skip
    sub.add_argument("--inertia", type=float, help="of the host at the flange in kg.m2")
    sub.add_argument("--stiffness", type=float, help="of the host's shaft in N.m/rad")
    sub.add_argument("--damping", type=float, help="of the host's shaft in N.m.s/rad")


def is_asked(options: argparse.Namespace) -> bool:
    """True if the command is about an FMU at a host.

    Raises:
        ParameterError: options are missing, or belong to systems.
    """
    fmu = Path(options.system).suffix == ".fmu"
    given = [name for name in _ONLY_HERE if getattr(options, name) is not None]
    if not fmu:
        if options.flange or given:
            name = "flange" if options.flange else given[0]
            raise ParameterError(
                f"--{name} is asked of one FMU, not of the system {options.system}"
            )
        return False
    if options.inertia is None:
        raise ParameterError(
            f"{options.system}: of an FMU give the host's --inertia in kg.m2, with "
            "--stiffness and --damping of the host's shaft if the flange takes torque"
        )
    for name in _NOT_HERE:
        if getattr(options, name) not in (None, False, []):
            raise ParameterError(f"--{name} is of systems; leave it out for an FMU")
    return True


def flange_limits(options: argparse.Namespace) -> Told:
    """What is told of the FMU.

    Raises:
        HerringboneError: something about the input is wrong, or trials tell nothing of the FMU.
    """
    from herringbone.analysis.flange.hosted_flange import Host  # noqa: PLC0415 (numba)
    from herringbone.running.foreign.hosted_flange import hosted_flange  # noqa: PLC0415

    host = Host(options.inertia, options.stiffness or 0.0, options.damping or 0.0)
    values = start_values(options.set, "VARIABLE=VALUE")
    found = hosted_flange(Path(options.system), options.flange or "", host, values)
    return Told(_text(found), _summary(found))


def _text(found: "HostedFlange") -> str:
    host, flange = found.host, found.flange
    shaft = f", shaft {host.stiffness:g} N.m/rad, {host.damping:g} N.m.s/rad"
    names = ", ".join(filter(None, (flange.tau, flange.phi, flange.w)))
    lines = [
        f"{found.fmu}: {names} with {host.inertia:g} kg.m2"
        f"{shaft if flange.takes_torque else ' at the flange, its shaft inside'}",
        "first unstable communication step in us",
        "",
        f"{'order':>5}  {'':<{len(_NAMES[False])}}  {'limit':>9}  {'also unstable'}",
    ]
    for x in found.limits:
        name = _NAMES[x.parallel] if flange.takes_torque else "inertia at the flange"
        limit = f"{1e6 * x.limit:.1f}" if math.isfinite(x.limit) else "none"
        more = "" if len(x.unstable_bands) < 2 else f"from {1e6 * x.unstable_bands[1][0]:.1f}"
        edge = x.unstable_bands[0][1] if x.unstable_bands else math.inf
        more = f"to {1e6 * edge:.1f}, {more}".rstrip(", ") if math.isfinite(edge) else more
        lines.append(f"{x.order:>5}  {name:<{len(_NAMES[False])}}  {limit:>9}  {more}".rstrip())
    said = [
        "order 0 holds what is exchanged, orders 1 and 2 give its derivatives, through the last 2 "
        "and 3 points"
        + ("" if found.takes_derivatives else "; this FMU takes no input derivatives"),
        f"the FMU as a linear system of order {found.order} by trial steps of {found.base:g} s; on "
        f"other trials, at the limits, it misses by {100.0 * found.residual:.2g} %"
        if found.base
        else f"by linear equations of order {found.order} that the FMU carries: those of its start "
        "as it was exported, averaged over a mesh period",
    ]
    if not found.promised:
        said.append(
            "nothing is promised: the limits are estimates, because that is above 1 %; the FMU "
            "changes with time, is not linear, or has motions that these steps do not resolve"
        )
    if found.residual > _ROUGH:
        said.append(
            "they tell no more than the order of magnitude: try the step at your host; a gearbox "
            "that was exported here has limits of its equations in its documentation"
        )
    return "\n".join([*lines, "", *(piece for line in said for piece in wrap(line, _WIDTH))])


def _summary(found: "HostedFlange") -> dict[str, Any]:
    """Plain values: steps in s; None where no limit was found."""
    return {
        "fmu": str(found.fmu),
        "torque": found.flange.tau,
        "angle": found.flange.phi or None,
        "speed": found.flange.w,
        "takes_torque": found.flange.takes_torque,
        "inertia": found.host.inertia,
        "stiffness": found.host.stiffness,
        "damping": found.host.damping,
        "takes_derivatives": found.takes_derivatives,
        "limits": [
            {
                "order": x.order,
                "parallel": x.parallel,
                "limit": x.limit if math.isfinite(x.limit) else None,
                "unstable_bands": [
                    [edge if math.isfinite(edge) else None for edge in band]
                    for band in x.unstable_bands
                ],
            }
            for x in found.limits
        ],
        "model_order": found.order,
        "trial_step": found.base,
        "residual": found.residual,
        "promised": found.promised,
    }
