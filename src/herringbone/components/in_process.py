"""In-process participant: an instance of a component behind the addresses of FMI functions."""

import ctypes
import math
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

from herringbone.components.registry import COMPONENTS
from herringbone.core import Instance, ParameterError
from herringbone.core.caching.generated import load_generated
from herringbone.core.declaring.declaration import Declaration, node_name
from herringbone.core.declaring.units import unit_dimension
from herringbone.core.declaring.variable import NODES, Causality
from herringbone.core.part import Addresses, PartVariable, Value, ValueOrArray
from herringbone.kernels import fmi_calls

_DO_STEP = '''"""Address of a component's fmi2DoStep; generated, not to be edited."""

import numpy as np
from numba import carray, types

from herringbone.components.registry import COMPONENTS
from herringbone.kernels.fmi_calls import DISCARD, DO_STEP, OK
from herringbone.kernels.compiling.jit import c_function

step = COMPONENTS["{name}"].kernels.step


@c_function(DO_STEP)
def do_step(memory, time, step_size, no_set_before):
    whole = carray(memory, {block} + {work})
    if 0.0 <= step_size < np.inf and step(whole[:{block}], whole[{block}:], time, step_size) == OK:
        return types.int32(OK)
    return types.int32(DISCARD)
'''


@cache
def _do_step_address(component: str) -> int:
    """Address of a component's fmi2DoStep; a failed step is a discarded one."""
    declaration = COMPONENTS[component].declaration
    source = _DO_STEP.format(name=component, block=declaration.size, work=max(declaration.work, 1))
    return load_generated("step", source).do_step.address


@cache
def part_variables(component: str) -> Mapping[str, PartVariable]:
    """The variables of a component as a master sees them, by ascending value reference."""
    declaration = COMPONENTS[component].declaration
    found = {}
    for variable in declaration.variables:
        names = [variable.name]
        if variable.nodes:
            names += [node_name(variable.name, node) for node in range(1, NODES + 1)]
        for name in names:
            found[name] = PartVariable(
                name,
                declaration.index[name],
                variable.causality.value,
                variable.unit,
                unit_dimension(variable.unit),
                frozenset(variable.feedthrough) if variable.causality is Causality.OUTPUT else None,
                rate=variable.rate if name == variable.name else "",
                starts=variable.state,
            )
    for k, text in enumerate(declaration.texts):
        reference = declaration.size + k
        found[text.name] = PartVariable(text.name, reference, "parameter", type="String")
    return dict(sorted(found.items(), key=lambda item: item[1].reference))


class InProcessPart:
    """A component that runs in the master's process, without FMU.

    Args:
        instance: the component's instance; parameters may have been set.
    """

    def __init__(self, instance: Instance) -> None:
        self.instance = instance
        self.name = instance.name
        self.variables = part_variables(instance.component.name)
        self.has_states: bool | None = None
        self.once = self.one_step = False
        self._start_time: float | None = None
        self._stale = False
        self._states: list[np.ndarray] = []

    @property
    def declaration(self) -> Declaration:
        """Declaration of the component."""
        return self.instance.component.declaration

    @property
    def addresses(self) -> Addresses:
        """Addresses of the compiled FMI functions; the component is the instance's memory."""
        return Addresses(
            self.instance.memory.ctypes.data_as(ctypes.c_void_p).value or 0,
            fmi_calls.set_real.address,
            fmi_calls.get_real.address,
            self._do_step,
            fmi_calls.get_state.address,
            fmi_calls.set_state.address,
            fmi_calls.free_state.address,
        )

    @property
    def _do_step(self) -> int:
        """Address of fmi2DoStep; it is compiled when this is asked for."""
        return _do_step_address(self.instance.component.name)

    def new_state(self) -> int:
        """Memory for a saved state: number of mutable values, then the values."""
        count = self.declaration.mutable_size
        self._states.append(np.zeros(1 + count))
        self._states[-1][0] = count
        return self._states[-1].ctypes.data

    def state_bytes(self) -> bytes:
        """The state in step mode, for a checkpoint: what steps change."""
        return self.instance.block[: self.declaration.mutable_size].tobytes()

    def set_state_bytes(self, state: bytes) -> None:
        """Take back a state of an instance with the same parameters; raises ParameterError."""
        values = np.frombuffer(state)
        if values.size != self.declaration.mutable_size:
            raise ParameterError(f"{self.name}: the checkpoint is of another version of it")
        self.instance.block[: values.size] = values

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable; raises ParameterError."""
        if not isinstance(value, float | int | str):
            raise ParameterError(f"{self.name}.{name} = {value!r}: it takes a number or a text")
        self.instance.set(name, value)
        self._stale = self._start_time is not None

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables; in initialisation mode they belong to the inputs just set."""
        self._refresh()
        return [self.instance[name] for name in names]

    def put_values(self, values: Mapping[str, Value]) -> None:
        """Set variables; raises ParameterError."""
        for name, value in values.items():
            self.set(name, float(value))

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """Texts, which are all that is not real."""
        return [self.instance.texts[name] for name in names]

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Compute initial outputs; raises ParameterError, ResourceError."""
        del stop_time
        self._start_time, self._stale = start_time, True
        self._refresh()

    def _refresh(self) -> None:
        if self._stale and self._start_time is not None:
            self.instance.initialise(self._start_time)
            self._stale = False

    def exit_initialization(self) -> None:
        """Compute the outputs of the start; from now on only steps change them."""
        self._refresh()
        self._start_time = None

    def failed(self) -> None:
        """Nothing to be told: it has nothing to free."""

    def ended(self) -> None:
        """It never asks to end the simulation."""

    def messages(self) -> list[str]:
        """What went wrong, if something did; else what it takes."""
        found = self.instance.first_not_finite()
        longest = self.instance.longest_step()
        if found:
            return [f"{self.name}.{found[0]} = {found[1]}"]
        return [] if math.isinf(longest) else [f"it takes steps of at most {longest:g} s"]

    def close(self) -> None:
        """Nothing to free."""
