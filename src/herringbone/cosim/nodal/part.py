"""A part that holds its inputs, as one that takes and gives polynomial signals."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from herringbone.core.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.part import Addresses, Part, PartVariable
from herringbone.core.variable import NODES
from herringbone.cosim.nodal import calls
from herringbone.cosim.signature.signature import Kind, Signature
from herringbone.kernels.signals import STRIDE

_ADDRESSES = Addresses._fields[:7]


class NodalPart:
    """An adapter in front of a part; see `nodal.calls`. The part belongs to it.

    Args:
        part: not initialised, without nodes of its own.
        signature: of it, with known feedthrough.
        pieces: steps of the part per node.
    """

    def __init__(self, part: Part, signature: Signature, pieces: int = 1) -> None:
        self.name, self.part, self.signature = part.name, part, signature
        self._inputs, self._outputs = signature.inputs, signature.outputs
        self._pieces = pieces
        self.has_states: bool | None = signature.kind is not Kind.ELEMENT
        self.once, self.one_step = part.once, part.one_step
        self.variables: Mapping[str, PartVariable] = self._variables()
        self._memory = self._make_memory(pieces)

    def _variables(self) -> dict[str, PartVariable]:
        known, passed = self.part.variables, self.signature.dependencies()
        found = {name: v for name, v in known.items() if name not in self._outputs}
        degree = PartVariable(INTERFACE_DEGREE, 0, "parameter", "1")
        found[INTERFACE_DEGREE] = degree
        for number, name in enumerate((*self._inputs, *self._outputs)):
            v = known[name]
            if name in self._outputs:
                v = replace(v, dependencies=passed[name])
            for node in range(NODES + 1):
                own = name if node == 0 else node_name(name, node)
                found[own] = replace(v, name=own, reference=number * STRIDE + node)
        return found

    def _make_memory(self, pieces: int) -> np.ndarray:
        n, m = len(self._inputs), len(self._outputs)
        known = self.part.variables
        self._arrays = {
            "input_references": np.array([known[x].reference for x in self._inputs], np.uint32),
            "output_references": np.array([known[x].reference for x in self._outputs], np.uint32),
            "given": np.zeros((n, STRIDE)),
            "driven": np.zeros(n, np.int64),
            "coefficients": np.zeros((n, STRIDE)),
            "held": np.zeros(n),
            "packed": np.zeros(n),
            "packed_references": np.zeros(n, np.uint32),
            "raw": np.zeros(m),
            "values": np.zeros((m, STRIDE)),
            "feedthrough": np.nan_to_num(self.signature.feedthrough),
            "place": np.array(self.signature.given or [0] * n, np.int64),
            "rate": np.array(self.signature.rate_inputs or [-1] * n, np.int64),
        }
        memory = np.zeros(1, calls.MEMORY)
        memory["inputs"], memory["outputs"], memory["pieces"] = n, m, pieces
        memory["at_end"] = not self.has_states
        for name, array in self._arrays.items():
            memory[name] = array.ctypes.data
        for name, address in self.part.addresses._asdict().items():
            if name in _ADDRESSES:
                memory[name] = address
        return memory

    def in_front_of(self, part: Part) -> "NodalPart":
        """The same adapter in front of another part with the same variables."""
        return NodalPart(part, self.signature, self._pieces)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapter; the component is its memory."""
        functions = [calls.set_real, calls.get_real, calls.do_step]
        if self.part.addresses.can_restore and self.signature.restores:
            functions += [calls.get_state, calls.set_state, calls.free_state]
        return Addresses(self._memory.ctypes.data, *(f.address for f in functions))

    def new_state(self) -> int:
        """See `Part`."""
        return self.part.new_state()

    def set(self, name: str, value: float | str) -> None:
        """Set a variable of the part, or the degree of the signals."""
        if name == INTERFACE_DEGREE:
            self._memory["degree"] = int(value)
        elif name in self.part.variables:  # nodes of inputs that nothing feeds need no value
            self.part.set(name, value)

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables of the part, and of its signals' nodes, which only this has."""
        return [
            self.part.get([name])[0] if name in self.part.variables else self._node(name)
            for name in names
        ]

    def _node(self, name: str) -> float:
        """Value of a signal at a node, as it was given or found last."""
        number, node = divmod(self.variables[name].reference, STRIDE)
        inputs = len(self._inputs)
        if number < inputs:
            return float(self._arrays["given"][number, node])
        return float(self._arrays["values"][number - inputs, node])

    def enter_initialization(self, start_time: float, stop_time: float) -> None:
        """See `Part`."""
        self.part.enter_initialization(start_time, stop_time)

    def exit_initialization(self) -> None:
        """See `Part`."""
        self.part.exit_initialization()

    def failed(self) -> None:
        """See `Part`."""
        self.part.failed()

    def messages(self) -> list[str]:
        """See `Part`."""
        return self.part.messages()

    def close(self) -> None:
        """See `Part`."""
        self.part.close()
