"""A component: its declaration bound to the kernels that compute it."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.core.declaring.declaration import Declaration
from herringbone.core.declaring.hosting import Asked, ByTolerance, Hosting
from herringbone.core.declaring.pair_values import PairValues
from herringbone.core.declaring.roles import Quantity
from herringbone.core.places.paths import component_folder

if TYPE_CHECKING:
    from herringbone.core.declaring.laws import Laws
    from herringbone.core.instance import Instance


class Kernels(NamedTuple):
    """The three compiled functions of a component, on its block `b` and work space `w`.

    step(b, w, t, h) -> int: advance from t to t + h [s], any 0 <= h <= `Component.longest_step`;
        0 is success. A longer step is refused, and nothing is changed.
    rhs(b, t, dx): write the derivatives of all states.
    out(b, t): write all outputs from states and inputs.
    """

    step: Callable[[np.ndarray, np.ndarray, float, float], int]
    rhs: Callable[[np.ndarray, float, np.ndarray], None]
    out: Callable[[np.ndarray, float], None]


class Beyond(NamedTuple):
    """Where a component leaves what its data were made for.

    Attributes:
        kernel: beyond(b, which, report) -> int, after `out`: 1 where that line holds, with its
            numbers in the report, else 0.
        lines: formats with %g conversions for the report.
    """

    kernel: Callable[[np.ndarray, int, np.ndarray], int]
    lines: tuple[str, ...]


OfPair = Callable[[PairValues, Mapping[str, float]], dict[str, float]]
Commanded = Callable[[np.ndarray, Quantity, float], dict[str, float]]
Freeze = Callable[["Instance", Callable[[np.ndarray], float]], None]


def _no_resources(block: np.ndarray, files: Mapping[str, Path]) -> None:
    del block, files


def _no_breakpoints(block: np.ndarray) -> tuple[float, ...]:
    del block
    return ()


def unchanged(block: np.ndarray) -> None:
    """The `start` and `guess` of components that have none."""
    del block


def unbounded(block: np.ndarray) -> float:
    """The `longest_step` of components that take any."""
    del block
    return math.inf


@dataclass(frozen=True)
class Component:
    """A component that can be instantiated.

    Attributes:
        declaration: variables and layout.
        kernels: compiled functions.
        equations: the docstring of the component's module, Markdown.
        load: reads the resource files (by String parameter) into the tables of a block, which
            depend on nothing else: what it made once is copied; raises ResourceError.
        verify: checks what was loaded against the parameters of a block, at the end of
            initialisation; raises ResourceError.
        start: makes a block's states from its start parameters, at the end of initialisation;
            a kernel, or `unchanged`.
        guess: puts the states where steady rotation is searched from, when the inputs are set:
            inside the limits of a controller, where the equations are not flat.
        motion: kernel (b) that writes the outputs that states alone decide, as `out` does; None:
            `out` does it.
        breakpoints: times [s] at which the right-hand side is not smooth.
        indicators: kernel (b, t, z) that writes the event indicators of model exchange: the
            right-hand side is not smooth where one of them changes its sign.
        indicator_count: how many there are.
        nominals: sizes (hidden_states,) that the elements of the state vectors usually have, from
            the tables of a block; None: 1. Integrators scale their tolerance by them.
        samples: its step also takes samples, which `rhs` and `out` do not show.
        longest_step: the longest macro step [s] that a block takes in one call, so that every call
            ends soon; a kernel, or `unbounded`.
        freeze: replaces the laws of an instance that change with the phase of a mesh by straight
            lines through the operating point. It is given what makes one stiffness [N/m] of those
            of a mesh period (n,), and raises ParameterError if a mesh is open. None: no law needs
            it, or none can.
        of_pair: parameters that follow from the gear pair that a part belongs to, by name; it is
            given the pair and the part's parameters, as they are without the pair. None: none do.
        commanded: parameters by which an output that is a set point has a value for a whole run,
            from a block with its tables; a torque is that at the pinion. It raises ParameterError
            if none do. None: it has no such outputs.
        hosting: what it asks of its native FMU besides; None: nothing.
        by_tolerance: how inner steps follow a tolerance; None: they do not.
        asked: how its native FMU makes outputs when it is asked for them; None: in each step.
        curve: degree of the polynomials of time that the outputs of a source are between
            breakpoints, at most 2; None: they are not, or it is no source.
        laws: its scalar laws, apart from the linear rest; None: the component is linear, or what it
            has is not of that form.
        beyond: where it leaves what its data were made for; None: nowhere.
        folder: where script, README and golden result lie, and `resources`; that of its name if
            not given.
    """

    declaration: Declaration
    kernels: Kernels
    equations: str
    load: Callable[[np.ndarray, Mapping[str, Path]], None] = _no_resources
    verify: Callable[[np.ndarray, Mapping[str, Path]], None] = _no_resources
    start: Callable[[np.ndarray], None] = unchanged
    guess: Callable[[np.ndarray], None] = unchanged
    motion: Callable[[np.ndarray], None] | None = None
    breakpoints: Callable[[np.ndarray], tuple[float, ...]] = _no_breakpoints
    indicators: Callable[[np.ndarray, float, np.ndarray], None] | None = None
    indicator_count: int = 0
    nominals: Callable[[np.ndarray], np.ndarray] | None = None
    samples: bool = False
    longest_step: Callable[[np.ndarray], float] = unbounded
    freeze: Freeze | None = None
    of_pair: OfPair | None = None
    commanded: Commanded | None = None
    hosting: Hosting | None = None
    by_tolerance: ByTolerance | None = None
    asked: Asked | None = None
    curve: int | None = None
    laws: "Laws | None" = None
    beyond: Beyond | None = None
    folder: Path = field(default=Path())

    def __post_init__(self) -> None:
        """Take the folder of the own name if none is given."""
        if self.folder == Path():
            object.__setattr__(self, "folder", component_folder(self.name))

    @property
    def resources(self) -> Path:
        """Folder in which relative resource names are looked up."""
        return self.folder / "resources"

    @property
    def name(self) -> str:
        """FMI model identifier."""
        return self.declaration.name
