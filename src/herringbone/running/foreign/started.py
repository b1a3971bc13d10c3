"""One FMU in trials of it alone: instances with start values set, and its step."""

from collections.abc import Callable, Mapping
from pathlib import Path

from herringbone.core import HerringboneError, ParameterError
from herringbone.core.part import Part
from herringbone.cosim.fmu.file import read_fmu
from herringbone.running.content import digest_of_file, values_of

_STEP = 1e-4


def started(new: Callable[[], Part], values: Mapping[str, str]) -> Callable[[], Part]:
    """Makes instances with start values set.

    Args:
        new: makes an instance.
        values: texts by variable.

    The function raises ParameterError where a value does not fit.
    """

    def make() -> Part:
        part = new()
        try:
            for name, text in values.items():
                number = part.variables[name].is_real if name in part.variables else False
                part.set(name, float(text) if number else text)
        except (ValueError, HerringboneError) as error:
            part.enter_initialization(0.0, 1.0)  # pythonfmu does not survive freeing what was not
            part.close()
            if isinstance(error, ValueError):
                raise ParameterError(f"{name} = {text}: it must be a number") from error
            raise
        return part

    return make


def started_content(fmu: Path, values: Mapping[str, str]) -> tuple[str, ...]:
    """What trials of such instances depend on, see `Laboratory`."""
    return fmu.stem, "own units", digest_of_file(fmu), *values_of(values)


def own_step(fmu: Path) -> float:
    """Step that an FMU proposes for experiments [s], or that of trials."""
    experiment = read_fmu(fmu).defaultExperiment
    return float(experiment.stepSize) if experiment and experiment.stepSize else _STEP
