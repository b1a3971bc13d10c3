"""An FMU 3.0 as participant."""

from ctypes import CFUNCTYPE, POINTER, Array, c_double, c_int, c_size_t, c_uint32, c_void_p

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave

from herringbone.core.part import Addresses
from herringbone.cosim.fmu import fmi3_calls
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.fmu.variables import Element, read_elements
from herringbone.kernels.linking import CFunction

_WARNING = 1
_FUNCTIONS = {
    "set_float64": "fmi3SetFloat64",
    "get_float64": "fmi3GetFloat64",
    "do_step": "fmi3DoStep",
    "get_state": "fmi3GetFMUState",
    "set_state": "fmi3SetFMUState",
    "free_state": "fmi3FreeFMUState",
    "get_derivatives": "fmi3GetOutputDerivatives",
}
_EXCHANGE = CFUNCTYPE(c_int, c_void_p, POINTER(c_uint32), c_size_t, POINTER(c_double))


class Fmu3Part(FmuPart):
    """An instantiated FMU 3.0 for co-simulation.

    It is instantiated without event mode, early return and intermediate updates. Values are
    exchanged through the adapters of `fmi3_calls`, by the compiled loop and from Python alike.
    """

    slave: FMU3Slave

    def _load(self, **options: str) -> FMU3Slave:
        self._make_memory(read_elements(self.model))
        return FMU3Slave(**options)

    def _make_memory(self, elements: list[Element]) -> None:
        """The memory of the adapters, with the declared start values."""
        count = len(elements)
        self._elements = np.array(
            [(e.variable.valueReference, e.first, e.size, 0) for e in elements], fmi3_calls.ELEMENT
        )
        self._values = np.array([_start(e, k) for k, e in enumerate(elements)], np.float64)
        self._references = np.zeros(count, np.uint32)
        self._packed = np.zeros(count)
        arrays = {e.first for e in elements if e.size > 1 and e.variable.causality == "input"}
        self._arrays = np.array(sorted(arrays), np.uint32)
        self._memory = np.zeros(1, fmi3_calls.MEMORY)
        self._memory["count"] = count
        self._memory["elements"] = self._elements.ctypes.data
        self._memory["values"] = self._values.ctypes.data
        self._memory["references"] = self._references.ctypes.data
        self._memory["packed"] = self._packed.ctypes.data
        self._memory["arrays"] = self._arrays.ctypes.data
        self._memory["array_count"] = self._arrays.size

    def _instantiate(self) -> None:
        self.slave.instantiate(
            loggingOn=True,
            logMessage=lambda _environment, status, _category, text: self._log.add(status, text),
        )
        self._memory["instance"] = self.slave.component
        for place, function in _FUNCTIONS.items():
            self._memory[place] = self._address(function)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapters; the component is their memory.

        FMI 3.0 has no input derivatives.
        """
        functions = [fmi3_calls.set_real, fmi3_calls.get_real, fmi3_calls.do_step]
        if self.model.coSimulation.canGetAndSetFMUstate:
            functions += [fmi3_calls.get_state, fmi3_calls.set_state, fmi3_calls.free_state]
        found = Addresses(self._memory.ctypes.data, *(f.address for f in functions))
        if int(self.model.coSimulation.maxOutputDerivativeOrder) > 0:
            found = found._replace(get_derivatives=fmi3_calls.get_derivatives.address)
        return found

    def _write(self, kind: str, reference: int, value: float | str) -> None:
        if kind == "Float64":
            number, content = (c_uint32 * 1)(reference), (c_double * 1)(float(value))
            self._exchange(fmi3_calls.set_real, "fmi3SetFloat64", number, content)
            return
        setter = "setInt64" if kind == "Enumeration" else f"set{kind}"
        getattr(self.slave, setter)([reference], [value])

    def _read(self, references: list[int]) -> list[float]:
        count = len(references)
        values = (c_double * count)()
        numbers = (c_uint32 * count)(*references)
        self._exchange(fmi3_calls.get_real, "fmi3GetFloat64", numbers, values)
        return list(values)

    def _exchange(
        self,
        adapter: CFunction,
        function: str,
        references: Array[c_uint32],
        values: Array[c_double],
    ) -> None:
        call = _EXCHANGE(adapter.address)
        status = call(self._memory.ctypes.data, references, len(references), values)
        if status > _WARNING:
            raise FMICallException(function=function, status=status)

    def _enter(self, start_time: float, stop_time: float) -> None:
        self.slave.enterInitializationMode(startTime=start_time, stopTime=stop_time)

    def messages(self) -> list[str]:
        """Warnings and errors logged since the last call, and whether a step ended early."""
        ended = ["it ended its step early, or asked to end the simulation"]
        found = super().messages() + (ended if self._memory["ended"][0] else [])
        self._memory["ended"] = 0
        return found


def _start(element: Element, number: int) -> float:
    """Declared start value of an element; 0 if there is none. One value stands for all."""
    given = (element.variable.start or "0").split()
    return float(given[min(number - element.first, len(given) - 1)])
