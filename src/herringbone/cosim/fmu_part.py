"""An FMU as participant: fmpy reads, extracts, loads and instantiates it."""

import atexit
import ctypes
import itertools
import math
import shutil
from collections.abc import Sequence
from pathlib import Path

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import (
    FMU2Slave,
    calloc,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
    free,
)
from fmpy.logging import addLoggerProxy
from fmpy.model_description import ModelDescription

from herringbone.core import FmuError, ParameterError
from herringbone.core.part import Addresses, PartVariable
from herringbone.cosim.fmu_file import extract_fmu, read_fmu


def _dimension(model: ModelDescription) -> dict[str, tuple]:
    """Factor, offset and base-unit exponents by unit name."""
    found = {}
    for unit in model.unitDefinitions:
        base = unit.baseUnit
        if base is not None:
            exponents = {
                n: getattr(base, n) for n in ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
            }
            powers = tuple(sorted((n, int(e)) for n, e in exponents.items() if e))
            found[unit.name] = (float(base.factor), float(base.offset), powers)
    return found


def read_variables(model: ModelDescription) -> dict[str, PartVariable]:
    """Variables of an FMU as a master sees them."""
    dimension = _dimension(model)
    dependencies = {
        u.variable.name: None
        if u.dependencies is None
        else frozenset(d.name for d in u.dependencies)
        for u in model.outputs
    }
    found = {}
    for v in model.modelVariables:
        unit = v.unit or (v.declaredType.unit if v.declaredType else None)
        found[v.name] = PartVariable(
            v.name,
            v.valueReference,
            v.causality or "local",
            unit,
            dimension.get(unit),
            dependencies.get(v.name),
            v.type == "Real",
        )
    return found


_keys = itertools.count(1)
_logs: dict[int, list[str]] = {}
"""Messages by part; fmpy's logger proxy keeps one logger for the process."""
_FATAL = 4
_corrupt: set[int] = set()
"""Parts that reported fmi2Fatal: FMI 2.0 allows no further call, and pythonfmu crashes on one."""


@fmi2CallbackLoggerTYPE
def _log(environment: int, _name: bytes, status: int, _category: bytes, message: bytes) -> None:
    if status == _FATAL:
        _corrupt.add(environment)
    if status > 0 and message and environment in _logs:
        _logs[environment].append(message.decode("utf-8", "replace").strip())


def _callbacks(key: int) -> fmi2CallbackFunctions:
    """Callbacks of one part; fmpy's proxy formats the logger's arguments."""
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = _log
    callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(calloc)
    callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(free)
    callbacks.componentEnvironment = ctypes.c_void_p(key)
    addLoggerProxy(ctypes.byref(callbacks))
    return callbacks


class FmuPart:
    """An instantiated FMU 2.0 for co-simulation.

    Args:
        name: instance name.
        file: the FMU.

    Raises:
        FmuError: the file cannot be used, or does not instantiate.
    """

    def __init__(self, name: str, file: Path) -> None:
        self.name, self.file = name, file
        self.model = read_fmu(file)
        self.variables = read_variables(self.model)
        self._types = {v.name: v.type for v in self.model.modelVariables}
        self._key = next(_keys)
        self._log = _logs[self._key] = []
        self._folder = extract_fmu(file)
        self._callbacks = _callbacks(self._key)
        try:
            self.slave = FMU2Slave(
                guid=self.model.guid,
                unzipDirectory=str(self._folder),
                modelIdentifier=self.model.coSimulation.modelIdentifier,
                instanceName=name,
            )
            self.slave.instantiate(callbacks=self._callbacks, loggingOn=True)
        except Exception as error:  # fmpy raises bare Exception; loading raises OSError
            shutil.rmtree(self._folder, ignore_errors=True)
            said = "; ".join([str(error), *self.messages()])
            raise FmuError(f"{name}: {file} does not instantiate: {said}") from error
        _finalize_at_exit(self.slave.dll)

    @property
    def addresses(self) -> Addresses:
        """Addresses of the FMU's functions."""

        def address(name: str) -> int:
            return ctypes.cast(getattr(self.slave.dll, name), ctypes.c_void_p).value or 0

        names = ["SetReal", "GetReal", "DoStep"]
        if self.model.coSimulation.canGetAndSetFMUstate:
            names += ["GetFMUstate", "SetFMUstate", "FreeFMUstate"]
        found = Addresses(int(self.slave.component), *(address(f"fmi2{name}") for name in names))
        if self.model.coSimulation.canInterpolateInputs:
            found = found._replace(set_derivatives=address("fmi2SetRealInputDerivatives"))
        if self.model.coSimulation.maxOutputDerivativeOrder > 0:
            found = found._replace(get_derivatives=address("fmi2GetRealOutputDerivatives"))
        return found

    def new_state(self) -> int:
        """0: the FMU allocates its states."""
        return 0

    def set(self, name: str, value: float | str) -> None:
        """Set a variable before or during initialisation.

        Raises:
            ParameterError: unknown name, wrong type, not finite, or refused by the FMU.
        """
        if name not in self.variables:
            raise ParameterError(
                f"{self.name}: {self.file.name} has no variable '{name}'; "
                f"'herringbone check {self.file}' lists them"
            )
        kind, reference = self._types[name], self.variables[name].reference
        if (kind == "String") != isinstance(value, str):
            raise ParameterError(f"{self.name}.{name} = {value!r}: it takes a {kind}")
        if not isinstance(value, str) and not math.isfinite(value):
            raise ParameterError(f"{self.name}.{name} = {value}: it must be finite")
        setter = {
            "Real": self.slave.setReal,
            "Integer": self.slave.setInteger,
            "Enumeration": self.slave.setInteger,
            "Boolean": self.slave.setBoolean,
            "String": self.slave.setString,
        }[kind]
        converted = value if kind in {"Real", "String"} else int(value)
        try:
            setter([reference], [converted])
        except FMICallException as error:
            raise ParameterError(self._refusal(f"{self.name}.{name} = {value!r}", error)) from error

    def _refusal(self, what: str, error: Exception) -> str:
        return f"{what}: {'; '.join(self.messages()) or error}"

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables; raises FmuError."""
        if self._key in _corrupt:
            raise FmuError(f"{self.name} has failed for good; nothing can be read from it")
        try:
            return self.slave.getReal([self.variables[name].reference for name in names])
        except FMICallException as error:
            raise FmuError(
                self._refusal(f"{self.name}: reading {', '.join(names)}", error)
            ) from error

    def enter_initialization(self, start_time: float, stop_time: float) -> None:
        """Set up the experiment and enter initialisation mode; raises FmuError."""
        try:
            self.slave.setupExperiment(startTime=start_time, stopTime=stop_time)
            self.slave.enterInitializationMode()
        except FMICallException as error:
            raise FmuError(self._refusal(f"{self.name} does not initialise", error)) from error

    def exit_initialization(self) -> None:
        """Go to step mode; raises FmuError."""
        try:
            self.slave.exitInitializationMode()
        except FMICallException as error:
            raise FmuError(self._refusal(f"{self.name} does not initialise", error)) from error

    def messages(self) -> list[str]:
        """Warnings and errors logged since the last call, each on one line and once.

        A message that repeats another one inside it, as the FMU's runtime does, is left out.
        """
        found = list(dict.fromkeys(" ".join(message.split()) for message in self._log))
        self._log.clear()
        return [m for m in found if not any(other in m for other in found if other != m)]

    def close(self) -> None:
        """Free the instance, unless it has failed for good, and remove the extracted files."""
        if self._key not in _corrupt:
            self.slave.freeInstance()
        _logs.pop(self._key, None)
        shutil.rmtree(self._folder, ignore_errors=True)


_finalizers: dict[str, object] = {}


def _finalize_at_exit(dll: ctypes.CDLL) -> None:
    """Let pythonfmu release its interpreter reference once, before the process ends.

    Otherwise it is released twice by static destructors, and the process may abort at exit.
    """
    if hasattr(dll, "finalizePythonInterpreter") and not _finalizers:
        _finalizers["pythonfmu"] = ctypes.CDLL(dll._name)
        atexit.register(_finalizers["pythonfmu"].finalizePythonInterpreter)  # type: ignore[attr-defined]
