"""An FMU 2.0 as participant."""

import atexit
import ctypes
import itertools
from contextlib import suppress
from copy import copy

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    calloc,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    fmi2DoStepStatus,
    fmi2LastSuccessfulTime,
    fmi2Pending,
    fmi2Terminated,
    free,
)
from fmpy.logging import addLoggerProxy

from herringbone.core.part import Addresses
from herringbone.cosim.fmu.functions import KnownFunctions
from herringbone.cosim.fmu.log import FmuLog
from herringbone.cosim.fmu.part import FmuPart

_DISCARD = 2
_NOBODY_WAITS = (
    b"its step goes on after doStep has returned (canRunAsynchronuously, fmi2Pending), and nobody "
    b"waits for that here; let it step before it returns"
)
_PYTHONFMU = "finalizePythonInterpreter"
"""A function that only pythonfmu's libraries have."""
_keys = itertools.count(1)
_logs: dict[int, FmuLog] = {}
"""Logs of the open parts; fmpy's logger proxy keeps one logger for the process."""


@fmi2CallbackLoggerTYPE
def _log(environment: int, _name: bytes, status: int, _category: bytes, message: bytes) -> None:
    if environment in _logs:
        _logs[environment].add(status, message)


def _callbacks(key: int) -> fmi2CallbackFunctions:
    """Callbacks of one part; fmpy's proxy formats the logger's arguments."""
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = _log
    callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
    callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
    callbacks.componentEnvironment = ctypes.c_void_p(key)
    addLoggerProxy(ctypes.byref(callbacks))
    return callbacks


class FMU2Known(KnownFunctions, FMU2Slave):
    """fmpy tells the version by the name of the class."""


class Fmu2Part(FmuPart):
    """An instantiated FMU 2.0 for co-simulation."""

    slave: FMU2Slave

    def _load(self, **options: str) -> FMU2Slave:
        self._key = next(_keys)
        self._callbacks = _callbacks(self._key)
        if self._alike is None:
            return FMU2Known(**options)
        slave = copy(self._alike.slave)  # finding its functions takes longer than all the rest
        slave.dll, slave.instanceName = ctypes.CDLL(slave.dll._name), options["instanceName"]
        return slave

    def _instantiate(self) -> None:
        _logs[self._key] = self._log
        self.slave.instantiate(callbacks=self._callbacks, loggingOn=True)
        _finalize_at_exit(self.slave.dll)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the FMU's functions."""
        names = ["SetReal", "GetReal", "DoStep"]
        if self.model.coSimulation.canGetAndSetFMUstate:
            names += ["GetFMUstate", "SetFMUstate", "FreeFMUstate"]
        functions = (self._address(f"fmi2{name}") for name in names)
        found = Addresses(int(self.slave.component), *functions)
        if self.model.coSimulation.canInterpolateInputs:
            found = found._replace(set_derivatives=self._address("fmi2SetRealInputDerivatives"))
        if self.model.coSimulation.maxOutputDerivativeOrder > 0:
            found = found._replace(get_derivatives=self._address("fmi2GetRealOutputDerivatives"))
        return found

    def _write(self, references: list[int], values: list[float]) -> None:
        self.slave.setReal(references, values)

    def _read(self, references: list[int]) -> list[float]:
        return self.slave.getReal(references)

    def _enter(self, start_time: float, stop_time: float, tolerance: float | None) -> None:
        self.slave.setupExperiment(tolerance=tolerance, startTime=start_time, stopTime=stop_time)
        self.slave.enterInitializationMode()

    def ended(self) -> float | None:
        """Time at which the FMU asked to end the simulation [s]; None if it did not.

        It tells after a step that it discarded, and not after fmi2Fatal. What pythonfmu tells is
        no answer: it calls every step the end for which `do_step` returns False.
        """
        if self._log.fatal or hasattr(self.slave.dll, _PYTHONFMU) or self._goes_on():
            return None
        try:
            ended = self.slave.getBooleanStatus(fmi2Terminated)
            last = float(self.slave.getRealStatus(fmi2LastSuccessfulTime))
        except FMICallException:
            return None
        if ended:
            return last
        said = f"the part came to {last:g} s; if it discarded the step, a smaller one may do"
        self._log.add(_DISCARD, said.encode())
        return None

    def _goes_on(self) -> bool:
        """True if a step that did not succeed goes on behind doStep; it is given up, with a line.

        FMI 2.0.4, 4.2.2: until it is done, or given up, no other call is allowed.
        """
        if not self.model.coSimulation.canRunAsynchronuously:
            return False
        try:
            going_on = self.slave.getStatus(fmi2DoStepStatus) == fmi2Pending
        except FMICallException:
            return False
        if going_on:
            self._log.add(_DISCARD, _NOBODY_WAITS)
            with suppress(FMICallException):
                self.slave.cancelStep()
        return going_on

    def free(self) -> None:
        """Free the instance; see `FmuPart.free`."""
        super().free()
        _logs.pop(self._key, None)


_finalizers: dict[str, ctypes.CDLL] = {}


def _finalize_at_exit(dll: ctypes.CDLL) -> None:
    """Let each pythonfmu library release its interpreter reference once, before the process ends.

    Otherwise it is released twice, by the library's static destructors and by what it runs when it
    is unloaded, and the process may abort at exit. Each file has a reference of its own.
    """
    if hasattr(dll, _PYTHONFMU) and dll._name not in _finalizers:
        _finalizers[dll._name] = ctypes.CDLL(dll._name)
        atexit.register(_finalizers[dll._name].finalizePythonInterpreter)
