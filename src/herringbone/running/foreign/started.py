"""One FMU in trials of it alone: instances with start values set, and its step."""

from collections.abc import Callable
from pathlib import Path

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


def own_step(fmu: Path) -> float:
    """Step that an FMU proposes for experiments [s], or its inner one, or that of trials."""
    return proposed_step(fmu) or inner_step(fmu) or _STEP


def proposed_step(fmu: Path) -> float | None:
    """Step that an FMU proposes for experiments [s]; None if it proposes none."""
    experiment = read_fmu(fmu).defaultExperiment
    return float(experiment.stepSize) if experiment and experiment.stepSize else None


def inner_step(fmu: Path) -> float | None:
    """`fixedInternalStepSize` of FMI 3.0, of which communication steps are multiples [s]."""
    declared = read_fmu(fmu).coSimulation.fixedInternalStepSize
    return float(declared) if declared else None


def takes_one_step(fmu: Path) -> bool:
    """True if an FMU declares that its steps must all have one length."""
    return not read_fmu(fmu).coSimulation.canHandleVariableCommunicationStepSize
