"""What the names of signals tell.

Components declare which output is the rate of which. Of foreign FMUs only names are known: s -> v
-> a, phi -> w -> a. Names also tell which motion belongs to which force.
"""

from collections.abc import Collection

from herringbone.core import StructureError
from herringbone.core.part import Part

_RATES = {"s": "v", "v": "a", "phi": "w", "w": "a"}
_MOTIONS = {"f": ("s", "v"), "tau": ("phi", "w")}


def rate_of(part: Part, name: str) -> str | None:
    """The output that is an output's time derivative, as declared or as told by `x.s_y`, `x.v_y`.

    None if there is none, or none is known.
    """
    declared = part.variables[name].rate
    return named_rate(name, part.variables) if declared is None else declared or None


def named_rate(name: str, names: Collection[str]) -> str | None:
    """The rate of an output by the names of all: `x.s_y`, `x.v_y`; None if there is none."""
    port, dot, last = name.rpartition(".")
    quantity, bar, axis = last.partition("_")
    rate = f"{port}{dot}{_RATES.get(quantity)}{bar}{axis}"
    return rate if rate in names else None


def motion_of_force(name: str) -> tuple[str, str] | None:
    """Position and velocity of a force: `x.f_y` -> `x.s_y`, `x.v_y`; None for other names."""
    port, dot, last = name.rpartition(".")
    quantity, bar, axis = last.partition("_")
    if quantity not in _MOTIONS:
        return None
    position, velocity = (f"{port}{dot}{q}{bar}{axis}" for q in _MOTIONS[quantity])
    return position, velocity


def rates(part: Part, names: list[str]) -> list[str]:
    """The given outputs' rates, and the rates of these, as far as the part has them."""
    found: list[str] = []
    for name in names:
        first = rate_of(part, name)
        for candidate in (first, rate_of(part, first) if first else None):
            if candidate and candidate not in found:
                found.append(candidate)
    return found


def motion_at(force: str) -> tuple[str, str]:
    """As `motion_of_force`, for what is known to be one; raises StructureError."""
    found = motion_of_force(force)
    if found is None:
        raise StructureError(f"'{force}' is the name of no force: it must be port.f_x or port.tau")
    return found
