"""Check any FMI 2.0 or 3.0 co-simulation FMU: file, XML, runs, state, reset, reference results."""

import math
from pathlib import Path

from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelDescription

from herringbone.core import FmuError
from herringbone.cosim.fmu.file import read_fmu, require_file
from herringbone.cosim.fmu.opening import applied
from herringbone.cosim.fmu.variables import read_variables
from herringbone.fmi.host import Host, Host3, open_host
from herringbone.fmi.reference import replay
from herringbone.fmi.validation import validation_problems

_STEPS = 10
_STEP_SIZE = 1e-3


def check_fmu(path: str | Path) -> list[str]:
    """Check an FMU; it is executed, so check only what you would also run.

    Args:
        path: the FMU.

    Returns:
        Problems, one line each; empty if none was found.

    Raises:
        FmuError: there is no such file.
    """
    path = Path(path)
    require_file(path)
    try:
        read_fmu(path)
    except FmuError as error:
        return [str(error)]
    problems = validation_problems(path)
    try:
        return problems + applied(path, trials)
    except FmuError as error:
        return [*problems, f"{path}: {error}"]


def trials(path: Path) -> list[str]:
    """Problems that an FMU shows when it is stepped, here."""
    description, problems = read_fmu(path), []
    for check in (_default_run, _state_round_trip, _reset, _reference_results):
        try:
            problems += check(path, description)
        except (FmuError, FMICallException) as error:
            problems.append(f"{path}: {check.__name__.strip('_').replace('_', ' ')}: {error}")
    return problems


def without_unit(path: str | Path) -> list[str]:
    """Reals without unit, which FMI allows, one line each; event indicators and time need none.

    Args:
        path: the FMU.

    Raises:
        FmuError: the file cannot be read.
    """
    description = read_fmu(Path(path))
    indicators = {unknown.variable.name for unknown in description.eventIndicators}
    return [
        f"{v.name}: a {v.type} without unit"
        for v in description.modelVariables
        if v.type in {"Real", "Float32", "Float64"}
        and v.name not in indicators
        and v.causality != "independent"
        and not (v.unit or (v.declaredType and v.declaredType.unit))
    ]


def _step_size(description: ModelDescription) -> float:
    experiment = description.defaultExperiment
    return float(experiment.stepSize) if experiment and experiment.stepSize else _STEP_SIZE


def _end(description: ModelDescription) -> float:
    """Time up to which an FMU is stepped here at the most [s]."""
    return max(1.0, 2 * _STEPS * _step_size(description))


def _outputs(description: ModelDescription) -> list[str]:
    variables = read_variables(description).values()
    return [v.name for v in variables if v.causality == "output" and v.is_real]


def _advance(host: Host | Host3, first: int) -> list[float]:
    h = _step_size(host.model)
    for n in range(first, first + _STEPS):
        host.step(n * h, h)
    return host.values(*_outputs(host.model))


def _default_run(path: Path, description: ModelDescription) -> list[str]:
    with open_host(path.stem, path) as host:
        host.initialise(stop_time=_end(description))
        values = _advance(host, 0)
    names = _outputs(description)
    bad = [f"{n} = {v}" for n, v in zip(names, values, strict=True) if not math.isfinite(v)]
    return [f"default run: {text} after {_STEPS} steps" for text in bad]


def _state_round_trip(path: Path, description: ModelDescription) -> list[str]:
    if not description.coSimulation.canGetAndSetFMUstate:
        return []
    with open_host(path.stem, path) as host:
        host.initialise(stop_time=_end(description))
        _advance(host, 0)
        saved = host.save()
        before = _advance(host, _STEPS)
        if description.coSimulation.canSerializeFMUstate:
            saved = host.through_bytes(saved)
        host.restore(saved)
        after = _advance(host, _STEPS)
    return _differences(description, before, after, "a step repeated from the saved state")


def _reset(path: Path, description: ModelDescription) -> list[str]:
    with open_host(path.stem, path) as host:
        host.initialise(stop_time=_end(description))
        before = _advance(host, 0)
        host.slave.reset()
        host.initialise(stop_time=_end(description))
        after = _advance(host, 0)
    return _differences(description, before, after, "a run after reset")


def _reference_results(path: Path, description: ModelDescription) -> list[str]:
    del description
    return replay(path)


def _differences(
    description: ModelDescription, before: list[float], after: list[float], what: str
) -> list[str]:
    names = _outputs(description)
    return [
        f"{what} gives {name} = {second:.17g} instead of {first:.17g}"
        for name, first, second in zip(names, before, after, strict=True)
        if first != second
    ]
