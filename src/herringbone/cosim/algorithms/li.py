"""Linearly implicit coupling: polynomial forces, one correction with a frozen interface Jacobian.

The forces are polynomials of degree p inside the macro step h, through their values U at the nodes
1/p, ..., 1. A first pass of all parts on predicted values gives G(U); then

    U += (I - S)^-1 (G(U) - U),   S = dG/dU,

all parts are restored and step again. S is found once by finite differences over doStep, and again
when the observed contraction exceeds 0.1. The degree of the polynomial decides the accuracy, not
the iteration: converging further changes nothing, unless the residual says so.

The global error falls with h^(p+1) for odd p + 1 and h^(p+2) for even p, as with the Newton-Cotes
rules of the same nodes: 4, 4, 6 for p = 2, 3, 4. Stable for a bond of frequency w up to about
h w = 3.0, 5.6, 8 (p = 2, 3, 4), nearly independent of damping.

Source: semi-implicit co-simulation in the sense of B. Schweizer and D. Lu, ZAMM 95 (2015) 911-938,
with inner nodes.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

from herringbone.cosim.algorithms.adaptive.control import LARGEST_STEP
from herringbone.cosim.algorithms.adaptive.prepared import PreparedAdaptive
from herringbone.cosim.algorithms.base import Algorithm, option
from herringbone.cosim.algorithms.iterated import PreparedNodes
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.repeating import check_rollback, check_sources
from herringbone.cosim.tolerance import SMALLEST_TOLERANCE, check_tolerance

_MOST = 6
_ORDERS = {1: 2, 2: 4, 3: 4, 4: 6}


@dataclass(frozen=True)
class LI(Algorithm):
    """Linearly implicit coupling: polynomial forces and one correction with a frozen Jacobian.

    Args:
        degree: of the forces inside a macro step, 1 to 4.
        iterations: corrections at the least; more follow while the residual is too large.
        tolerance: relative error (see `analysis.accuracy.error`) for which the macro step adapts
            itself, up to the step of the run; 0 keeps the step. See `step_error` for what it is
            relative to.

    Raises:
        ParameterError: an option is out of its range.
    """

    degree: int = option(3, choices=tuple(_ORDERS))
    iterations: int = option(1, f"1 to {_MOST}")
    tolerance: float = option(0.0, f"between {SMALLEST_TOLERANCE:g} and 1, or 0 for a fixed step")

    name: ClassVar[str] = "li"
    needs: ClassVar[frozenset[str]] = frozenset({"rollback", "nodes"})
    default_step: ClassVar[float] = 4e-5
    default_largest_step: ClassVar[float] = LARGEST_STEP

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 1 <= self.iterations <= _MOST:
            self.refuse("iterations")
        if self.tolerance != 0.0:
            check_tolerance(self.tolerance, "li: tolerance={:g};", ", or be 0 for a fixed step")

    def __str__(self) -> str:
        text = super().__str__()
        return text if self.adaptive else text.rpartition(",")[0]

    @property
    def adaptive(self) -> bool:
        """The macro step follows the tolerance."""
        return self.tolerance > 0.0

    @property
    def passes(self) -> int:
        """The prediction's, and one for each correction."""
        return 1 + self.iterations

    @property
    def accurate_step(self) -> float | None:
        """Measured for one correction with a fixed step."""
        known = {2: 0.713, 3: 1.335, 4: 1.759}
        return known.get(self.degree) if self.iterations == 1 and not self.adaptive else None

    @property
    def multirate(self) -> bool:
        """With a fixed step."""
        return not self.adaptive

    @property
    def start_step(self) -> float:
        """Macro step [s] if none is given; the largest one if it is adaptive."""
        return self.default_largest_step if self.adaptive else self.default_step

    @classmethod
    def variants(cls) -> tuple[Self, ...]:
        """All degrees, two corrections, and an adaptive step."""
        return (*super().variants(), cls(iterations=2), cls(tolerance=1e-3))

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """Degrees from 2: degree 1 costs a rollback for the accuracy of extrapolation."""
        return tuple(cls(degree=p) for p in (2, 3, 4))

    @property
    def convergence_order(self) -> int:
        """2, 4, 4, 6 for degree 1, 2, 3, 4."""
        return _ORDERS[self.degree]

    def prepare(self, network: Network) -> PreparedNodes:
        """Lay out a network for this algorithm."""
        check_rollback(self.name, network, of_all=self.adaptive)
        if self.adaptive:
            check_sources(str(self), network)
            return PreparedAdaptive(
                network,
                self.degree,
                self.convergence_order,
                corrections=self.iterations,
                most=_MOST,
                tolerance=self.tolerance,
            )
        return PreparedNodes(
            network,
            self.degree,
            self.convergence_order,
            newton=True,
            corrections=self.iterations,
            most=_MOST,
        )
