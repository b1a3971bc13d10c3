"""Variables, declared once; everything that shows a variable is derived from these."""

import math
from dataclasses import dataclass
from enum import StrEnum

from herringbone.core.declaring.roles import Quantity

NODES = 4
"""Most nodes of a polynomial coupling signal inside a macro step, besides its value at c = 0."""


class Causality(StrEnum):
    """FMI causality."""

    INPUT = "input"
    OUTPUT = "output"
    LOCAL = "local"
    PARAMETER = "parameter"


class Variability(StrEnum):
    """FMI variability."""

    CONTINUOUS = "continuous"
    FIXED = "fixed"
    TUNABLE = "tunable"


@dataclass(frozen=True, slots=True)
class Variable:
    """One real variable of a component.

    Attributes:
        name: structured FMI name, such as `pinion_left.s_y`.
        unit: one of `herringbone.core.declaring.units.UNITS`.
        causality, variability: as in FMI.
        description: one line.
        start: start value, in `unit`.
        feedthrough: inputs on which an output depends directly.
        nodes: the signal also has values at the nodes of a macro step (`name.node1` ...).
        state: a continuous state, integrated by the component; its start value is exact.
        steady: how a state, or a flagged output, behaves in steady rotation:
            "constant" (its derivative vanishes), "rotating" (an absolute angle),
            "zero" (an output that vanishes), or "" (no statement).
        minimum, maximum: range of a parameter, in `unit`.
        nominal: usual size of a state, in `unit`, by which integrators scale their tolerance.
        whole: a parameter that takes whole numbers only.
        items: names of the numbers 0, 1, ... that a parameter takes; in native FMUs it is an
            Enumeration. Empty: it is a number.
        rate: the output that is the time derivative of this output, if there is one.
        quantity, place: what it means to those who ask for the component's role, and where.
        at_rest: of a parameter, the input whose value in steady rotation it takes at the start.
    """

    name: str
    unit: str
    causality: Causality
    variability: Variability
    description: str
    start: float = 0.0
    feedthrough: tuple[str, ...] = ()
    nodes: bool = False
    state: bool = False
    steady: str = ""
    minimum: float = -math.inf
    maximum: float = math.inf
    nominal: float = 1.0
    whole: bool = False
    items: tuple[str, ...] = ()
    rate: str = ""
    quantity: Quantity | None = None
    place: str = ""
    at_rest: str = ""


@dataclass(frozen=True, slots=True)
class StateVector:
    """States of which a resource file decides how many there are.

    They are hidden: the block has room for `capacity` of them, of which the first ones are in use
    and the others stay 0, so that co-simulation takes any data. A native FMU is built with one data
    set; the elements that are in use there become variables, `x[1]`, `x[2]`, ..., and states of its
    model exchange. A system as one component keeps the vectors of its parts, `part.x`.

    Attributes:
        name: of the vector; the vector `der(x)` has the derivatives of the vector `x`.
        unit, description: as of a variable.
        capacity: room in the block.
        elements: what the elements stand for, in the plural, such as "modes".
        text: the String parameter whose file decides how many there are; "": all are in use.
        length: index in the tables at which loading writes how many there are.
    """

    name: str
    unit: str
    description: str
    capacity: int
    elements: str = "elements"
    text: str = ""
    length: int = 0

    def element(self, k: int) -> str:
        """Name of element k = 1, 2, ...; FMI's structured names put the index inside `der(...)`."""
        inside = self.name.removesuffix(")")
        return f"{inside}[{k}]" + self.name[len(inside) :]


def input_(
    name: str,
    unit: str,
    description: str,
    start: float = 0.0,
    *,
    quantity: Quantity | None = None,
) -> Variable:
    """A continuous input; every input is a polynomial signal."""
    return Variable(
        name,
        unit,
        Causality.INPUT,
        Variability.CONTINUOUS,
        description,
        start,
        nodes=True,
        quantity=quantity,
    )


def output(
    name: str,
    unit: str,
    description: str,
    *,
    feedthrough: tuple[str, ...] = (),
    nodes: bool = False,
    steady: str = "",
    rate: str = "",
    quantity: Quantity | None = None,
    place: str = "",
) -> Variable:
    """A continuous output."""
    return Variable(
        name,
        unit,
        Causality.OUTPUT,
        Variability.CONTINUOUS,
        description,
        feedthrough=feedthrough,
        nodes=nodes,
        steady=steady,
        rate=rate,
        quantity=quantity,
        place=place,
    )


def state(
    name: str,
    unit: str,
    description: str,
    start: float = 0.0,
    steady: str = "constant",
    *,
    nominal: float = 1.0,
) -> Variable:
    """A continuous state: a local variable whose start value is exact."""
    return Variable(
        name,
        unit,
        Causality.LOCAL,
        Variability.CONTINUOUS,
        description,
        start,
        state=True,
        steady=steady,
        nominal=nominal,
    )


def local(name: str, unit: str, description: str, *, nominal: float = 1.0) -> Variable:
    """A local variable that the kernel updates and that is no state, such as a time counter."""
    return Variable(
        name, unit, Causality.LOCAL, Variability.CONTINUOUS, description, nominal=nominal
    )


def parameter(
    name: str,
    unit: str,
    description: str,
    start: float,
    *,
    minimum: float = -math.inf,
    maximum: float = math.inf,
    tunable: bool = False,
    whole: bool = False,
    quantity: Quantity | None = None,
    place: str = "",
    at_rest: str = "",
) -> Variable:
    """A parameter with the range in which the equations hold."""
    return Variable(
        name,
        unit,
        Causality.PARAMETER,
        Variability.TUNABLE if tunable else Variability.FIXED,
        description,
        start,
        minimum=minimum,
        maximum=maximum,
        whole=whole,
        quantity=quantity,
        place=place,
        at_rest=at_rest,
    )


def choice(name: str, description: str, items: tuple[str, ...], start: int) -> Variable:
    """A parameter that is one of some items, by its number from 0."""
    return Variable(
        name,
        "1",
        Causality.PARAMETER,
        Variability.FIXED,
        description,
        float(start),
        minimum=0.0,
        maximum=float(len(items) - 1),
        whole=True,
        items=items,
    )
