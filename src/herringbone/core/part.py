"""What a co-simulation master needs to know of a participant, be it an FMU or in-process."""

import math
from collections.abc import Container, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from herringbone.core.declaring.declaration import (
    INTERFACE_DEGREE,
    is_node,
    node_name,
    signal_of,
)
from herringbone.core.errors import HerringboneError

Value = float | str | bytes
"""Value of a variable of any FMI type; also an int or a bool."""
ValueOrArray = Value | Sequence[Value]
"""What a variable may be set to: an array takes all its values."""
STRUCTURE = "structuralParameter"
"""Causality of what decides how large arrays are."""


@dataclass(frozen=True, slots=True)
class PartVariable:
    """One variable of a participant.

    Attributes:
        name: structured name.
        reference: number by which the part's functions know it: the FMI value reference, or the
            number of the element if the part is an FMU 3.0.
        causality: "input", "output", "parameter", "local" or other.
        unit: unit name, None if none is declared.
        dimension: factor, offset and base-unit exponents, for comparing units; None if unknown.
        dependencies: inputs on which an output depends directly; None if not declared.
        type: FMI type; of an array's element that of the array.
        rate: output that is the time derivative of this output, "" if there is none; None if the
            part does not declare it, see `cosim.structure.rates`.
        array: name of the array of which it is an element, "" for a scalar.
        items: numbers of an enumeration by their names.
        own_unit: of a signal that is converted to SI units: its own unit, the factor and the
            offset; it is recorded in that.
        starts: no input or parameter, but its value at the start may be set.
        relative: a difference, as of two temperatures; its dimension has no offset.
    """

    name: str
    reference: int
    causality: str
    unit: str | None = None
    dimension: tuple | None = None
    dependencies: frozenset[str] | None = None
    type: str = "Real"
    rate: str | None = None
    array: str = ""
    items: tuple[tuple[str, int], ...] = ()
    own_unit: tuple[str, float, float] | None = None
    starts: bool = False
    relative: bool = False

    @property
    def is_real(self) -> bool:
        """True for numbers of double precision, which the compiled loops exchange."""
        return self.type in {"Real", "Float64"}


class Addresses(NamedTuple):
    """Addresses of the FMI functions that the compiled loop calls, and of the component.

    The state functions are 0 if the part cannot save and restore its state; those of derivatives
    (fmi2SetRealInputDerivatives, fmi2GetRealOutputDerivatives) if it declares none.

    A part outside of this process has two more, which save messages: get_later, as fmi2GetReal, but
    the values come when finish(component, 1) has returned, which tells the status of all before it;
    finish(component, 0) sends all that was called, and returns at once. A call of get_later
    without references begins: no step is made until finish.

    answers_later: 1 if what a step costs is paid when outputs are read, and other parts may step
    meanwhile.
    """

    component: int
    set_real: int
    get_real: int
    do_step: int
    get_state: int = 0
    set_state: int = 0
    free_state: int = 0
    set_derivatives: int = 0
    get_derivatives: int = 0
    get_later: int = 0
    finish: int = 0
    answers_later: int = 0

    @property
    def can_restore(self) -> bool:
        """True if the state can be saved and restored."""
        return self.get_state != 0


class Part(Protocol):
    """A participant of a co-simulation, instantiated.

    Attributes:
        name: instance name.
        variables: by name.
        has_states: whether outputs depend on what inputs were before; None if only the declared
            dependencies tell, by which a part that passes inputs to outputs has none.
        once: True if there can be no second instance in the same process.
        one_step: True if the part declares that its steps must all have one length.
    """

    name: str
    variables: Mapping[str, PartVariable]
    has_states: bool | None
    once: bool
    one_step: bool

    @property
    def addresses(self) -> Addresses:
        """What the compiled loop calls."""

    def new_state(self) -> int:
        """Handle that fmi2GetFMUstate is given first: 0, or memory that the part provides."""

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set a variable before or during initialisation; raises ParameterError."""

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of real variables."""

    def put_values(self, values: Mapping[str, Value]) -> None:
        """Set variables that are not of the loops at a communication point; raises FmuError."""

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """Values of variables of other types than real; raises FmuError."""

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Go to initialisation mode; start values have been set.

        Args:
            start_time, stop_time: [s].
            tolerance: relative error that the part may leave [1]; None: its own choice.
        """

    def exit_initialization(self) -> None:
        """Go to step mode; raises HerringboneError if the part refuses."""

    def failed(self) -> None:
        """A step of the part failed, so that FMI allows nothing but to free it."""

    def ended(self) -> float | None:
        """Time at which the part asked to end the simulation [s]; None if it did not."""

    def messages(self) -> list[str]:
        """Messages that the part logged since the last call."""

    def close(self) -> None:
        """Terminate the part, if it was initialised and has not failed, and free it."""


@contextmanager
def closing_all(parts: Sequence[Part]) -> Iterator[Sequence[Part]]:
    """Close all parts in the end, as `contextlib.closing` does with one."""
    try:
        yield parts
    finally:
        for part in parts:
            part.close()


def of_parts(part: Part) -> bool:
    """True if a part stands for several ones of this package: its inputs are polynomials."""
    return bool(getattr(part, "of_parts", False))


def column(part: Part, name: str) -> str:
    """`instance.variable`, as an output is recorded; a part of parts has such names itself."""
    return name if of_parts(part) else f"{part.name}.{name}"


def is_signal_node(variables: Container[str], name: str) -> bool:
    """True for a value of another variable at a node; `plate.node_7` and the like are signals.

    Args:
        variables: names of all variables of the part.
        name: of one of them.
    """
    return is_node(name) and signal_of(name) in variables


def to_si(v: PartVariable, where: str, kind: type[HerringboneError]) -> tuple[float, float]:
    """Factor and offset of a variable's values to SI units; what has no unit is in them.

    Args:
        v: the variable.
        where: it is, for the message.
        kind: of error that is raised if the definition of its unit is no conversion.
    """
    factor, offset = v.dimension[:2] if v.dimension else (1.0, 0.0)
    if factor == 0.0 or not (math.isfinite(factor) and math.isfinite(offset)):
        raise kind(
            f"{where}: unit '{v.unit}' has the factor {factor:g} and the offset {offset:g} to SI "
            "units; no value can be converted"
        )
    return factor, offset


def reals(part: Part, causality: str) -> list[str]:
    """Names of a part's real variables of a causality, nodes of signals left out."""
    return [
        name
        for name, v in part.variables.items()
        if v.causality == causality and v.is_real and not is_signal_node(part.variables, name)
    ]


def has_nodes(part: Part, inputs: Sequence[str], degree: int) -> bool:
    """True if these inputs of a part take polynomial signals of that degree."""
    return degree == 0 or (
        INTERFACE_DEGREE in part.variables
        and all(node_name(name, degree) in part.variables for name in inputs)
    )
