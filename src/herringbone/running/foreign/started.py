"""One FMU in trials of it alone: instances with start values set, and its step."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from herringbone.core import HerringboneError
from herringbone.core.part import STRUCTURE, Part
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.structure.system import Values
from herringbone.running.content import digest_of_file, values_of

_STEP = 1e-4
USUAL_STEPS = (1e-3, 1e-4, 1e-2, 1e-5, 5e-4, 2e-3, 5e-3, 2e-4, 0.1)
"""That are tried of parts that take steps of one length only [s]."""


def started(new: Callable[[], Part], values: Values) -> Callable[[], Part]:
    """Makes instances with start values set.

    Args:
        new: makes an instance.
        values: by variable, texts of arrays and of types that are no numbers.

    The function raises ParameterError where a value does not fit.
    """

    def make() -> Part:
        part = new()
        try:
            set_values(part, values)
        except HerringboneError:
            part.enter_initialization(0.0, 1.0)  # pythonfmu does not survive freeing what was not
            part.close()
            raise
        return part

    return make


def set_values(part: Part, values: Values) -> None:
    """Set start values; those first that decide how large arrays are; raises HerringboneError."""

    def later(name: str) -> bool:
        return name not in part.variables or part.variables[name].causality != STRUCTURE

    for name in sorted(values, key=later):
        part.set(name, values[name])


def started_content(fmu: Path, values: Values) -> tuple[str, ...]:
    """What trials of such instances depend on, see `Laboratory`."""
    return fmu.stem, "own units", digest_of_file(fmu), *values_of(values)


class DeclaredSteps(NamedTuple):
    """What an FMU declares of its communication steps.

    Attributes:
        proposed: for experiments [s]; None if it proposes none.
        inner: `fixedInternalStepSize` of FMI 3.0, of which steps are multiples [s]; None: not said.
        one_length: all must have one length.
    """

    proposed: float | None
    inner: float | None
    one_length: bool

    @property
    def first(self) -> float | None:
        """What is tried first [s]; None if nothing is declared."""
        return self.proposed or self.inner


def declared_steps(fmu: Path) -> DeclaredSteps:
    """Of a file; raises FmuError."""
    model = read_fmu(fmu)
    abilities, experiment = model.coSimulation, model.defaultExperiment
    proposed = experiment.stepSize if experiment else None
    inner = abilities.fixedInternalStepSize
    return DeclaredSteps(
        float(proposed) if proposed else None,
        float(inner) if inner else None,
        not abilities.canHandleVariableCommunicationStepSize,
    )


def own_step(fmu: Path) -> float:
    """The first one of an FMU's declared steps [s], or that of trials."""
    return declared_steps(fmu).first or _STEP
