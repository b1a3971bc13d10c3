"""A throw-away instance of a part, stepped by hand through the functions that the loop calls."""

import ctypes
from collections.abc import Sequence

import numpy as np

from herringbone.core import FmuError
from herringbone.core.part import Part
from herringbone.core.wording import option
from herringbone.cosim.cell.part import CellPart
from herringbone.cosim.cell.policy import Policy, policy
from herringbone.cosim.loops.calls import (
    do_step,
    exchange_derivatives,
    exchange_reals,
    state_call,
)
from herringbone.cosim.loops.common import LAST_GOOD
from herringbone.kernels.fmi_calls import DISCARD

_FATAL = 4


class Refused(FmuError):
    """A part refused a trial step, a value or its state; or a run would have too many steps.

    Attributes:
        lost: the part crashed, or gave no answer in time: another time it may do otherwise.
    """

    def __init__(self, message: str, *, lost: bool = False) -> None:
        super().__init__(message)
        self.lost = lost


class EndedError(FmuError):
    """No further trial steps of a part are made, as those that are allowed have been."""


NOT_TRIED = Refused, EndedError
"""Why a trial has no outcome."""


def check_length(steps: int, longest: int | None) -> None:
    """Check that a run has no more steps than are allowed, any if None; raises Refused."""
    if longest is not None and steps > longest:
        raise Refused(f"it takes a run of {steps} steps, {longest} are allowed")


def _initialise(part: Part, start: float, stop: float, tolerance: float | None) -> None:
    """Where a part is in a cell, by one message: there may be hundreds of instances."""
    if isinstance(part, CellPart):
        part.initialise(start, stop, tolerance)
    else:
        part.enter_initialization(start, stop, tolerance)
        part.exit_initialization()


class Trial:
    """An initialised part at its start time.

    Args:
        part: instantiated, start values set; it belongs to the trial, which closes it.
        inputs, outputs: names of its real inputs and outputs.
        start_time, stop_time: of the experiment [s].
        tolerance: that the part is told [1]; None: none.
        counted: its steps count among those that all trials of a part may have together.

    Raises:
        FmuError: the part does not initialise.
    """

    def __init__(
        self,
        part: Part,
        inputs: Sequence[str],
        outputs: Sequence[str],
        start_time: float = 0.0,
        stop_time: float = 1.0,
        tolerance: float | None = None,
        *,
        counted: bool = True,
    ) -> None:
        self.part, self.time = part, start_time
        self._inputs, self._outputs = (
            np.array([part.variables[name].reference for name in names], dtype=np.uint32)
            for names in (inputs, outputs)
        )
        # Asking an array for its address takes as long as a small part's step.
        self._given, self._found = np.zeros(self._inputs.size), np.zeros(self._outputs.size)
        self._given_at, self._found_at = self._given.ctypes.data, self._found.ctypes.data
        self._inputs_at, self._outputs_at = self._inputs.ctypes.data, self._outputs.ctypes.data
        self._saved: dict[int, float] = {}
        try:
            _initialise(part, start_time, stop_time, tolerance)
        except FmuError:
            part.close()
            raise
        self._at = part.addresses
        self._policy = policy() if counted else Policy()

    def set(self, values: np.ndarray) -> None:
        """Set all inputs (n,); raises Refused."""
        self._given[:] = values
        status = self._exchange(
            self._at.set_real, self._inputs_at, self._given.size, self._given_at
        )
        if status > LAST_GOOD:
            raise self._refusal("an input value", status)

    def values(self) -> np.ndarray:
        """(m,) all outputs; raises Refused."""
        status = self._exchange(
            self._at.get_real, self._outputs_at, self._found.size, self._found_at
        )
        if status > LAST_GOOD:
            raise self._refusal("to give its outputs", status)
        return self._found.copy()

    def set_derivatives(self, values: np.ndarray) -> None:
        """Set derivatives (orders n,) of all inputs at the start of a step; raises Refused."""
        n = self._inputs.size
        orders = np.repeat(np.arange(1, values.size // max(n, 1) + 1, dtype=np.int32), n)
        references = np.tile(self._inputs, values.size // max(n, 1))
        given = np.ascontiguousarray(values, dtype=float)
        self._derivatives(self._at.set_derivatives, references, orders, given, "derivatives")

    def rates(self) -> np.ndarray:
        """(m,) rates of all outputs at the end of a step; raises Refused."""
        found = np.empty(self._outputs.size)
        orders = np.ones(found.size, dtype=np.int32)
        self._derivatives(
            self._at.get_derivatives, self._outputs, orders, found, "to give its outputs' rates"
        )
        return found

    def _derivatives(
        self,
        address: int,
        references: np.ndarray,
        orders: np.ndarray,
        values: np.ndarray,
        what: str,
    ) -> None:
        if values.size == 0:
            return
        status = exchange_derivatives(
            address,
            self._at.component,
            references.ctypes.data,
            references.size,
            orders.ctypes.data,
            values.ctypes.data,
        )
        if status > LAST_GOOD:
            raise self._refusal(what, status)

    def step(self, h: float) -> None:
        """Step by h [s]; raises Refused, EndedError."""
        self._count()
        status = do_step(self._at.do_step, self._at.component, self.time, h)
        if status > LAST_GOOD:
            raise self._refusal(f"a step of {h:g} s", status)
        self.time += h

    def _count(self) -> None:
        most = self._policy.most_trial_steps
        if most is not None and self._policy.taken[self.part.name] >= most:
            raise EndedError(
                f"{option('most_trial_steps', most)}: no more steps of {self.part.name} are taken "
                "in trials"
            )
        self._policy.taken[self.part.name] += 1

    @property
    def can_restore(self) -> bool:
        """True if the part says that it saves and restores its state."""
        return self._at.can_restore

    def save(self) -> int:
        """Handle of the present state; raises Refused."""
        handle = ctypes.c_void_p(self.part.new_state())
        status = state_call(self._at.get_state, self._at.component, ctypes.addressof(handle))
        if status > LAST_GOOD:
            raise self._refusal("to save its state", status)
        found = int(handle.value or 0)
        self._saved[found] = self.time
        return found

    def restore(self, handle: int) -> None:
        """Go back to a saved state; raises Refused."""
        status = state_call(self._at.set_state, self._at.component, handle)
        if status > LAST_GOOD:
            raise self._refusal("to restore its state", status)
        self.time = self._saved[handle]

    def close(self) -> None:
        """Free states and part."""
        for handle in self._saved:
            kept = ctypes.c_void_p(handle)
            state_call(self._at.free_state, self._at.component, ctypes.addressof(kept))
        self.part.close()

    def _exchange(self, address: int, references: int, count: int, values: int) -> int:
        """Status of a call, of none if there is nothing to set or get."""
        if count == 0:
            return 0
        return exchange_reals(address, self._at.component, references, count, values)

    def _refusal(self, what: str, status: int) -> Refused:
        """What is raised; after an error FMI allows nothing but to free the part."""
        if status > DISCARD:
            self.part.failed()
            self._saved.clear()
        said = "; ".join(self.part.messages())
        whole = f"{self.part.name} refuses {what} (status {status})" + (f": {said}" if said else "")
        lost = status >= _FATAL
        if lost:
            policy().note_lost(self.part.name, said or f"status {status}")
        return Refused(whole, lost=lost)
