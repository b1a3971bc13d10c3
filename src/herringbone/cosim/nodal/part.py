"""A part that holds its inputs, as one that takes and gives polynomial signals."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from herringbone.core import FmuError
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, node_name
from herringbone.core.declaring.variable import NODES
from herringbone.core.part import Addresses, Part, PartVariable, ValueOrArray
from herringbone.cosim.adapter import PartAdapter
from herringbone.cosim.nodal import calls
from herringbone.cosim.nodal.memory import MEMORY
from herringbone.cosim.signature.amplitudes import amplitude
from herringbone.cosim.signature.signature import Kind, Signature
from herringbone.kernels.signals import STRIDE

_ADDRESSES = {*Addresses._fields[:7], "get_later", "finish"}


class NodalPart(PartAdapter):
    """An adapter in front of a part; see `nodal.calls`. The part belongs to it.

    Args:
        part: not initialised, without nodes of its own.
        signature: of it, with known feedthrough.
        pieces: steps of the part from node to node, 1 or 2; see `nodal.held`. Without memory one.
    """

    def __init__(self, part: Part, signature: Signature, pieces: int = 2) -> None:
        super().__init__(part)
        self.signature: Signature = signature
        self._inputs, self._outputs = signature.inputs, signature.outputs
        self._pieces = pieces
        self.has_states = signature.kind is not Kind.ELEMENT
        self.variables = self._variables()
        self._memory = self._make_memory(pieces)

    def _variables(self) -> dict[str, PartVariable]:
        known, passed = self.part.variables, self.signature.dependencies()
        found = {name: v for name, v in known.items() if name not in self._outputs}
        degree = PartVariable(INTERFACE_DEGREE, 0, "parameter", "1")
        found[INTERFACE_DEGREE] = degree
        for number, name in enumerate((*self._inputs, *self._outputs)):
            v = known[name]
            if name in self._outputs:
                direct = passed[name]
                if direct is None:  # of an element all, of a body what the coupling finds
                    direct = frozenset() if self.has_states else frozenset(self._inputs)
                v = replace(v, dependencies=direct)
            for node in range(NODES + 1):
                own = name if node == 0 else node_name(name, node)
                array = "" if node else v.array
                reference = number * STRIDE + node
                found[own] = replace(v, name=own, reference=reference, array=array)
        return found

    def _make_memory(self, pieces: int) -> np.ndarray:
        n, m = len(self._inputs), len(self._outputs)
        known = self.part.variables
        rate = np.array(self.signature.rate_inputs or [-1] * n, np.int64)
        self._arrays = {
            "input_references": np.array([known[x].reference for x in self._inputs], np.uint32),
            "output_references": np.array([known[x].reference for x in self._outputs], np.uint32),
            "given": np.zeros((n, STRIDE)),
            "driven": np.zeros(n, np.int64),
            "coefficients": np.zeros((n, STRIDE)),
            "order": _rates_first(rate),
            "all_held": np.zeros((STRIDE, 2, n)),
            "packed": np.zeros(n),
            "packed_references": np.zeros(n, np.uint32),
            "all_raw": np.zeros((STRIDE, m)),
            "values": np.zeros((m, STRIDE)),
            "feedthrough": np.nan_to_num(self.signature.feedthrough),
            "place": np.array(self.signature.given or [0] * n, np.int64),
            "rate": rate,
            "seen_held": np.zeros((STRIDE, 2, n)),
            "seen_raw": np.zeros((STRIDE, m)),
            "answer": np.zeros((m, n)),
            "changes": np.array([amplitude(known[x], 0.0) for x in self._inputs]),
            "responses": np.zeros((5, m)),
            "trial_state": np.array([self.part.new_state()], np.int64),
            "taken": np.zeros((n, STRIDE)),
            "answers": np.zeros((m, STRIDE)),
            "missed": np.zeros(n),
        }
        memory = np.zeros(1, MEMORY)
        memory["inputs"], memory["outputs"] = n, m
        memory["at_end"] = not self.has_states
        memory["pieces"] = pieces if self.has_states else 1
        memory["watched"] = self.has_states and self.signature.restores is True
        memory["suspected"] = 1  # what states answer is not known yet
        memory["seen_time"] = memory["taken_time"] = memory["state_time"] = np.nan
        memory["once"] = self.answers_again
        for name, array in self._arrays.items():
            memory[name] = array.ctypes.data
        memory["held"], memory["raw"] = memory["all_held"], memory["all_raw"]
        for name, address in self.part.addresses._asdict().items():
            if name in _ADDRESSES:
                memory[name] = address
        return memory

    def in_front_of(self, part: Part, *, linear: bool = False) -> "NodalPart":
        """The same adapter in front of another part with the same variables.

        Args:
            part: the other one.
            linear: its feedthrough stays as it is, and is not watched.
        """
        adapter = NodalPart(part, self.signature, self._pieces)
        if linear:
            adapter._memory["watched"] = 0
        return adapter

    def carry_in(self, missed: np.ndarray) -> None:
        """Keep what a step has missed (n,) in an array of the caller's, see `nodal.once`."""
        self._arrays["missed"] = missed
        self._memory["missed"] = missed.ctypes.data

    def forget_step(self) -> None:
        """The next step is none that was taken already, though it may begin at the same time."""
        self.last_step[:] = np.nan

    def look_again(self) -> None:
        """D is measured anew before the next step, if it is watched; see `nodal.watch`."""
        self._memory["suspected"], self._memory["resting"] = 1, 0

    @property
    def last_step(self) -> np.ndarray:
        """(1,) when it began [s], NaN if there is none to take again; a view of what is known."""
        return self._memory["taken_time"]

    @property
    def answers_again(self) -> bool:
        """True if the part cannot repeat a step; see `nodal.once`."""
        return not (self.part.addresses.can_restore and self.signature.restores)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapter; the component is its memory."""
        functions = [calls.set_real, calls.get_real, calls.do_step]
        if not self.answers_again:
            functions += [calls.get_state, calls.set_state, calls.free_state]
        found = Addresses(self._memory.ctypes.data, *(f.address for f in functions))
        return found._replace(answers_later=int(self.part.addresses.finish != 0))

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable of the part, or the degree of the signals."""
        if name == INTERFACE_DEGREE:
            self._memory["degree"] = int(float(value))  # type: ignore[arg-type]  # a number
        elif name in self.part.variables:  # nodes of inputs that nothing feeds need no value
            self.part.set(name, value)

    def exit_initialization(self) -> None:
        """See `Part`. A rate that nothing feeds stays as it starts, and its integral goes on."""
        for k in {k for k in self._arrays["rate"].tolist() if k >= 0}:
            with suppress(FmuError):  # what cannot be read starts at 0
                self._arrays["given"][k] = self.part.get([self._inputs[k]])[0]
        super().exit_initialization()

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


def _rates_first(rate: np.ndarray) -> np.ndarray:
    """(n,) inputs, each after its rate, whose number stands in `rate`; -1: it has none."""
    depth = np.zeros(rate.size, np.int64)
    for _ in range(rate.size):
        depth = np.where(rate >= 0, 1 + depth[rate], 0)
    return np.argsort(depth, kind="stable").astype(np.int64)
