"""What the names of signals tell.

Which output is the rate of which: s -> v -> a, phi -> w -> a; which motion belongs to which force.
"""

from herringbone.core.part import Part

_RATES = {"s": "v", "v": "a", "phi": "w", "w": "a"}
_MOTIONS = {"f": ("s", "v"), "tau": ("phi", "w")}


def rate_of(name: str) -> str | None:
    """Name of the time derivative of an output, if the name tells: `x.s_y` -> `x.v_y`."""
    port, dot, last = name.rpartition(".")
    quantity, bar, axis = last.partition("_")
    return f"{port}{dot}{_RATES[quantity]}{bar}{axis}" if quantity in _RATES else None


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
        first = rate_of(name)
        for candidate in (first, rate_of(first) if first else None):
            if candidate in part.variables and candidate not in found:
                found.append(str(candidate))
    return found
