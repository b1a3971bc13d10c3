"""What a scene asks: quantities, as what, how well, and where; and what its model leaves out."""

import math
from dataclasses import dataclass
from enum import StrEnum

from herringbone.analysis.leaner.form import Form
from herringbone.core import ParameterError
from herringbone.scenes.checks import chosen

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
        """Take a text for one name or the form, and check values.

        Raises:
            ParameterError: nothing is asked, or a value is out of range.
        """
        object.__setattr__(self, "form", chosen(Form, self.form, "ask: as"))
        if isinstance(self.what, str):
            object.__setattr__(self, "what", (self.what,))
        if not self.what:
            raise ParameterError(
                'ask: what: it takes the names of what is asked, ["seat velocity"]'
            )
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
        speed: set point that the system declares, at its own shaft [rad/s].
        torque: the same [N m].
        solver_tolerance: for steady states, which a plan found; None: follows from what is asked.
    """

    motion: Motion = Motion.STEADY
    speed: Range | None = None
    torque: Range | None = None
    solver_tolerance: float | None = None

    def __post_init__(self) -> None:
        """Take a text for the motion.

        Raises:
            ParameterError: there is no such motion.
        """
        object.__setattr__(self, "motion", chosen(Motion, self.motion, "operating: motion"))


@dataclass(frozen=True)
class Model:
    """What a model leaves out, and what is known of its error.

    Attributes:
        hold: states that keep their start values.
        one_way: parts that are driven but not felt.
        error: the largest of all that was asked, certified; None: unknown.
        speed, torque: where that was certified.
        frozen: parts whose laws are straight lines about their mean deflections.
        linear: parts whose laws have mean slopes besides.
        harmonics: parts, and how many harmonics of their laws' tables are kept.
    """

    hold: tuple[str, ...] = ()
    one_way: tuple[str, ...] = ()
    error: float | None = None
    speed: Range | None = None
    torque: Range | None = None
    frozen: tuple[str, ...] = ()
    linear: tuple[str, ...] = ()
    harmonics: tuple[tuple[str, int], ...] = ()

    def __bool__(self) -> bool:
        return bool(self.hold or self.parts)

    @property
    def parts(self) -> tuple[str, ...]:
        """Parts of which something is left out."""
        tables = (part for part, _ in self.harmonics)
        return (*self.one_way, *self.frozen, *self.linear, *tables)
