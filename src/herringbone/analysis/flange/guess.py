"""Which variables of a part look like a flange: by the names of ports, or by units and names."""

from collections.abc import Mapping

from herringbone.core.part import PartVariable, is_signal_node

QUANTITIES = ("tau", "phi", "w")
UNITS = {"tau": "N.m", "phi": "rad", "w": "rad/s"}
POWERS = {"tau": {"kg": 1, "m": 2, "s": -2}, "phi": {}, "w": {"s": -1}}
"""Exponents of base units; rad is left out, as tools differ on it."""
_WORDS = {
    "tau": {"tau", "torque", "moment", "trq", "m", "t"},
    "phi": {"phi", "angle", "theta", "rotation", "position"},
    "w": {"w", "omega", "speed", "velocity", "n", "rpm"},
}


def reals(variables: Mapping[str, PartVariable]) -> dict[str, PartVariable]:
    """Real inputs and outputs, without nodes."""
    return {
        name: v
        for name, v in variables.items()
        if v.is_real and v.causality in {"input", "output"} and not is_signal_node(variables, name)
    }


def by_ports(variables: Mapping[str, PartVariable]) -> list[dict[str, str]]:
    """Ports that have a torque and a motion, in their order; without any, those of two motions."""
    names = reals(variables)
    ports = dict.fromkeys(name.rpartition(".")[0] for name in names if "." in name)
    found = []
    for port in ports:
        given = {q: f"{port}.{q}" for q in QUANTITIES if f"{port}.{q}" in names}
        if len(given) > 1:
            found.append(given)
    return [given for given in found if "tau" in given] or found


def by_units(variables: Mapping[str, PartVariable]) -> list[dict[str, str]]:
    """The only torque in and motion out, or motion in and torque out."""
    there = reals(variables)
    for torque, motion in (("input", "output"), ("output", "input")):
        given = {}
        for quantity in QUANTITIES:
            causality = torque if quantity == "tau" else motion
            fits = [n for n, v in there.items() if v.causality == causality and _fits(v, quantity)]
            if len(fits) == 1:
                given[quantity] = fits[0]
        if "tau" in given and len(given) > 1:
            return [given]
    return []


def _fits(variable: PartVariable, quantity: str) -> bool:
    """By its unit, or, where that does not tell, by the words of its name."""
    last = variable.name.rpartition(".")[2].lower()
    named = any(word in _WORDS[quantity] for word in (last, *last.split("_")))
    if variable.dimension is None:
        return named if variable.unit is None else variable.unit == UNITS[quantity]
    sure = variable.unit == UNITS[quantity] or quantity == "tau"
    return powers(variable) == POWERS[quantity] and (sure or named)


def powers(variable: PartVariable) -> dict[str, int]:
    """Exponents of the base units of a variable whose unit is defined; without rad."""
    assert variable.dimension is not None
    return {name: power for name, power in variable.dimension[2] if name != "rad"}
