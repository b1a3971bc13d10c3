"""An FMU 3.0 as participant."""

import os
from collections.abc import Mapping
from ctypes import CFUNCTYPE, POINTER, Array, c_double, c_int, c_size_t, c_uint32, c_void_p, cast
from pathlib import Path
from typing import ClassVar

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import (
    FMU3Slave,
    fmi3Boolean,
    fmi3IntermediateUpdateCallback,
    fmi3LogMessageCallback,
)

from herringbone.core import FmuError, ParameterError
from herringbone.core.part import STRUCTURE, Addresses, Value, ValueOrArray
from herringbone.cosim.fmu.float_modes import keeping_modes
from herringbone.cosim.fmu.fmi3 import memory
from herringbone.cosim.fmu.fmi3.adapters import adapter
from herringbone.cosim.fmu.fmi3.updates import inputs_within
from herringbone.cosim.fmu.functions import KnownFunctions
from herringbone.cosim.fmu.others import OtherValues
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.fmu.variables import Element, read_elements, resized, untold_arrays
from herringbone.cosim.held_inputs import order_of_held

_WARNING = 1
_CALLBACK = fmi3IntermediateUpdateCallback
_MOST_EVENTS = 1000
"""Iterations of one event."""
_FUNCTIONS = {
    "set_float64": "fmi3SetFloat64",
    "get_float64": "fmi3GetFloat64",
    "do_step": "fmi3DoStep",
    "get_state": "fmi3GetFMUState",
    "set_state": "fmi3SetFMUState",
    "free_state": "fmi3FreeFMUState",
    "get_derivatives": "fmi3GetOutputDerivatives",
    "enter_events": "fmi3EnterEventMode",
    "update": "fmi3UpdateDiscreteStates",
    "enter_steps": "fmi3EnterStepMode",
}
_ENDS = {
    memory.ENDED: "it asks to end the simulation",
    memory.EARLY: "it ended its step early, which it may not without event mode, or again and "
    "again",
    memory.STUCK: "its discrete states do not settle: fmi3UpdateDiscreteStates wants one more "
    "call again and again",
}
"""Why no step follows."""
_EXCHANGE = CFUNCTYPE(c_int, c_void_p, POINTER(c_uint32), c_size_t, POINTER(c_double))


class FMU3Known(KnownFunctions, FMU3Slave):
    """fmpy tells the version by the name of the class."""


class Fmu3Part(FmuPart):
    """An instantiated FMU 3.0 for co-simulation.

    It is instantiated with event mode and early return if it declares them, and with intermediate
    update if it declares that of inputs, and has no signal nodes. Values are exchanged through the
    adapters of `calls`, by the compiled loop and from Python alike.

    Attributes:
        with_events: event mode and early return are used where the FMU declares them.
    """

    slave: FMU3Slave
    with_events: ClassVar[bool] = True

    def _load(self, **options: str) -> FMU3Slave:
        self._initialised = self._told = False
        self._untold = untold_arrays(self.model)
        self._waiting: dict[str, Value] = {}
        self._memory = np.zeros(1, memory.MEMORY)
        self._within = inputs_within(self.model, Path(options["unzipDirectory"]))
        self._make_memory(read_elements(self.model))
        return FMU3Known(**options)

    def _make_memory(self, elements: list[Element]) -> None:
        """The memory of the adapters, with the declared start values."""
        count = len(elements)
        self._elements = np.array(
            [
                (
                    e.variable.valueReference,
                    e.first,
                    e.size,
                    0,
                    e.variable.variability == "discrete",
                )
                for e in elements
            ],
            memory.ELEMENT,
        )
        self._values = np.array([_start(e) for e in elements], np.float64)
        self._references = np.zeros(count, np.uint32)
        self._packed = np.zeros(count)
        arrays = {e.first for e in elements if e.size > 1 and e.variable.causality == "input"}
        self._arrays = np.array(sorted(arrays), np.uint32)
        self._memory[...] = np.zeros(1, memory.MEMORY)  # its address stays: the FMU may know it
        self._memory["next_event"] = np.inf
        self._memory["varies"] = not self.one_step
        self._memory["count"] = count
        self._memory["elements"] = self._elements.ctypes.data
        self._memory["values"] = self._values.ctypes.data
        self._memory["references"] = self._references.ctypes.data
        self._memory["packed"] = self._packed.ctypes.data
        self._memory["arrays"] = self._arrays.ctypes.data
        self._memory["array_count"] = self._arrays.size
        self._bent: dict[str, np.ndarray] = {
            "bent_inputs": np.zeros(count, np.uint32),
            "slopes": np.zeros(count * memory.ORDERS),
            "starts": np.zeros(count),
        }
        for name, array in self._bent.items():
            self._memory[name] = array.ctypes.data
        self._reached, self._flags = np.zeros(1), np.zeros(2)
        self._memory["reached"] = self._reached.ctypes.data
        self._memory["flags"] = self._flags.ctypes.data

    def _instantiate(self) -> None:
        self._events = self.with_events and bool(self.model.coSimulation.hasEventMode)
        try:
            self._make_instance()
        except FmuError:
            if not (self._events or self._within):
                raise
            self._events, self._within = False, []  # some declare them and do not know them
            self._make_instance()
            self.messages()
        self._connect_memory()

    def _make_instance(self) -> None:
        """fmpy's own call has no environment, which the intermediate update needs."""
        slave, within = self.slave, self._within
        early = self._events and bool(self.model.coSimulation.mightReturnEarlyFromDoStep)
        slave.logMessage = fmi3LogMessageCallback(
            lambda _environment, status, _category, text: self._log.add(status, text)
        )
        callback = cast(c_void_p(adapter("update") if within else None), _CALLBACK)
        resources = str(Path(slave.unzipDirectory) / "resources") + os.path.sep
        slave.component = slave.fmi3InstantiateCoSimulation(
            *(text.encode() for text in (slave.instanceName, slave.guid, resources)),
            *(fmi3Boolean(on) for on in (False, True, self._events, early)),
            (c_uint32 * len(within))(*within),
            len(within),
            c_void_p(self._memory.ctypes.data),
            slave.logMessage,
            callback,
        )
        if not slave.component:
            raise FmuError("fmi3InstantiateCoSimulation gives nothing")

    def _connect_memory(self) -> None:
        """Let the memory of the adapters know the instance and its functions."""
        self._memory["instance"] = self.slave.component
        for place, function in _FUNCTIONS.items():
            self._memory[place] = self._address(function)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapters; the component is their memory.

        FMI 3.0 has no input derivatives; intermediate update stands for them.
        """
        functions = ["set_real", "get_real", "do_step"]
        if self.model.coSimulation.canGetAndSetFMUstate:
            functions += ["get_state", "set_state", "free_state"]
        found = Addresses(self._memory.ctypes.data, *map(adapter, functions))
        if int(self.model.coSimulation.maxOutputDerivativeOrder) > 0:
            found = found._replace(get_derivatives=adapter("get_derivatives"))
        if self._within:
            found = found._replace(set_derivatives=adapter("set_derivatives"))
        return found

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable; a structural parameter also sets the sizes of arrays.

        Raises:
            ParameterError: see `FmuPart.set`; or a size is set too late, or of another type.
        """
        declared = self.variables.get(name)
        if declared is None or declared.causality != STRUCTURE:
            super().set(name, value)
            return
        what = f"{self.name}.{name} = {value!r}"
        if self._initialised:
            raise ParameterError(f"{what}: a structural parameter is set before initialisation")
        try:
            self.slave.enterConfigurationMode()
            super().set(name, value)
            self.slave.exitConfigurationMode()
        except FMICallException as error:
            raise ParameterError(self._refusal(what, error)) from error
        self._resize(name, int(self._others.last(name)))

    def _resize(self, name: str, size: int) -> None:
        """Arrays whose size is a structural parameter have another one now."""
        self.variables = resized(self.model, name, size)
        self._untold = untold_arrays(self.model)
        self._others = OtherValues(self.model)
        self._make_memory(read_elements(self.model))
        self._connect_memory()

    def _waits(self, values: Mapping[str, Value]) -> bool:
        """True for an element that is set at initialisation: until then nobody knows the others."""
        array = self.variables[next(iter(values))].array
        if self._initialised or array not in self._untold:
            return False
        if len(values) == 1:
            self._waiting |= values
            return True
        self._untold.remove(array)
        for name in values:
            self._waiting.pop(name, None)
        return False

    @keeping_modes
    def _put(self, values: Mapping[str, Value]) -> None:
        if self._waits(values):
            return
        if not self._memory["events"][0]:
            super()._put(values)
            return
        others = any(self._others.discrete(name) for name in values)
        if others:
            self.slave.enterEventMode()
            self._memory["events"] = 0
        super()._put(values)
        if others:
            self._settle()

    def _settle(self) -> None:
        """From event mode to step mode."""
        for _ in range(_MOST_EVENTS):
            more, ends, _, _, defined, time = self.slave.updateDiscreteStates()
            self._memory["next_event"] = time if defined else np.inf
            if ends:
                self._memory["ended"] = memory.ENDED
            if ends or not more:
                self.slave.enterStepMode()
                self._memory["events"] = 1
                return
        raise FmuError(f"{self.name}: {_ENDS[memory.STUCK]}")

    def _write(self, references: list[int], values: list[float]) -> None:
        numbers = (c_uint32 * len(references))(*references)
        content = (c_double * len(values))(*values)
        self._exchange("set_real", "fmi3SetFloat64", numbers, content)

    def _read(self, references: list[int]) -> list[float]:
        count = len(references)
        values = (c_double * count)()
        numbers = (c_uint32 * count)(*references)
        self._exchange("get_real", "fmi3GetFloat64", numbers, values)
        return list(values)

    def _exchange(
        self,
        kind: str,
        function: str,
        references: Array[c_uint32],
        values: Array[c_double],
    ) -> None:
        call = _EXCHANGE(adapter(kind))
        status = call(self._memory.ctypes.data, references, len(references), values)
        if status > _WARNING:
            raise FMICallException(function=function, status=status)

    def _enter(self, start_time: float, stop_time: float, tolerance: float | None) -> None:
        self._initialised = True
        self.slave.enterInitializationMode(
            tolerance=tolerance, startTime=start_time, stopTime=stop_time
        )
        arrays = np.flatnonzero(self._elements["size"] > 1)
        if arrays.size:  # a size that was set makes other start values
            self._read(arrays.tolist())
        self._others.take_starts(self.slave)
        if self._waiting:
            self._put(self._waiting)

    @keeping_modes
    def exit_initialization(self) -> None:
        """Go to step mode; raises FmuError."""
        super().exit_initialization()
        if self._events:
            try:
                self._settle()
            except FMICallException as error:
                raise FmuError(self._refusal(f"{self.name} does not initialise", error)) from error

    def ended(self) -> float | None:
        """Time at which the FMU asked to end the simulation [s]; None if it did not."""
        return float(self._reached[0]) if self._memory["ended"][0] == memory.ENDED else None

    def messages(self) -> list[str]:
        """Warnings and errors logged since the last call, and why no step follows."""
        why = _ENDS.get(int(self._memory["ended"][0]))
        said = super().messages() + ([why] if why else [])
        steps = int(self._memory["steps_bent"][0])
        if steps and not self._memory["asked"][0] and not self._told:
            self._told = True
            said.append(
                f"it declares intermediate update, and asked for no input in {steps} steps: inputs "
                f"were held at their means, which makes the coupling {self._order_of_held()}; what "
                "a line on its derivatives says is of FMUs that ask"
            )
        return said

    def _order_of_held(self) -> str:
        """Order with inputs at their means; all outputs count, as what is coupled is not known."""
        by_causality: dict[str, list[str]] = {"input": [], "output": []}
        for name, variable in self.variables.items():
            by_causality.setdefault(variable.causality, []).append(name)
        return order_of_held(self, by_causality["input"], by_causality["output"])


def _start(element: Element) -> float:
    """Declared start value of an element; 0 if there is none. One value stands for all."""
    given = (element.variable.start or "0").split()
    return float(given[element.place if len(given) == element.size else 0])
