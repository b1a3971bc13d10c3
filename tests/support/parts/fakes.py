"""Participants in plain Python behind C addresses: the algorithms know no component."""

import ctypes
from dataclasses import dataclass, field

from herringbone.core import ParameterError
from herringbone.core.part import Addresses, PartVariable

OK, DISCARD, ERROR = 0, 2, 3
NODES = 4
DEGREE = "interface_degree"

_REALS = ctypes.POINTER(ctypes.c_double)
_REFERENCES = ctypes.POINTER(ctypes.c_uint32)
_EXCHANGE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, _REFERENCES, ctypes.c_size_t, _REALS)
_DO_STEP = ctypes.CFUNCTYPE(
    ctypes.c_int32, ctypes.c_void_p, ctypes.c_double, ctypes.c_double, ctypes.c_int32
)

_HANDLE = ctypes.POINTER(ctypes.c_int64)
_SAVE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, _HANDLE)
_RESTORE = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_void_p, ctypes.c_int64)

UNIT = {"s": "m", "v": "m/s", "a": "m/s2", "f": "N"}


@dataclass
class FakePart:
    """Only a name and variables, for tests of structure."""

    name: str
    variables: dict[str, PartVariable] = field(default_factory=dict)
    has_states: bool | None = None
    once: bool = False
    one_step: bool = False

    def real(self, name, causality, unit="1", dependencies=None, **more):
        """Add a variable; outputs depend on nothing unless told."""
        if causality == "output" and dependencies is None:
            dependencies = frozenset()
        self.variables[name] = PartVariable(
            name, len(self.variables), causality, unit,
            dependencies=dependencies, **more,
        )  # fmt: skip
        return self


class CallbackPart:
    """A participant whose FMI functions are Python functions on the list `memory`.

    Args:
        name: instance name.
        inputs, outputs: names; outputs depend directly on the inputs if `feedthrough`.
        nodes: inputs and outputs are polynomial signals.
        state: the state can be saved and restored.
        start: start values by name.

    Attributes:
        steps: calls of doStep.
        restores: calls of fmi2SetFMUstate.
        saved: states that were saved and not freed, by handle.
    """

    feedthrough = False
    has_states = None
    once = one_step = False

    def __init__(self, name, inputs, outputs, *, nodes=True, state=True, start=None):
        self.name, self.inputs, self.outputs = name, tuple(inputs), tuple(outputs)
        self.variables: dict[str, PartVariable] = {}
        self.memory: list[float] = []
        for output in self.outputs:
            dependencies = frozenset(self.inputs if self.feedthrough else ())
            self._add(output, "output", dependencies)
            for node in range(1, NODES + 1) if nodes else ():
                self._add(f"{output}.node{node}", "output", dependencies)
        for input_ in self.inputs:
            self._add(input_, "input")
            for node in range(1, NODES + 1) if nodes else ():
                self._add(f"{input_}.node{node}", "input")
        if nodes:
            self._add(DEGREE, "parameter")
        for key, value in (start or {}).items():
            self.set(key, value)
        self.steps = self.restores = 0
        self.saved: dict[int, list[float]] = {}
        self.closed = False
        self._functions = [
            _EXCHANGE(self._set_real), _EXCHANGE(self._get_real), _DO_STEP(self._do_step)
        ]  # fmt: skip
        if state:
            self._functions += [_SAVE(self._save), _RESTORE(self._restore), _SAVE(self._free)]

    def _add(self, name, causality, dependencies=None):
        unit = UNIT.get(name.split(".")[1]) if "." in name else "1"
        self.variables[name] = PartVariable(
            name, len(self.memory), causality, unit, dependencies=dependencies
        )
        self.memory.append(0.0)

    def __getitem__(self, name):
        return self.memory[self.variables[name].reference]

    def __setitem__(self, name, value):
        self.memory[self.variables[name].reference] = value

    @property
    def degree(self):
        """Interface degree, 0 without nodes."""
        return int(self[DEGREE]) if DEGREE in self.variables else 0

    def nodal(self, name):
        """Values of an input at the live nodes of the macro step."""
        return [self[name], *(self[f"{name}.node{i}"] for i in range(1, self.degree + 1))]

    def write(self, name, values):
        """Write an output at nodes 1 ... p; the last value is that at the end."""
        for i, value in enumerate(values[: self.degree], 1):
            self[f"{name}.node{i}"] = value
        self[name] = values[-1]

    # -- what a compiled loop calls -------------------------------------------------------------
    def _set_real(self, _component, references, count, values):
        for i in range(count):
            self.memory[references[i]] = values[i]
        return OK

    def _get_real(self, _component, references, count, values):
        for i in range(count):
            values[i] = self.memory[references[i]]
        return OK

    def _do_step(self, _component, t, h, _no_rollback):
        self.steps += 1
        return self.step(t, h)

    def _save(self, _component, handle):
        if handle[0] in self.saved:
            return ERROR  # overwritten before it was freed
        handle[0] = max(self.saved, default=0) + 1
        self.saved[handle[0]] = list(self.memory)
        return OK

    def _restore(self, _component, handle):
        self.restores += 1
        self.memory[:] = self.saved[handle]
        return self.restored() or OK

    def _free(self, _component, handle):
        del self.saved[handle[0]]
        handle[0] = 0
        return OK

    def restored(self):
        """Called after every restore; may spoil it and return a status."""

    def step(self, t, h):
        """Advance, write the outputs; FMI status."""
        raise NotImplementedError

    def out(self):
        """Write the outputs of the start."""

    # -- the Part protocol ----------------------------------------------------------------------
    @property
    def addresses(self):
        """Addresses of the callbacks; they ignore the component pointer."""
        return Addresses(1, *(ctypes.cast(f, ctypes.c_void_p).value for f in self._functions))

    def new_state(self):
        """0: the part keeps its states."""
        return 0

    def set(self, name, value):
        """Set a variable."""
        if name not in self.variables:
            raise ParameterError(f"{self.name} has no variable '{name}'")
        self[name] = float(value)

    def get(self, names):
        """Values; in initialisation they belong to the inputs just set."""
        if self.steps == 0:
            self.out()
        return [self[name] for name in names]

    def enter_initialization(self, start_time, stop_time, tolerance=None):
        """Compute the outputs of the start."""
        self.out()

    def exit_initialization(self):
        """Compute the outputs of the start."""
        self.out()

    def ended(self):
        """It never asks to end the simulation."""
        return None

    def failed(self):
        """Nothing follows from it."""

    def messages(self):
        """Nothing is logged."""
        return []

    def close(self):
        """Remember that it was called."""
        self.closed = True
