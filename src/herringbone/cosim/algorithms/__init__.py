"""Coupling algorithms, and how they are named on the command line: `jacobi:order=2`."""

from collections.abc import Iterable
from dataclasses import fields, replace
from typing import Any

from herringbone.core import ParameterError
from herringbone.core.names import meant
from herringbone.cosim.algorithms.base import Algorithm
from herringbone.cosim.algorithms.choice import AUTO, choose_algorithm, start_step
from herringbone.cosim.algorithms.fixed_point import FixedPoint
from herringbone.cosim.algorithms.gauss_seidel import GaussSeidel
from herringbone.cosim.algorithms.jacobi import Jacobi
from herringbone.cosim.algorithms.li import LI
from herringbone.cosim.algorithms.predict import Predict
from herringbone.cosim.tolerance import check_tolerance

__all__ = [
    "ALGORITHMS",
    "AUTO",
    "LI",
    "Algorithm",
    "FixedPoint",
    "GaussSeidel",
    "Jacobi",
    "Predict",
    "adapts",
    "choose_algorithm",
    "parse_algorithm",
    "refuse_adaptive",
    "start_step",
    "tolerance_of",
    "with_tolerance",
]

_TOLERANCE = "tolerance"
ALGORITHMS: dict[str, type[Algorithm]] = {
    a.name: a for a in (Jacobi, GaussSeidel, Predict, FixedPoint, LI)
}


def parse_algorithm(text: str) -> Algorithm:
    """Algorithm from `name` or `name:key=value,key=value`.

    Raises:
        ParameterError: unknown name or option, or a value out of range.
    """
    name, _, options = text.partition(":")
    if name not in ALGORITHMS:
        known = ", ".join([AUTO, *ALGORITHMS])
        hint = meant(name, [AUTO, *ALGORITHMS])
        raise ParameterError(f"there is no algorithm '{name}'; {hint}there are: {known}")
    kind = ALGORITHMS[name]
    types: dict[str, Any] = {f.name: type(f.default) for f in fields(kind)}
    values: dict[str, float | str] = {}
    for item in filter(None, options.split(",")):
        key, _, value = item.partition("=")
        if key not in types:
            known = f"it has: {', '.join(types)}" if types else "it has none"
            raise ParameterError(f"{name} has no option '{key}'; {known}")
        if key in values:
            raise ParameterError(f"{name}: option '{key}' is given twice")
        try:
            values[key] = types[key](value)
        except ValueError:
            number = "a whole number" if types[key] is int else "a number"
            raise ParameterError(
                f"{name}:{item}: it must be {number}, {kind.allowed(key)}; the default is "
                f"{name}:{key}={getattr(kind, key):g}"
            ) from None
    return kind(**values)


def with_tolerance(algorithm: Algorithm, tolerance: float) -> Algorithm:
    """The algorithm, adapting its step to a tolerance.

    Raises:
        ParameterError: it cannot, or has another tolerance already, or this one is out of range.
    """
    if not adapts(type(algorithm)):
        able = " and ".join(name for name, kind in ALGORITHMS.items() if adapts(kind))
        raise ParameterError(
            f"tolerance = {tolerance:g}: {algorithm} keeps its step; only {able} adapts it, which "
            "takes parts that save and restore their state"
        )
    if tolerance_of(algorithm) not in {None, tolerance}:
        raise ParameterError(f"tolerance = {tolerance:g}, but the algorithm is {algorithm}")
    said = f"{algorithm.name}: tolerance={{:g}};"
    check_tolerance(tolerance, said, "; leave it out for a fixed step")
    return replace(algorithm, **{_TOLERANCE: tolerance})


def tolerance_of(algorithm: Algorithm) -> float | None:
    """The tolerance that the algorithm's step follows [1]; None if it keeps its step."""
    return float(getattr(algorithm, _TOLERANCE)) if algorithm.adaptive else None


def adapts(kind: type[Algorithm]) -> bool:
    """True if an algorithm can adapt its step: `tolerance` is one of its options."""
    return any(f.name == _TOLERANCE for f in fields(kind))


def refuse_adaptive(algorithms: Iterable[Algorithm], what: str) -> None:
    """Check that all algorithms keep their step.

    Args:
        algorithms: to check.
        what: that needs it, for the message.

    Raises:
        ParameterError: one adapts it.
    """
    for algorithm in algorithms:
        if algorithm.adaptive:
            raise ParameterError(
                f"{algorithm} adapts its step, but {what}; leave the tolerance out"
            )
