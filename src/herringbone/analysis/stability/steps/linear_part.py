"""A linear component in this process, as a linear analysis runs it."""

from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Part

CHANGE = {
    "m": 1e-9, "m/s": 1e-6, "rad": 1e-7, "rad/s": 1e-3, "N": 1e-2, "N.m": 1e-3,
    "kg^1/2.m": 1e-9, "kg^1/2.m/s": 1e-6,
}  # fmt: skip
"""Differences by unit: small against the mesh deflection (1e-6 m), large against rounding."""
OTHER_CHANGE = 1e-6


def state_changes(instance: Instance) -> list[float]:
    """Differences of a part's states, those of its state vectors last."""
    declaration = instance.component.declaration
    found = [CHANGE.get(v.unit, OTHER_CHANGE) for v in declaration.states]
    for vector in declaration.vectors:
        found += [CHANGE.get(vector.unit, OTHER_CHANGE)] * vector.capacity
    return found


class LinearPart(InProcessPart):
    """A linear component in this process.

    Attributes:
        values: that a step may change; the states come first.
        state_changes: differences of the states.
    """

    residual = 0.0

    def __init__(self, instance: Instance) -> None:
        super().__init__(instance)
        self.values = instance.block[: self.declaration.mutable_size]
        self.state_changes = state_changes(instance)
        self._degree_index = self.declaration.index[INTERFACE_DEGREE]
        self._degree = float(instance.block[self._degree_index])

    @property
    def part(self) -> Part:
        """As the network takes it."""
        return self

    def prepare(self, step: float, degree: int) -> None:
        """Make ready for macro steps of a length [s] at an interface degree."""
        del step
        self.instance.block[self._degree_index] = degree

    def begin(self) -> None:
        """Before each macro step: nothing, it remembers none."""

    def release(self) -> None:
        """After macro steps: the degree is what it was."""
        self.instance.block[self._degree_index] = self._degree

    def learn(self) -> bool:
        """False: it takes steps of any length."""
        return False

    def output_change(self, name: str, change: float) -> float:
        """Difference of an output."""
        del name
        return change
