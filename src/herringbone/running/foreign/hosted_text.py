"""What is shown of an FMU at a host."""

import math
from textwrap import wrap
from typing import TYPE_CHECKING

from herringbone.core.wording import percent

if TYPE_CHECKING:
    from herringbone.running.foreign.hosted_flange import HostedFlange

_WIDTH = 100
_ROUGH = 0.1
"""Residual of the FMU's model above which its limits are orders of magnitude."""
_NAMES = {
    False: "shaft evaluated at the communication points",
    True: "shaft stepped in parallel, one step late",
}


def hosted_text(found: "HostedFlange") -> str:
    """Limits as a table, and how they were found."""
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
        f"other trials, at the limits, it misses by {percent(found.residual)}"
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
    said += found.notes
    return "\n".join([*lines, "", *(piece for line in said for piece in wrap(line, _WIDTH))])
