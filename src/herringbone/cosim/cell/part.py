"""An FMU in a cell, as participant."""

import ctypes
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from fmpy.model_description import ModelDescription

from herringbone.core import FmuError, HerringboneError
from herringbone.core.part import STRUCTURE, Addresses, PartVariable, Value, ValueOrArray
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.core.wording import option
from herringbone.cosim.cell.block import INSTANCE, KINDS, READS, STATES, fits
from herringbone.cosim.cell.calls import derivatives, signals, states
from herringbone.cosim.cell.policy import Remark, policy
from herringbone.cosim.cell.pool import give_back
from herringbone.cosim.cell.process import Cell, CellLost
from herringbone.cosim.fmu.variables import read_variables, resized

if TYPE_CHECKING:
    from herringbone.cosim.signature.signature import Signature

_LAST_GOOD = 1
_FUNCTIONS = {
    "set_real": signals.set_real,
    "get_real": signals.get_real,
    "do_step": signals.do_step,
    "get_state": states.get_state,
    "set_state": states.set_state,
    "free_state": states.free_state,
    "set_derivatives": derivatives.set_derivatives,
    "get_derivatives": derivatives.get_derivatives,
}
_SEND = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


class CellPart:
    """An FMU 2.0 or 3.0 in a cell; see `FmuPart`, which it is there.

    Args:
        name: instance name.
        file: the FMU.
        model: its model description.
        folder: where it is extracted.
        cell: in which it is instantiated.
        owned: cell and folder belong to the part, and end with it.
        variables: of the model, if they have been read.

    Raises:
        FmuError: it does not instantiate, or the cell does not survive that.
    """

    def __init__(
        self,
        name: str,
        file: Path,
        model: ModelDescription,
        folder: Path,
        cell: Cell,
        *,
        owned: bool,
        variables: Mapping[str, PartVariable] | None = None,
    ) -> None:
        self.name, self.file, self.model = name, file, model
        self.has_states: bool | None = None
        self.signature: Signature | None = None
        self.variables: Mapping[str, PartVariable] = variables or read_variables(model)
        abilities = model.coSimulation
        self.once = bool(abilities.canBeInstantiatedOnlyOncePerProcess)
        self.one_step = not abilities.canHandleVariableCommunicationStepSize
        self._cell, self._folder, self._owned = cell, folder, owned
        self._remarks = policy().remarks
        self._number = cell.new_instance()
        self._memory = np.zeros(1, INSTANCE)
        self._closed = self._failed = False
        try:
            has = cell.ask("open", self._number, name, str(file.absolute()), str(folder))
        except HerringboneError:
            self._leave()
            raise
        self._has = dict(zip(Addresses._fields, has, strict=True))
        self._make_memory()

    def _make_memory(self) -> None:
        """What the adapters know."""
        words = int(self._cell.side.record["capacity"][0])
        self._arrays: dict[str, np.ndarray] = {
            "words": np.zeros(words, np.int64),
            "known": np.zeros(KINDS, np.uint8),
            "slots": np.zeros(STATES, np.uint8),
            "references": np.zeros(words, np.uint32),
            "found": np.zeros(words),
            "rates": np.zeros(words, np.uint32),
            "orders": np.zeros(words, np.int32),
            "rate_found": np.zeros(words),
            "wanted": np.zeros(3 * READS, np.int64),
        }
        self._memory["side"] = self._cell.side.address
        self._memory["number"] = self._number
        for name, array in self._arrays.items():
            self._memory[name] = array.ctypes.data

    @property
    def addresses(self) -> Addresses:
        """Addresses of the adapters, of what the FMU has; the component is their memory."""
        found = {name: f.address for name, f in _FUNCTIONS.items() if self._has[name]}
        found |= {"get_later": signals.get_later.address, "finish": signals.finish.address}
        return Addresses(self._memory.ctypes.data, **found, answers_later=1)

    def new_state(self) -> int:
        """0: the adapters number the states."""
        return 0

    def _sent(self) -> int:
        """Send what the adapters have collected; FMI status."""
        return _SEND(signals.send.address)(self._memory.ctypes.data)

    def _ask(self, call: str, *arguments: object) -> object:
        """Call a function of the part in the cell; raises HerringboneError."""
        if self._sent() > _LAST_GOOD and not self._cell.lost:
            said = "; ".join(self._cell.ask("messages", self._number))
            raise FmuError(f"{self.name} refuses a step, a value or a state: {said}")
        return self._cell.ask(call, self._number, *arguments)

    def set(self, name: str, value: ValueOrArray) -> None:
        """See `FmuPart.set`."""
        self._ask("set", name, value)
        known = self.variables.get(name)
        if known is not None and known.causality == STRUCTURE:
            self.variables = resized(self.model, name, int(float(value)))  # type: ignore[arg-type]
            if not fits(len(self.variables), int(self._cell.side.record["capacity"][0])):
                raise FmuError(
                    f"{self.name}.{name} = {value!r}: too many signals for a cell; use "
                    f"{option('in_process', True)}"
                )

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables; raises FmuError."""
        return self._ask("get", list(names))  # type: ignore[return-value]  # numbers

    def put_values(self, values: Mapping[str, Value]) -> None:
        """Set variables at a communication point; raises FmuError."""
        self._ask("put_values", dict(values))

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """Values of variables of other types than real; raises FmuError."""
        return self._ask("get_values", list(names))  # type: ignore[return-value]

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Set up the experiment and enter initialisation mode; raises FmuError."""
        share = () if tolerance is None else (float(tolerance),)
        self._ask("enter_initialization", float(start_time), float(stop_time), *share)

    def exit_initialization(self) -> None:
        """Go to step mode; raises FmuError."""
        self._ask("exit_initialization")

    def initialise(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Enter initialisation mode and leave it, by one message; raises FmuError."""
        share = () if tolerance is None else (float(tolerance),)
        self._ask("initialise", float(start_time), float(stop_time), *share)

    def failed(self) -> None:
        """A step failed: FMI then allows no call but fmi2FreeInstance."""
        self._failed = True
        self._memory["used"] = self._memory["waiting"] = self._memory["reads"] = 0
        if not self._cell.lost:
            self._ask("failed")

    def ended(self) -> float | None:
        """Time at which the FMU asked to end the simulation [s]; None if it did not."""
        if self._cell.lost:
            return None
        try:
            return self._ask("ended")  # type: ignore[return-value]
        except CellLost:
            return None

    def messages(self) -> list[str]:
        """Warnings and errors logged since the last call, or why the cell is lost."""
        try:
            if not self._cell.lost:
                return self._ask("messages")  # type: ignore[return-value]
        except CellLost:
            pass
        return [self._cell.why]

    def close(self) -> None:
        """Terminate and free the instance; what happens there is a remark, see `policy`."""
        if self._closed:
            return
        if not self._cell.lost:
            self._end()
        self._leave()

    def _end(self) -> None:
        try:
            if not self._failed:
                self._sent()
            # Of hundreds of trial instances none tells which of both calls it did not survive.
            for call in ("terminate", "free") if self._owned else ("end",):
                self._cell.ask(call, self._number)
            if self._owned:
                changed = self._cell.ask("changed", self._number)
                if changed:
                    self._remark(f"changed {', '.join(changed)} of its process; the cell held it")
        except CellLost:
            why = f"did not survive its end: {self._cell.why}; the results are complete"
            self._remark(why, crashed=True)
        except HerringboneError as error:
            self._remark(f"did not end well: {error}")

    def _remark(self, text: str, *, crashed: bool = False) -> None:
        if self._owned:
            self._remarks.append(Remark(self.name, text, crashed))

    def _leave(self) -> None:
        """Give back the cell, and what belongs to the part."""
        self._closed = True
        self._cell.forget(self._number, self._memory.ctypes.data)
        if not self._owned:
            return
        give_back(self._cell)
        if said := self._cell.log.described():
            self._remark(said)
        remove_temporary_folder(self._folder)
