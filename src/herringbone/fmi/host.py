"""Hosts for one FMU, for checks and golden results; co-simulation has its own loop."""

from collections.abc import Mapping
from ctypes import c_void_p
from pathlib import Path
from time import perf_counter
from types import TracebackType
from typing import Self

from fmpy.fmi1 import FMICallException

from herringbone.core import FmuError
from herringbone.cosim.fmu.file import is_fmi3, read_fmu
from herringbone.cosim.fmu.fmi2_part import Fmu2Part
from herringbone.cosim.fmu.fmi3.part import Fmu3Part
from herringbone.cosim.fmu.part import FmuPart


class _SteppedPart(FmuPart):
    """One instance of an FMU that is stepped by calls from Python."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _refuse_calculated(self, name: str, what: str) -> None:
        """Nothing: the FMU itself refuses what it computes."""

    def set_values(self, values: Mapping[str, float | str]) -> None:
        """Set variables by name; raises ParameterError."""
        for name, value in values.items():
            self.set(name, value)

    def values(self, *names: str) -> list[float]:
        """Real variables by name; raises FmuError."""
        return self.get(names)

    def initialise(
        self, values: Mapping[str, float | str] | None = None, stop_time: float = 1.0
    ) -> None:
        """Set start values, enter and leave initialisation mode at time 0.

        Args:
            values: to set, by name.
            stop_time: that the FMU is told; some refuse to go beyond [s].

        Raises:
            ParameterError, FmuError: the FMU refused; the message holds what it logged.
        """
        self.set_values(values or {})
        self.enter_initialization(0.0, stop_time)
        self.exit_initialization()


class Host(_SteppedPart, Fmu2Part):
    """One instance of an FMU 2.0 that is stepped by calls from Python."""

    def start_seconds(self) -> float:
        """Wall time [s] to instantiate and initialise one more instance.

        Raises:
            FmuError: it does not initialise.
        """
        first = self.slave.component
        begin = perf_counter()
        self._instantiate()
        try:
            self.initialise()
            return perf_counter() - begin
        finally:
            self.slave.fmi2FreeInstance(self.slave.component)
            self.slave.component = first

    def step(self, time: float, step_size: float) -> None:
        """Advance from `time` by `step_size` [s].

        Raises:
            FmuError: the step was discarded or failed; the message holds what the FMU logged.
        """
        try:
            self.slave.doStep(time, step_size)
        except FMICallException as error:
            self.failed()
            raise FmuError(self._refusal(f"{self.name} does not step", error)) from error

    def save(self) -> c_void_p:
        """A saved state; raises FMICallException."""
        return self.slave.getFMUstate()

    def through_bytes(self, state: c_void_p) -> c_void_p:
        """The same state, serialised and back; raises FMICallException."""
        data = self.slave.serializeFMUstate(state)
        self.slave.freeFMUstate(state)
        return self.slave.deSerializeFMUstate(data)

    def restore(self, state: c_void_p) -> None:
        """Go back to a saved state and free it; raises FMICallException."""
        self.slave.setFMUstate(state)
        self.slave.freeFMUstate(state)


class Host3(_SteppedPart, Fmu3Part):
    """One instance of an FMU 3.0 that is stepped by calls from Python, without event mode."""

    with_events = False

    def step(self, time: float, step_size: float) -> None:
        """Advance from `time` by `step_size` [s].

        Raises:
            FmuError: the step was discarded, failed or ended early; the message holds what the FMU
                logged.
        """
        try:
            _, terminate, early, reached = self.slave.doStep(time, step_size)
        except FMICallException as error:
            self.failed()
            raise FmuError(self._refusal(f"{self.name} does not step", error)) from error
        if terminate or early:
            what = "asks to end the simulation" if terminate else "ended its step early"
            said = "; ".join([f"{self.name} {what}, at {reached:g} s", *self.messages()])
            raise FmuError(said)

    def save(self) -> c_void_p:
        """A saved state; raises FMICallException."""
        return self.slave.getFMUState()

    def through_bytes(self, state: c_void_p) -> c_void_p:
        """The same state, serialised and back; raises FMICallException."""
        data = self.slave.serializeFMUState(state)
        self.slave.freeFMUState(state)
        return self.slave.deserializeFMUState(data)

    def restore(self, state: c_void_p) -> None:
        """Go back to a saved state and free it; raises FMICallException."""
        self.slave.setFMUState(state)
        self.slave.freeFMUState(state)


def open_host(name: str, file: Path) -> Host | Host3:
    """A host for an FMU 2.0 or 3.0; raises FmuError."""
    model = read_fmu(file)
    return (Host3 if is_fmi3(model) else Host)(name, file, model)
