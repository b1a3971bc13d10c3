"""`stability X.fmu --flange PORT`: the largest communication step at a host."""

import argparse
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from herringbone.commands.answers import Told
from herringbone.commands.options import start_values
from herringbone.core import ParameterError

if TYPE_CHECKING:
    from herringbone.running.foreign.hosted_flange import HostedFlange

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
    return Told(str(found), _summary(found))


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
