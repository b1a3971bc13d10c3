"""The laws of a component: what is not linear in its equations, declared apart from the rest."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from herringbone.core.declaring.component import unchanged

Gather = Callable[[np.ndarray, np.ndarray], None]
Evaluate = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray], None]
Apply = Callable[[np.ndarray, float, np.ndarray, np.ndarray], None]


def _always(block: np.ndarray) -> bool:
    del block
    return True


def _nothing(block: np.ndarray) -> str:
    del block
    return ""


def _evenly(block: np.ndarray) -> tuple[tuple[int, Fraction], ...]:
    del block
    return ()


def _at_once(block: np.ndarray, turns: float) -> None:
    del block, turns


def _untabulated(block: np.ndarray, count: int) -> str:
    del block, count
    return "its laws take no table"


def common_period(periods: Iterable[Fraction]) -> Fraction:
    """The smallest turn that all of the periods, at least one, divide; they are positive."""
    found = list(periods)
    whole = math.lcm(*(period.numerator for period in found))
    return Fraction(whole, math.gcd(*(period.denominator for period in found)))


@dataclass(frozen=True)
class Laws:
    """A component's equations, taken apart.

    `gather`, `evaluate` and `apply`, one after the other, do what the component's `rhs` does, and
    write its outputs that others use. With the values f given, derivatives and outputs are affine
    in states, inputs and f; arguments are affine in states and inputs. Whoever takes the equations
    apart checks that.

    Attributes:
        arguments: names of what the laws depend on, z.
        values: names of what they give, f.
        stiff: of each tangent, the value that it is of. Other values change little over a step.
        kinks: number of indicators; the laws are not smooth where one of them changes its sign.
        gather: kernel (b, z), writes the arguments from states and inputs.
        evaluate: kernel (b, z, f, k, e), writes values, tangents and indicators; it may overwrite
            states and inputs of the block. Values are exact; tangents are for iterations, and may
            leave out what is small.
        apply: kernel (b, t, f, dx), writes outputs and derivatives of the states.
        directions: (tangents, arguments), along which the tangents are: k is the derivative of
            f[stiff] over directions . z.
        mean: (tangents,), their means, from parameters and tables alone.
        prepare: kernel, writes into a block what follows from its parameters, before the others.
        needed: False if the component is linear with the parameters of a block.
        sharp: (n, arguments), directions along which the values change fast: along others,
            arguments may be interpolated over a step where the tolerance allows it; `directions`
            if not given.
        fine: (n, arguments), further ones, needed where errors far below 1e-3 are wanted.
        clock: place in the block of the time [s] of what is evaluated, if the laws depend on it.
        refusal: why a block's equations cannot be taken apart; empty if they can.
        periods: arguments that are angles, and the turn after which the values repeat, in whole
            turns of 2 pi, one for each order with which they excite; none: the laws depend on no
            angle. Of a prepared, settled block.
        settle: ends in a block what comes in over a time or an angle, as ramps do.
        ramp: brings in over so many turns, after `settle`, what comes in over an angle; inf: never.
        keep_harmonics: keeps, in a block, so many harmonics of the tables that the values are taken
            from, over the period of these; says why it cannot, with the block as it was.
    """

    arguments: tuple[str, ...]
    values: tuple[str, ...]
    stiff: tuple[int, ...]
    kinks: int
    gather: Gather
    evaluate: Evaluate
    apply: Apply
    directions: Callable[[np.ndarray], np.ndarray]
    mean: Callable[[np.ndarray], np.ndarray]
    prepare: Callable[[np.ndarray], None] = unchanged
    needed: Callable[[np.ndarray], bool] = _always
    sharp: Callable[[np.ndarray], np.ndarray] | None = None
    fine: Callable[[np.ndarray], np.ndarray] | None = None
    clock: int | None = None
    refusal: Callable[[np.ndarray], str] = _nothing
    periods: Callable[[np.ndarray], tuple[tuple[int, Fraction], ...]] = _evenly
    settle: Callable[[np.ndarray], None] = unchanged
    ramp: Callable[[np.ndarray, float], None] = _at_once
    keep_harmonics: Callable[[np.ndarray, int], str] = _untabulated
