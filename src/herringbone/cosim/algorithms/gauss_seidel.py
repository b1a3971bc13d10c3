"""Gauss-Seidel coupling: bodies step one after another, in the system's order.

Before a body steps, the elements between it and the bodies that have stepped are evaluated at the
end of the macro step, with the new motion of these and the extrapolated motion of the others. Their
forces are then interpolated for the body. Each part steps once a macro step; the elements' forces
are those at the partly extrapolated motion. Never is one side's position held against the other
side's newer one.

The first steps, without history to extrapolate from, are Jacobi steps: a held angle of a turning
shaft would be a false torque.

Stable for a bond of frequency w up to h w = 0.75 to 1.1 at order 2 (0.25 to 0.75 at order 1),
depending on damping and mass ratio: on these systems no better than Jacobi, because the elements
are parts of their own and are evaluated once a step.

Order q: degree of extrapolation and interpolation.
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from herringbone.cosim.algorithms.base import Algorithm, option
from herringbone.cosim.algorithms.jacobi import Jacobi
from herringbone.cosim.algorithms.staged import Prepared, prepare_stages, refuse_mixed
from herringbone.cosim.structure.network import Network


@dataclass(frozen=True)
class GaussSeidel(Algorithm):
    """Gauss-Seidel coupling.

    Args:
        order: degree of extrapolation and interpolation, 1 or 2.

    Raises:
        ParameterError: the order is out of its range.
    """

    order: int = option(
        2, "1 or 2 (held positions against newer ones are never stable)", choices=(1, 2)
    )

    name: ClassVar[str] = "gauss_seidel"

    @classmethod
    def charted(cls) -> tuple[Self, ...]:
        """Both orders."""
        return tuple(cls(order=q) for q in (1, 2))

    @property
    def convergence_order(self) -> int:
        """Order + 1: both halves of the exchange are polynomials of degree `order`."""
        return self.order + 1

    @property
    def accurate_step(self) -> float:
        """Measured, as in the base."""
        return {1: 0.031, 2: 0.119}[self.order]

    def prepare(self, network: Network) -> Prepared:
        """Stages: sources; then each body, after the elements that its predecessors load.

        Raises:
            ParameterError: a part is body and element at once.
        """
        refuse_mixed(network, self.name)
        stages = [list(network.sources)] if network.sources else []
        done: set[int] = set(network.sources)
        waiting = list(network.elements)
        for body in network.bodies:
            feeds_body = {c.source for c in network.inputs(body)}
            for element in list(waiting):
                neighbours = {c.source for c in network.inputs(element)}
                if element in feeds_body and neighbours & done:
                    stages.append([element])
                    done.add(element)
                    waiting.remove(element)
            stages.append([body])
            done.add(body)
        stages += [[element] for element in waiting]
        prepared = prepare_stages(network, stages, self.order, self.convergence_order)
        starter = Jacobi(self.order).prepare(network).layout
        return replace(prepared, starter=starter._replace(derivatives=prepared.layout.derivatives))
