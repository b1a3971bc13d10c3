"""The interface Jacobian of the iterated algorithms, and the correction that follows from it."""

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetri

from herringbone.core import HerringboneError
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.layouts.layout import Layout
from herringbone.cosim.layouts.nodes import Buffers, NodeLayout
from herringbone.cosim.layouts.reach import reach_of
from herringbone.cosim.loops.node_jacobian import sensitivity
from herringbone.cosim.structure.network import Network

PREDICTION = 2
"""Degree of the prediction; one correction makes the result nearly independent of it."""
ALIKE = 1e-6
"""A repeated step may differ by this share of the largest signal of the same unit."""
NOTHING = 1e-9
"""Below this, in SI units, signals of a unit are rounding of what stands still: the reference of
levels of velocity (ISO 1683)."""
_CHANGE = 1e-4


class CouplingError(HerringboneError):
    """The coupling cannot go on; it becomes the outcome of the run."""


class StepRefusedError(CouplingError):
    """A part failed in the step of a Jacobian; a smaller one may do."""


class InterfaceJacobian:
    """Jacobians dG/dU of a network by differences over doStep.

    Args:
        network: parts and connections.
        layout, nodes: of the network.
        outputs: connected outputs of each part.
    """

    def __init__(
        self, network: Network, layout: Layout, nodes: NodeLayout, outputs: list[list[str]]
    ) -> None:
        self.network, self.layout, self.nodes = network, layout, nodes
        self._reach = reach_of(layout, nodes)
        self.owners = [(p, name) for p, names in enumerate(outputs) for name in names]
        units = [network.parts[p].variables[name].unit for p, name in self.owners]
        kinds = list(dict.fromkeys(units))
        self._kind = np.array([kinds.index(unit) for unit in units], dtype=np.int64)

    def measure(
        self, buffers: Buffers, size: np.ndarray, t: float, h: float, known: int
    ) -> np.ndarray:
        """The Jacobian (unknowns p, unknowns p) of a macro step; all parts are restored after.

        Args:
            buffers: of the run.
            size: of each unknown; the differences are 1e-4 of it.
            t, h: start and length of the step [s].
            known: communication points passed, the start included.

        Raises:
            StepRefusedError: a part fails.
            CouplingError: a part does not repeat a step alike.
        """
        count = self.nodes.degree * self.nodes.unknown.size
        jacobian, off = np.zeros((count, count)), np.zeros(len(self.owners))
        saved, room = buffers.history.copy(), (buffers.rest.copy(), buffers.nodes.copy())
        failed = sensitivity(
            self.layout, self.nodes, buffers, self._reach, jacobian, off, _CHANGE * size, *room,
            PREDICTION, t, h, known,
        )  # fmt: skip
        buffers.history[:] = saved
        if failed >= 0 or not np.isfinite(jacobian).all():
            raise StepRefusedError(
                f"the interface Jacobian cannot be computed at {t:g} s: {self._who_fails(failed)}; "
                "use another step"
            )
        self._check_repetition(buffers, off, t)
        jacobian[np.tile(self.nodes.settled != 0, self.nodes.degree)] = 0.0
        return jacobian

    def _who_fails(self, failed: int) -> str:
        """The part of that number, with what it says of it; the coupling, if negative."""
        if failed < 0:
            return "the coupling fails"
        part = self.network.parts[failed]
        said = "; ".join(part.messages())
        return f"{part.name} fails" + (f": {said}" if said else "")

    def _check_repetition(self, buffers: Buffers, off: np.ndarray, t: float) -> None:
        largest = np.abs(buffers.nodes).max(axis=0, initial=0.0)
        by_kind = np.zeros(self._kind.max(initial=-1) + 1)
        np.maximum.at(by_kind, self._kind, largest)
        wrong = off > ALIKE * np.maximum(by_kind, NOTHING)[self._kind]
        for p in (*self.network.bodies, *self.network.elements):
            for i, (owner, name) in enumerate(self.owners):
                if owner == p and wrong[i]:
                    raise CouplingError(
                        f"{self.network.parts[p].name} is not deterministic: its step at {t:g} s, "
                        f"repeated from a restored state, changes {name} by {off[i]:.3g}; "
                        "use jacobi or gauss_seidel, which repeat no step"
                    )


def correction_matrix(jacobian: np.ndarray, t: float, h: float) -> np.ndarray:
    """(I - dG/dU)^-1 for a macro step h at t [s], by columns: it is the transposed one.

    Raises:
        CouplingError: the matrix is singular.
    """
    if jacobian.size == 0:
        return jacobian.copy()
    with one_blas_thread():  # threads wait for each other far longer
        factors, pivots, singular = dgetrf(np.eye(len(jacobian)) - jacobian)
        inverse, _ = dgetri(factors, pivots) if singular == 0 else (factors, 0)
    if singular:
        raise CouplingError(
            f"the interface Jacobian is singular at {t:g} s (h = {h:g} s); "
            "use another step, or fixed_point"
        )
    return inverse.T  # LAPACK writes columns
