"""Parts as a linear analysis runs them: what takes many micro steps becomes one affine map.

A linear part maps (states, inputs at the nodes) to (states, outputs at the nodes) by an affine map
that depends on the macro step and the interface degree alone. Made once, of differences of the
part's own steps, it replaces hundreds of micro steps in each of the hundreds of steps that an
amplification matrix takes; what is found is the same to rounding. The differences are those of a
few micro steps (see `micro_steps`), and those of the whole step where a trial contradicts these.
"""

import ctypes
import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from herringbone.analysis.stability.steps.linear_part import (
    CHANGE,
    OTHER_CHANGE,
    LinearPart,
    state_changes,
)
from herringbone.analysis.stability.steps.micro_steps import Rows, composed
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import HerringboneError, Instance
from herringbone.core.declaring.declaration import node_name
from herringbone.core.declaring.variable import NODES
from herringbone.core.part import Addresses, PartVariable
from herringbone.kernels.steppers import MOST_MICRO_STEPS
from herringbone.kernels.stepping import affine_step
from herringbone.kernels.stepping.affine_step import HEADER

_SAME = 1e-9
"""Of a micro step: what steppers take for rounding of a length."""
_FEW = 2
"""Parts of a macro step that are not worth composing."""
_ALIKE, _ROUNDING = 1e-6, 1e-13
"""Deviation of a composed map from the part's own step, over what moves and over values there."""


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
        self._entries, self._results = cache(self._found_entries), cache(self._found_results)
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
        """Make the map.

        Raises:
            HerringboneError: the component fails within the step.
        """
        super().prepare(step, degree)
        block, point = self.instance.block, self._operating_point
        kept = block[: point.size].copy()
        inputs, _ = self._entries(degree)
        outputs = self._results(degree)
        base = self._advanced(step, outputs)
        columns = self._columns(step, degree, base)
        block[: kept.size] = kept
        self._memory[:2] = inputs.size, outputs.size
        found = (inputs + HEADER, point[inputs], outputs + HEADER, base, columns.ravel())
        flat = np.concatenate(found)
        self._map[: flat.size] = flat

    def _advanced(
        self,
        step: float,
        outputs: np.ndarray,
        entries: np.ndarray | int = 0,
        change: ArrayLike = 0.0,
    ) -> np.ndarray:
        """Values after a step from the operating point, of which entries are changed."""
        block, point = self.instance.block, self._operating_point
        block[: point.size] = point
        block[entries] += change
        if self.instance.step(0.0, step):
            raise HerringboneError(f"{self.name} fails in one step of {step:g} s")
        return block[outputs]

    def _columns(self, step: float, degree: int, base: np.ndarray) -> np.ndarray:
        """(inputs, outputs) of a step, composed of those of a few micro steps if that is right."""
        intervals = max(degree, 1)
        parts = step * MOST_MICRO_STEPS / (intervals * self.instance.longest_step())
        if parts > _FEW:
            count = math.ceil(parts - _SAME)
            part = self._measured(step / count, degree)
            found = composed(part.T, self._rows(degree), degree, count)
            if self._is_own(found, step, degree, base):
                return found.T
        return self._measured(step, degree)

    def _measured(self, step: float, degree: int) -> np.ndarray:
        """(inputs, outputs) by differences of the part's own steps."""
        outputs = self._results(degree)
        base = self._advanced(step, outputs)
        moved = [
            (self._advanced(step, outputs, entry, change) - base) / change
            for entry, change in zip(*self._entries(degree), strict=True)
        ]
        return np.array(moved)

    def _is_own(self, matrix: np.ndarray, step: float, degree: int, base: np.ndarray) -> bool:
        """True if a matrix (outputs, inputs) tells a step for which all inputs are changed."""
        entries, changes = self._entries(degree)
        changed = changes * np.random.default_rng(0).uniform(-1.0, 1.0, len(changes))
        moved = self._advanced(step, self._results(degree), entries, changed) - base
        allowed = _ALIKE * np.abs(matrix) @ np.abs(changed) + _ROUNDING * np.abs(base)
        return bool((np.abs(moved - matrix @ changed) <= allowed).all())

    def _found_entries(self, degree: int) -> tuple[np.ndarray, list[float]]:
        """Indices of states and of inputs at the live nodes, and their differences."""
        declaration = self.declaration
        entries, changes = list(range(declaration.state_count)), state_changes(self.instance)
        for v in declaration.inputs:
            for node in range(degree + 1):
                entries.append(declaration.index[node_name(v.name, node) if node else v.name])
                changes.append(CHANGE.get(v.unit, OTHER_CHANGE))
        return np.array(entries), changes

    def _rows(self, degree: int) -> Rows:
        """What the rows of a map are, see `_results`."""
        declaration = self.declaration
        nodes, ends, at = [], [], declaration.state_count
        for v in declaration.outputs:
            inner = degree if v.nodes else 0
            if inner:
                nodes.append(np.arange(at, at + inner))
            ends.append(at + inner)
            at += inner + 1
        shape = len(nodes), max(degree, 1)
        return Rows(declaration.state_count, np.reshape(nodes, shape).T.astype(int), np.array(ends))

    def _found_results(self, degree: int) -> np.ndarray:
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
