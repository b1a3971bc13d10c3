"""Runs of a housing from rest, under held forces at its seats, and what they cost."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from herringbone.core.declaring.roles import HALVES
from herringbone.core.part import Part
from herringbone.core.process.activity import lasting, tell
from herringbone.core.wording import option
from herringbone.cosim.loops.drive import drive
from herringbone.cosim.signature.cost import PATIENCE
from herringbone.cosim.signature.trial import check_length

_AXES = "xyz"
FORCES = tuple(f"{seat}.f_{axis}" for seat in HALVES for axis in _AXES)
POSITIONS = tuple(f"{seat}.s_{axis}" for seat in HALVES for axis in _AXES)
VELOCITIES = tuple(f"{seat}.v_{axis}" for seat in HALVES for axis in _AXES)
VARIABLES = (*FORCES, *POSITIONS, *VELOCITIES)


class Runs:
    """Runs of new instances.

    Args:
        open_part: makes a new instance, not yet initialised.
        step: communication step size [s].
        longest: steps that a run may have; any number if None.

    Attributes:
        step: [s].
        seconds: of the quickest run so far, for each of its steps [s]; only for telling.
    """

    def __init__(
        self, open_part: Callable[[], Part], step: float, longest: int | None = None
    ) -> None:
        self._open, self.step, self._longest = open_part, step, longest
        self.seconds = np.inf

    def positions(self, forces: np.ndarray, step: float | None = None) -> np.ndarray:
        """(n + 1, 12) positions [m] under forces (n, 12) [N]; raises Refused."""
        return self.outputs(forces, POSITIONS, step)

    def outputs(
        self, forces: np.ndarray, names: tuple[str, ...], step: float | None = None
    ) -> np.ndarray:
        """(n + 1, m) outputs under forces (n, 12) [N]; raises Refused if it would be too long."""
        check_length(len(forces), self._longest)
        step = step or self.step
        part = self._open()
        try:
            part.enter_initialization(0.0, (len(forces) + 1) * step)
            part.exit_initialization()
            begun = perf_counter()
            found = drive(part, FORCES, forces, names, step)
            self.seconds = min(self.seconds, (perf_counter() - begun) / len(forces))
            return found
        finally:
            part.close()

    def allows(self, steps: int) -> bool:
        """True if a run may have so many steps."""
        return self._longest is None or steps <= self._longest

    def tell_cost(self, name: str, steps: int, short: int) -> None:
        """Say what further tests of a slow housing take, after the first runs; no clock decides.

        Args:
            name: of the part.
            steps: of all tests.
            short: of a run that leaves the long ones out.
        """
        if steps * self.seconds > PATIENCE:
            tell(
                f"{name} is slow, {self.seconds:.2g} s a step: the tests of what a housing must do "
                f"take {steps} steps, {lasting(steps * self.seconds)}; "
                f"{option('longest_trial', short)} leaves those out that take the most, 'run' with "
                f"{option('probe', False)} all"
            )
