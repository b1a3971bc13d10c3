"""A host for one FMU, for checks and golden results; co-simulation has its own loop."""

from collections.abc import Mapping
from time import perf_counter
from types import TracebackType
from typing import Self

from fmpy.fmi1 import FMICallException

from herringbone.core import FmuError
from herringbone.cosim.fmu_part import FmuPart


class Host(FmuPart):
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

    def set_values(self, values: Mapping[str, float | str]) -> None:
        """Set variables by name; raises ParameterError."""
        for name, value in values.items():
            self.set(name, value)

    def values(self, *names: str) -> list[float]:
        """Real variables by name; raises FmuError."""
        return self.get(names)

    def initialise(self, values: Mapping[str, float | str] | None = None) -> None:
        """Set start values, enter and leave initialisation mode at time 0.

        Raises:
            ParameterError, FmuError: the FMU refused; the message holds what it logged.
        """
        self.set_values(values or {})
        self.enter_initialization(0.0, 1.0)
        self.exit_initialization()

    def start_seconds(self) -> float:
        """Wall time [s] to instantiate and initialise one more instance.

        Raises:
            FmuError: it does not initialise.
        """
        first = self.slave.component
        begin = perf_counter()
        self.slave.instantiate(callbacks=self._callbacks, loggingOn=True)
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
            raise FmuError(self._refusal(f"{self.name} does not step", error)) from error
