"""Fixed-point iteration with polynomial forces: no Jacobian, but rollback.

The forces are polynomials of degree p inside the macro step h, through their values U at the nodes
1/p, ..., 1; each sweep replaces U by the forces G(U) that follow from the motions it causes. The
iteration contracts like (h w)^2 / 6 for a bond of frequency w and diverges above h w = 2.45,
however many sweeps there are; with 2 sweeps of cubic nodes the test rig is stable up to
h w = 1.67.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

from herringbone.cosim.algorithms.base import Algorithm, option
from herringbone.cosim.algorithms.iterated import PreparedNodes
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.repeating import check_rollback

_MOST = 50
_ORDERS = {1: 2, 2: 4, 3: 4, 4: 6}
_PREDICTED = 3
"""Order of the predicted forces, which are quadratic."""


@dataclass(frozen=True)
class FixedPoint(Algorithm):
    """Fixed-point iteration with polynomial forces.

    Args:
        degree: of the forces inside a macro step, 1 to 4.
        sweeps: passes over all parts, at least 2.

    Raises:
        ParameterError: an option is out of its range.
    """

    degree: int = option(3, choices=(1, 2, 3, 4))
    sweeps: int = option(2, f"2 to {_MOST}")

    name: ClassVar[str] = "fixed_point"
    needs: ClassVar[frozenset[str]] = frozenset({"rollback", "nodes"})
    default_step: ClassVar[float] = 2e-5

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 2 <= self.sweeps <= _MOST:
            self.refuse("sweeps")

    @classmethod
    def variants(cls) -> tuple[Self, ...]:
        """All degrees with two sweeps, and more sweeps where they raise order or accuracy."""
        return (*super().variants(), cls(degree=3, sweeps=3), *(cls(4, n) for n in (3, 4)))

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """Quadratic nodes, and cubic ones with two and three sweeps."""
        return (cls(degree=2), cls(degree=3), cls(degree=3, sweeps=3))

    @property
    def convergence_order(self) -> int:
        """That of the polynomial, if there are enough sweeps.

        The first sweep takes predicted forces, and each one after it gains one power of the step
        (the velocity's share in the force, by dampers).
        """
        return min(_ORDERS[self.degree], _PREDICTED + self.sweeps - 1)

    @property
    def passes(self) -> int:
        """One for each sweep."""
        return self.sweeps

    @property
    def accurate_step(self) -> float | None:
        """Measured for quadratic and cubic nodes with few sweeps."""
        known = {(2, 2): 0.443, (3, 2): 0.454, (3, 3): 0.899}
        return known.get((self.degree, self.sweeps))

    def prepare(self, network: Network) -> PreparedNodes:
        """Lay out a network for this algorithm."""
        check_rollback(self.name, network)
        sweeps = self.sweeps - 1
        return PreparedNodes(
            network,
            self.degree,
            self.convergence_order,
            newton=False,
            corrections=sweeps,
            most=sweeps,
        )
