"""An FMU as participant: what FMUs of all FMI versions share."""

import contextlib
import ctypes
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelDescription, ModelVariable

from herringbone.core import FmuError, ParameterError
from herringbone.core.part import Addresses, PartVariable, Value, ValueOrArray
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.cosim.fmu.file import extract_fmu, read_fmu
from herringbone.cosim.fmu.float_modes import keeping_modes
from herringbone.cosim.fmu.log import FmuLog
from herringbone.cosim.fmu.others import OtherValues
from herringbone.cosim.fmu.values import as_value, as_values
from herringbone.cosim.fmu.variables import read_variables

if TYPE_CHECKING:  # a cell starts quicker without
    from herringbone.cosim.signature.signature import Signature

_made: set[str] = set()
"""Identifiers of FMUs that this process has instantiated."""
_SHOWN = 8
_CALCULATED = {
    "output": "an output",
    "local": "a local variable",
    "calculatedParameter": "a calculated parameter",
    "independent": "the time",
}
"""By causality, unless a start value is declared (FMI 2.0.4, section 2.2.7)."""


class FmuPart(ABC):
    """An instantiated FMU for co-simulation; fmpy reads, extracts, loads and instantiates it.

    Args:
        name: instance name.
        file: the FMU, of the class's FMI version.
        model: its model description, if it has been read.
        folder: where it is extracted already, and stays; None: to a folder of its own.
        alike: an instance of the same model and folder, whose library is not unloaded.

    Attributes:
        own: this installation built the FMU, so that its state is known to be whole.

    Raises:
        FmuError: the file cannot be used, or does not instantiate.
    """

    own = False

    @keeping_modes
    def __init__(
        self,
        name: str,
        file: Path,
        model: ModelDescription | None = None,
        folder: Path | None = None,
        alike: "FmuPart | None" = None,
    ) -> None:
        self.name, self.file, self._alike = name, file, alike
        self.has_states: bool | None = None
        self.signature: Signature | None = None
        self._running = self._freed = False
        self.model = model or read_fmu(file)
        try:
            self.variables: Mapping[str, PartVariable] = (
                alike.variables if alike else read_variables(self.model)
            )
            self._others = OtherValues(self.model)
            self._declared: Mapping[str, ModelVariable] = (
                alike._declared if alike else {v.name: v for v in self.model.modelVariables}
            )
        except FmuError as error:
            raise FmuError(f"{file}: {error}") from error
        abilities = self.model.coSimulation
        self.once = bool(abilities.canBeInstantiatedOnlyOncePerProcess)
        self.one_step = not abilities.canHandleVariableCommunicationStepSize
        self._log = FmuLog()
        self._folder = folder or extract_fmu(file)
        self._owned = folder is None
        try:
            self.slave = self._load(
                guid=self.model.guid,
                unzipDirectory=str(self._folder),
                modelIdentifier=self.model.coSimulation.modelIdentifier,
                instanceName=name,
            )
            self._instantiate()
        except Exception as error:  # fmpy raises bare Exception; loading raises OSError
            self._remove_files()
            said = "; ".join([str(error), *self.messages(), *self._only_one()])
            raise FmuError(f"{name}: {file} does not instantiate: {said}") from error
        except BaseException:  # Ctrl-C
            self._remove_files()
            raise
        _made.add(str(self.model.guid))

    def _only_one(self) -> list[str]:
        """Why it may not instantiate, if another one of the FMU was made in this process."""
        if str(self.model.guid) not in _made:
            return []
        told = "declares that it" if self.once else "may be one that"
        return [f"it {told} can be instantiated once only per process, and was before"]

    @abstractmethod
    def _load(self, **options: str) -> Any:  # noqa: ANN401 (fmpy's class of the FMI version)
        """fmpy's slave of the FMI version."""

    @abstractmethod
    def _instantiate(self) -> None:
        """Make an instance, the slave's component, that logs to `_log`."""

    @property
    @abstractmethod
    def addresses(self) -> Addresses:
        """What the compiled loop calls."""

    @abstractmethod
    def _write(self, references: list[int], values: list[float]) -> None:
        """Set real variables; raises FMICallException."""

    @abstractmethod
    def _read(self, references: list[int]) -> list[float]:
        """Values of real variables; raises FMICallException."""

    @abstractmethod
    def _enter(self, start_time: float, stop_time: float, tolerance: float | None) -> None:
        """Set up the experiment and enter initialisation mode; raises FMICallException."""

    def _address(self, function: str) -> int:
        """Address of a function of the FMU's library."""
        return ctypes.cast(getattr(self.slave.dll, function), ctypes.c_void_p).value or 0

    def new_state(self) -> int:
        """0: the FMU allocates its states."""
        return 0

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable before or during initialisation; an array takes all its values.

        Raises:
            ParameterError: unknown name, wrong type or size, not finite, or refused by the FMU.
        """
        what = f"{self.name}.{name} = {value!r}"
        known = name in self.variables
        names = [] if known else [n for n, v in self.variables.items() if v.array == name]
        names = names or [name]
        if not known and names == [name]:
            raise ParameterError(
                f"{self.name}: {self.file.name} has no variable '{name}'; {self._near(name)}"
            )
        self._refuse_calculated(name, what)
        first = self.variables[names[0]]
        if first.array == name:
            values = as_values(first.type, value, len(names), what, first.items)
        elif isinstance(value, float | int | str | bytes):
            values = [as_value(first.type, value, what, first.items)]
        else:
            raise ParameterError(f"{what}: it takes one {first.type}")
        try:
            self._put(dict(zip(names, values, strict=True)))
        except FMICallException as error:
            raise ParameterError(self._refusal(what, error)) from error

    def _refuse_calculated(self, name: str, what: str) -> None:
        """Raises ParameterError: the FMU computes the variable, so that no value can be given."""
        v = self._declared.get(name)
        if v is None or v.causality not in _CALCULATED or v.initial in {"exact", "approx"}:
            return
        if v.initial == "calculated" or v.start is None:
            raise ParameterError(
                f"{what}: it is {_CALCULATED[v.causality]}, which the FMU computes"
            )

    def _near(self, name: str) -> str:
        """Variables that a wrong name may mean, or the first ones."""
        if near := get_close_matches(name, self.variables, 3):
            return f"did you mean {' or '.join(near)}"
        first = list(self.variables)[:_SHOWN]
        more = ", ..." if len(self.variables) > _SHOWN else ""
        return f"it has: {', '.join(first)}{more}"

    def put_values(self, values: Mapping[str, Value]) -> None:
        """Set variables at a communication point; raises FmuError."""
        values = self._others.changed(values)
        try:
            if values:
                self._put(values)
        except FMICallException as error:
            what = ", ".join(f"{self.name}.{name} = {value!r}" for name, value in values.items())
            raise FmuError(self._refusal(what, error)) from error

    @keeping_modes
    def _put(self, values: Mapping[str, Value]) -> None:
        """Set variables of any types, in as few calls as possible; raises FMICallException."""
        reals = [name for name in values if self.variables[name].is_real]
        if reals:
            references = [self.variables[name].reference for name in reals]
            self._write(references, [float(values[name]) for name in reals])
        others = {name: value for name, value in values.items() if name not in reals}
        self._others.write(self.slave, others)

    @keeping_modes
    def get_values(self, names: Sequence[str]) -> list[Value]:
        """Values of variables of other types than real; raises FmuError."""
        if self._log.fatal:
            raise FmuError(f"{self.name} has failed for good; nothing can be read from it")
        try:
            return self._others.read(self.slave, names)
        except (FMICallException, AttributeError, ValueError) as error:  # no text, or no UTF-8
            raise FmuError(
                self._refusal(f"{self.name}: reading {', '.join(names)}", error)
            ) from error

    def ended(self) -> float | None:
        """Time at which the FMU asked to end the simulation [s]; None if it did not."""
        return None

    def _refusal(self, what: str, error: Exception) -> str:
        return f"{what}: {'; '.join(self.messages()) or error}"

    @keeping_modes
    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables; raises FmuError."""
        if self._log.fatal:
            raise FmuError(f"{self.name} has failed for good; nothing can be read from it")
        try:
            return self._read([self.variables[name].reference for name in names])
        except FMICallException as error:
            raise FmuError(
                self._refusal(f"{self.name}: reading {', '.join(names)}", error)
            ) from error

    @keeping_modes
    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Set up the experiment and enter initialisation mode; raises FmuError."""
        try:
            self._enter(start_time, stop_time, tolerance)
        except FMICallException as error:
            raise FmuError(self._refusal(f"{self.name} does not initialise", error)) from error

    @keeping_modes
    def exit_initialization(self) -> None:
        """Go to step mode; raises FmuError."""
        try:
            self.slave.exitInitializationMode()
        except FMICallException as error:
            raise FmuError(self._refusal(f"{self.name} does not initialise", error)) from error
        self._running = True

    def failed(self) -> None:
        """A step failed: FMI then allows no call but fmi2FreeInstance."""
        self._running = False

    def messages(self) -> list[str]:
        """Warnings and errors logged since the last call, each on one line and once."""
        return self._log.take()

    def close(self) -> None:
        """Terminate and free the instance, unless it has failed, and remove the extracted files."""
        self.terminate()
        self.free()

    @keeping_modes
    def terminate(self) -> None:
        """Terminate the instance if it runs."""
        if self._running and not self._log.fatal:
            self._running = False
            with contextlib.suppress(FMICallException):  # its results are there, and stay
                self.slave.terminate()

    @keeping_modes
    def free(self) -> None:
        """Free the instance, unless it has failed for good, and remove the extracted files.

        Once: whoever frees an FMU again calls a library that may be gone, and ends the process.
        """
        if self._freed:
            return
        self._freed = True
        if not self._log.fatal:
            self.slave.freeInstance()
        self._remove_files()

    def _remove_files(self) -> None:
        if self._owned:
            remove_temporary_folder(self._folder)
