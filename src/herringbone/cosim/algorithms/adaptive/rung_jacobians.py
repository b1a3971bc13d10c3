"""Interface Jacobians of the steps of a ladder: measured on some rungs, derived on the others."""

from collections.abc import Mapping

import numpy as np

from herringbone.cosim.algorithms.jacobian import correction_matrix
from herringbone.cosim.checkpoint.run_state import Arrays
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS

_SAVED = "sensitivity."
"""Begins the names of what a checkpoint keeps; the number of a rung follows."""


class RungJacobians:
    """Jacobians (unknowns p, unknowns p) by rung, and the corrections that follow from them."""

    def __init__(self) -> None:
        self._measured: dict[int, np.ndarray] = {}

    @property
    def none(self) -> bool:
        """True as long as none is measured."""
        return not self._measured

    def keep(self, rung: int, measured: np.ndarray) -> None:
        """Keep that of a rung, in place of an older one."""
        self._measured[rung] = measured

    def correction(self, rung: int, t: float, h: float) -> np.ndarray:
        """See `correction_matrix`; from the rung's own Jacobian, or from one derived.

        Args:
            rung: whose.
            t, h: start and length of its step [s].

        Raises:
            CouplingError: the matrix is singular.
        """
        own = self._measured.get(rung)
        return correction_matrix(fitted(self._measured, rung) if own is None else own, t, h)

    def saved(self) -> Arrays:
        """What is needed to go on with the same bits, by name."""
        return {f"{_SAVED}{rung}": jacobian for rung, jacobian in self._measured.items()}

    def put(self, saved: Mapping[str, np.ndarray]) -> None:
        """Go on from there; other names are passed over."""
        names = (name for name in saved if name.startswith(_SAVED))
        self._measured = {int(name.removeprefix(_SAVED)): saved[name].copy() for name in names}


def fitted(known: Mapping[int, np.ndarray], rung: int) -> np.ndarray:
    """S(h) = a h + b h^2 through the nearest rungs with a Jacobian; b h^2 through one.

    Args:
        known: Jacobians (unknowns p, unknowns p) by rung; at least one.
        rung: that has none.
    """
    near = sorted(known, key=lambda k: abs(k - rung))[:2]
    h = RUNGS[rung]
    if len(near) == 1:
        return (h / RUNGS[near[0]]) ** 2 * known[near[0]]
    one, two = (RUNGS[k] for k in near)
    first, second = (known[k] / RUNGS[k] for k in near)
    return h * (first + (h - one) / (two - one) * (second - first))
