"""Parts as a linear analysis runs them: what takes many micro steps becomes one affine map.

A linear part maps (states, inputs at the nodes) to (states, outputs at the nodes) by an affine map
that depends on the macro step and the interface degree alone. Measured once, by differences of the
part's own steps, it replaces hundreds of micro steps in each of the hundreds of steps that an
amplification matrix takes; what is found is the same to rounding.
"""

import ctypes
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from herringbone.analysis.stability.surrogates.surrogate_part import StandIn
from herringbone.components.in_process import InProcessPart
from herringbone.core import HerringboneError, Instance
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.declaring.variable import NODES
from herringbone.core.part import Addresses, Part, PartVariable
from herringbone.kernels.stepping import affine_step
from herringbone.kernels.stepping.affine_step import HEADER

CHANGE = {
    "m": 1e-9, "m/s": 1e-6, "rad": 1e-7, "rad/s": 1e-3, "N": 1e-2, "N.m": 1e-3,
    "kg^1/2.m": 1e-9, "kg^1/2.m/s": 1e-6,
}  # fmt: skip
"""Differences by unit: small against the mesh deflection (1e-6 m), large against rounding."""
OTHER_CHANGE = 1e-6


def _state_changes(instance: Instance) -> list[float]:
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
        self.state_changes = _state_changes(instance)
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


class MappedPart(LinearPart):
    """A linear component whose macro step is an affine map.

    Args:
        instance: at its operating point; it is left as it was.
    """

    def __init__(self, instance: Instance) -> None:
        super().__init__(instance)
        declaration = self.declaration
        self._inputs = declaration.state_count + len(declaration.inputs) * (NODES + 1)
        self._outputs = declaration.mutable_size
        place = HEADER + declaration.mutable_size
        room = affine_step.map_length(self._inputs, self._outputs)
        self._memory = np.zeros(place + room)
        self._memory[2] = place
        self.values = self._memory[HEADER:place]
        self.values[:] = instance.block[: declaration.mutable_size]
        first, count = declaration.first_input, len(declaration.inputs)
        signals = self.values[first : first + count * (NODES + 1)].reshape(count, NODES + 1)
        signals[:, 1:] = signals[:, :1]
        self._operating_point = self.values.copy()
        self._map = self._memory[place:]
        self.variables: Mapping[str, PartVariable] = {
            name: replace(v, reference=v.reference + HEADER)
            for name, v in self.variables.items()
            if v.is_real
        }

    @property
    def addresses(self) -> Addresses:
        """As in-process, on the map's memory."""
        memory = self._memory.ctypes.data_as(ctypes.c_void_p).value or 0
        return super().addresses._replace(component=memory)

    @property
    def _do_step(self) -> int:
        """Of the map: the component's own is not compiled."""
        return affine_step.affine_step.address

    def new_state(self) -> int:
        """Memory for a saved state: header and values."""
        count = HEADER + self.values.size
        self._states.append(np.zeros(1 + count))
        self._states[-1][0] = count
        return self._states[-1].ctypes.data

    def prepare(self, step: float, degree: int) -> None:
        """Measure the map.

        Raises:
            HerringboneError: the component fails within the step.
        """
        super().prepare(step, degree)
        block, point = self.instance.block, self._operating_point
        kept = block[: point.size].copy()
        inputs, changes = self._entries(degree)
        outputs = self._results(degree)

        def advance(entry: int, change: float) -> np.ndarray:
            block[: point.size] = point
            block[entry] += change
            if self.instance.step(0.0, step):
                raise HerringboneError(f"{self.name} fails in one step of {step:g} s")
            return block[outputs]

        base = advance(0, 0.0)
        columns = [
            (advance(entry, change) - base) / change
            for entry, change in zip(inputs, changes, strict=True)
        ]
        block[: kept.size] = kept
        self._memory[:2] = inputs.size, outputs.size
        found = (
            inputs + HEADER,
            point[inputs],
            outputs + HEADER,
            base,
            np.array(columns).ravel(),
        )
        flat = np.concatenate(found)
        self._map[: flat.size] = flat

    def _entries(self, degree: int) -> tuple[np.ndarray, list[float]]:
        """Indices of states and of inputs at the live nodes, and their differences."""
        declaration = self.declaration
        entries, changes = list(range(declaration.state_count)), _state_changes(self.instance)
        for v in declaration.inputs:
            for node in range(degree + 1):
                entries.append(declaration.index[node_name(v.name, node) if node else v.name])
                changes.append(CHANGE.get(v.unit, OTHER_CHANGE))
        return np.array(entries), changes

    def _results(self, degree: int) -> np.ndarray:
        """Indices of states and of outputs, with their live nodes."""
        declaration = self.declaration
        found = list(range(declaration.state_count))
        for v in declaration.outputs:
            nodes = degree if v.nodes else 0
            found += [declaration.index[node_name(v.name, n)] for n in range(1, nodes + 1)]
            found.append(declaration.index[v.name])
        return np.array(found)


Linear = LinearPart | StandIn
"""A part as a linear analysis runs it."""


def linear_part(of: Instance | StandIn) -> Linear:
    """A map for a component that takes micro steps, else the component itself, or the stand-in."""
    if isinstance(of, StandIn):
        return of
    mapped = "micro_step" in of.component.declaration.index
    return MappedPart(of) if mapped else LinearPart(of)
