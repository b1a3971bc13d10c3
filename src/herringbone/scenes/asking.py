"""What a scene asks: quantities, as what, how well, and where; and what its model leaves out."""

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

from herringbone.analysis.leaner.form import Form
from herringbone.core import ParameterError
from herringbone.core.given import names, several
from herringbone.core.lean import WHOLE, Lean
from herringbone.scenes.checks import chosen, ends, number

SHARE = 0.5
"""Of a tolerance, for what the model leaves out, and as much for the solver."""
LEAST = 2e-7
"""Tolerance that can be asked for: solvers go to half of it."""
Range = tuple[float, float]
"""Lowest and highest value."""


class Motion(StrEnum):
    """What kind of motion is asked about."""

    STEADY = "steady"
    """The periodic state that a constant operating point settles to."""
    TRANSIENT = "transient"
    """The run of the scene, from its start to its end."""


@dataclass(frozen=True)
class Ask:
    """A quantity that is to be known.

    Attributes:
        what: groups of channels, patterns of outputs, or quantities by name, see
            `analysis.leaner.asked_for`.
        form: as what; a text becomes the choice that it names.
        tolerance: relative error that is allowed.
        band: end of a spectrum [Hz]; infinite: all lines.
        orders: mesh orders, of amplitudes.
    """

    what: tuple[str, ...]
    form: Form = Form.SPECTRUM
    tolerance: float = 0.01
    band: float = math.inf
    orders: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        """Take a text for one name or the form, a number for one order, and check values.

        Raises:
            ParameterError: nothing is asked, or a value is of the wrong type or out of range.
        """
        put = partial(object.__setattr__, self)
        put("form", chosen(Form, self.form, "ask: as"))
        put("what", names(self.what, "ask: what"))
        if not self.what:
            raise ParameterError(
                'ask: what: it takes the names of what is asked, ["seat velocity"]'
            )
        put("tolerance", number(self.tolerance, "ask: tolerance"))
        put("orders", tuple(number(k, "ask: orders") for k in several(self.orders)))
        if self.band != math.inf:
            put("band", number(self.band, "ask: band"))
        self._check_ranges()

    def _check_ranges(self) -> None:
        """Raise ParameterError if a value is out of range."""
        if not 0.0 < self.tolerance < 1.0:
            raise ParameterError(
                f"ask: tolerance = {self.tolerance:g}: it must lie between 0 and 1"
            )
        if self.tolerance < LEAST:
            raise ParameterError(f"ask: tolerance = {self.tolerance:g}: at least {LEAST:g}")
        if self.band < math.inf and (self.form != Form.SPECTRUM or not self.band > 0.0):
            raise ParameterError(
                f'ask: band = {self.band:g} Hz: it must be positive, and is of as = "spectrum"'
            )
        if (self.form == Form.ORDER) != bool(self.orders) or any(k <= 0.0 for k in self.orders):
            raise ParameterError(
                'ask: orders: a list of positive mesh orders goes with as = "order"'
            )

    @property
    def name(self) -> str:
        """For people."""
        what = ", ".join(self.what)
        if self.form is Form.SPECTRUM:
            return f"spectrum of {what}" + (f" to {self.band:g} Hz" if self.band < math.inf else "")
        if self.form is Form.ORDER:
            return f"order {', '.join(f'{k:g}' for k in self.orders)} of {what}"
        return f"{self.form} of {what}"


@dataclass(frozen=True)
class Operating:
    """Where something is asked; None: as the scene has it.

    Attributes:
        motion: what kind of; a text becomes the choice that it names.
        speed: set point that the system declares, at its own shaft [rad/s]; a number is both ends.
        torque: the same [N m].
        solver_tolerance: for steady states, which a plan found; None: follows from what is asked.
    """

    motion: Motion = Motion.STEADY
    speed: Range | None = None
    torque: Range | None = None
    solver_tolerance: float | None = None

    def __post_init__(self) -> None:
        """Take a text for the motion, a number for both ends of a range, and check values.

        Raises:
            ParameterError: there is no such motion, a value is of the wrong type or out of range,
                or a transient has a set point.
        """
        put = partial(object.__setattr__, self)
        put("motion", chosen(Motion, self.motion, "operating: motion"))
        if self.speed is not None:
            put("speed", ends(self.speed, "operating: speed", still=False))
        if self.torque is not None:
            put("torque", ends(self.torque, "operating: torque"))
        if self.motion is Motion.TRANSIENT and (self.speed or self.torque):
            raise ParameterError(
                "operating: speed, torque: a transient has those of its cycle; set what commands "
                "them"
            )
        if self.solver_tolerance is not None:
            given = number(self.solver_tolerance, "operating: solver_tolerance")
            if not SHARE * LEAST <= given < 1.0:
                raise ParameterError(
                    f"operating: solver_tolerance = {given:g}: it must lie between "
                    f"{SHARE * LEAST:g} and 1"
                )
            put("solver_tolerance", given)


@dataclass(frozen=True, kw_only=True)
class Model(Lean):
    """What a model leaves out, see `Lean`, and what is known of its error.

    Attributes:
        error: the largest of all that was asked, certified; None: unknown.
        speed, torque: where that was certified, as those of `Operating`.
    """

    error: float | None = None
    speed: Range | None = None
    torque: Range | None = None

    def __post_init__(self) -> None:
        """Take a number for both ends of a range, and what `Lean` takes, and check values.

        Raises:
            ParameterError: a value is of the wrong type or out of range.
        """
        super().__post_init__()
        put = partial(object.__setattr__, self)
        if self.error is not None:
            put("error", number(self.error, "model: error"))
        if self.speed is not None:
            put("speed", ends(self.speed, "model: speed", still=False))
        if self.torque is not None:
            put("torque", ends(self.torque, "model: torque"))

    @property
    def left_out(self) -> Lean:
        """What is left out alone, so that models that leave out the same are equal."""
        return WHOLE | self
