"""Which FMI types fit into which, so that a connection loses nothing, or digits alone."""

from herringbone.core.part import PartVariable

_REALS = ("Real", "Float64")
_BITS = {"Int8": 8, "Int16": 16, "Int32": 32, "Int64": 64, "Integer": 32}
_RANGES = {
    **{kind: (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for kind, n in _BITS.items()},
    **{f"U{kind}": (0, 2**n - 1) for kind, n in _BITS.items() if kind != "Integer"},
    "Enumeration": (-(2**63), 2**63 - 1),
}
_HOLDS = {
    **{kind: limits for kind, limits in _RANGES.items() if kind != "Enumeration"},
    "Float32": (-(2**24), 2**24),
    **dict.fromkeys(_REALS, (-(2**53), 2**53)),
}
"""Whole numbers that a type of an input holds: of floating-point ones, all without a gap."""


def fits(source: PartVariable, target: PartVariable) -> bool:
    """True if every value of an output is a value of an input.

    Enumerations fit if their items are the same, or one of them declares none.
    """
    if source.type == "Enumeration" == target.type:
        return not source.items or not target.items or source.items == target.items
    same = source.type == target.type or {source.type, target.type} <= set(_REALS)
    if same or (source.type == "Float32" and target.type in _REALS):
        return True
    if source.type not in _RANGES or target.type not in _HOLDS:
        return False
    least, most = _range(source)
    lowest, highest = _HOLDS[target.type]
    return lowest <= least and most <= highest


def rounds(source: PartVariable, target: PartVariable) -> bool:
    """True if an output of double precision feeds an input that keeps 24 bits of it."""
    return source.type in _REALS and target.type == "Float32"


def _range(variable: PartVariable) -> tuple[int, int]:
    numbers = [number for _, number in variable.items]
    return (min(numbers), max(numbers)) if numbers else _RANGES[variable.type]
