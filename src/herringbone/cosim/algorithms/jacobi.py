"""Jacobi coupling: all bodies step together on extrapolated forces.

Order q: a body's inputs are the polynomial of degree q through the last q + 1 communication points,
extrapolated over the macro step h. The global error falls with h^(q+1). The first steps use what
history there is, which costs nothing if the forces have no rate at the start, as in equilibrium;
otherwise order 2 falls back to the second power.

Stable for a bond of frequency w and damping ratio zeta (two masses, M. Busch, ZAMM 96, 2016,
1061-1081; limits measured with exact subsystems): h w < 4 zeta (order 0), about 1.85 zeta^(1/3)
(order 1), about 0.95 (order 2).

Elements (bearings, couplings) are stepped after the bodies, over the same interval, with the
bodies' new motions, and so have no delay. With `schedule=parallel` they step together with the
bodies, on the values at the start of the macro step, as in masters that step all FMUs in parallel;
that costs one step of delay and a bond limit of h w < 4/3 zeta at order 0.
"""

from dataclasses import dataclass
from typing import ClassVar, Literal, Self

from herringbone.cosim.algorithms.base import Algorithm, option
from herringbone.cosim.algorithms.staged import Prepared, prepare_stages
from herringbone.cosim.structure.network import Network


@dataclass(frozen=True)
class Jacobi(Algorithm):
    """Jacobi coupling.

    Args:
        order: degree of extrapolation, 0 (hold) to 2.
        schedule: "bodies_first", or "parallel" as other masters do.

    Raises:
        ParameterError: an option is out of its range.
    """

    order: int = option(2, choices=(0, 1, 2))
    schedule: Literal["bodies_first", "parallel"] = option(
        "bodies_first", choices=("bodies_first", "parallel")
    )

    name: ClassVar[str] = "jacobi"

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """All orders, elements after the bodies."""
        return tuple(cls(order=q) for q in (0, 1, 2))

    @property
    def convergence_order(self) -> int:
        """Order + 1; 1 in the parallel schedule, because of the elements' delay."""
        return self.order + 1 if self.schedule == "bodies_first" else 1

    @property
    def accurate_step(self) -> float | None:
        """Orders 1 and 2; order 0 errs more than 0.1 % at every step of the charts."""
        return {1: 0.032, 2: 0.122}.get(self.order) if self.schedule == "bodies_first" else None

    @property
    def multirate(self) -> bool:
        """If elements are stepped after the bodies."""
        return self.schedule == "bodies_first"

    def prepare(self, network: Network) -> Prepared:
        """Stages: sources; bodies; elements one after another."""
        if self.schedule == "parallel":
            everything = network.by_answer(range(len(network.parts)))
            return prepare_stages(
                network, [everything], self.order, self.convergence_order, parallel=True
            )
        bodies = network.by_answer(network.bodies)
        stages = [network.sources, bodies, *([e] for e in network.elements)]
        used = [s for s in stages if s]
        return prepare_stages(network, used, self.order, self.convergence_order)
