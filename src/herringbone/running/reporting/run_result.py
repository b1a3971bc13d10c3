"""From a recording to a result: names, figures, errors against the twin."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.accuracy.error_budget import by_size, coupling_row, error_budget
from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.figures.misfits import misfits
from herringbone.analysis.figures.operating_point import has_figures
from herringbone.analysis.figures.settling import unsettled
from herringbone.analysis.figures.standstill import stands_still, what_to_set
from herringbone.analysis.twin.reference import reference
from herringbone.components.registry import COMPONENTS
from herringbone.core import Outcome, OutcomeKind, ResourceError
from herringbone.core.declaring.roles import Quantity
from herringbone.core.places.part_path import PartPath
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.cell.policy import Remark
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid
from herringbone.cosim.structure.system import System
from herringbone.result.result import TIME, Result
from herringbone.result.run_info import RunInfo
from herringbone.scenes import Scene


def make_result(
    system: System,
    scene: Scene,
    algorithm: Algorithm | str,
    fmu: str,
    recording: Recording,
    notes: Sequence[str],
    *,
    by_default: bool = False,
) -> Result:
    """What a recording and the ways it came about make together.

    Args:
        system: with its parts' values.
        scene: of the run.
        algorithm: of the run.
        fmu: kind of the parts' FMUs.
        recording: of the run.
        notes: lines that the user should read, besides those of the recording.
        by_default: see `RunInfo.tolerance_by_default`.
    """
    data = pd.DataFrame(
        np.column_stack([recording.time, recording.values]), columns=[TIME, *recording.names]
    )
    if recording.others:
        data = pd.concat([data, pd.DataFrame(dict(recording.others))], axis=1)
    parameters, known = _parameters(system), anatomy(system)
    info = RunInfo(
        system=system.name,
        scene=scene.name,
        model={p.name: p.component or str(p.fmu) for p in system.parts},
        t_end=scene.t_end,
        communication_step=recording.step,
        record_step=recording.record_step,
        micro_steps={
            part: parameters[name]
            for part in known.parts
            if recording.core is None
            and (name := known.column(part, Quantity.MICRO_STEP)) in parameters
        },
        algorithm=str(algorithm),
        fmu=fmu,
        macro_steps=recording.macro_steps,
        passes=recording.passes,
        rollbacks=recording.rollbacks,
        wall_s=recording.wall_seconds,
        notes=(*notes, *recording.notes),
        steps=recording.steps and recording.steps._asdict(),
        estimate=recording.estimate and recording.estimate._asdict(),
        tolerance_by_default=by_default,
        energy=recording.energy,
        slow=recording.slow,
        core=recording.core and recording.core._asdict(),
        parameters=parameters,
        resources=_resources(system),
        anatomy=known,
        sensors=system.sensors,
    )
    units = {TIME: "s", **_units(system, recording), **recording.other_units}
    return Result(data, units, recording.outcome, info, system.channels)


def start_of(
    system: System,
    scene: Scene,
    algorithm: Algorithm | str,
    fmu: str,
    grid: Grid,
    notes: Sequence[str],
    *,
    by_default: bool = False,
) -> Result:
    """All that is known of a result before there are rows: what is left of a run that is killed."""
    outcome = Outcome(OutcomeKind.INTERRUPTED, 0.0)
    nothing = Recording(
        np.empty(0), np.empty((0, 0)), (), (), outcome, grid.step, grid.every * grid.step, 0, {}, 0,
        0.0, 0.0, (),
    )  # fmt: skip
    return make_result(system, scene, algorithm, fmu, nothing, notes, by_default=by_default)


def judged(result: Result, system: System, bond_frequency: float | None) -> Result:
    """The result with its error budget, and lines on what in the run does not fit together.

    Nothing is weighed where nothing turns: no part of a bearing force alternates then.

    Args:
        result: of a run.
        system: of the run.
        bond_frequency: the highest of all bonds together [rad/s]; None if it is not known.
    """
    if not has_figures(result):
        return result
    if stands_still(result):
        notes = (*result.info.notes, what_to_set(system))
        return replace(result, info=replace(result.info, notes=notes))
    even = result.uniform()
    try:
        found, budget = misfits(even), error_budget(even, bond_frequency or 0.0)
    except ResourceError as error:  # no reason to lose a run that has ended
        found, budget = (f"no error budget: {error}",), ()
    if result.outcome.failed:  # how far it may be off, and whether it settles, is no question then
        budget = ()
    else:
        found = (*found, *unsettled(even))
    return replace(result.noted(*found), budget=budget)


def with_remarks(result: Result, remarks: Sequence[Remark]) -> Result:
    """The result with what cells found out about their FMUs, which may not survive their end."""
    if not remarks:
        return result
    notes = (*result.info.notes, *dict.fromkeys(map(str, remarks)))
    outcome = result.outcome
    crashed = [remark for remark in remarks if remark.crashed]
    if crashed and outcome.kind in {OutcomeKind.COMPLETED, OutcomeKind.ENDED}:
        outcome = Outcome(
            OutcomeKind.PART_LOST_AT_END, outcome.time, crashed[0].part, str(crashed[0])
        )
    return replace(result, outcome=outcome, info=replace(result.info, notes=notes))


def compared(result: Result, every: Result, system: System) -> Result:
    """The result with its errors against the twin at all communication points.

    Args:
        result: as it is shown.
        every: with all communication points.
        system: of the run.
    """
    found = twin_error(every, system)
    if found is None:
        return with_coupling_row(result)
    error, how = found
    return with_coupling_row(replace(result.noted(how), error=error))


def with_coupling_row(result: Result) -> Result:
    """The result whose budget, if it has one, tells the coupling's error that was found since."""
    coupling = coupling_row(result, 0.0)
    rows = [coupling if row.source == coupling.source else row for row in result.budget]
    return replace(result, budget=by_size(rows))


def _units(system: System, recording: Recording) -> dict[str, str]:
    """Units by column; a foreign part without is taken as SI, as the component that it replaces."""
    replaced = {
        f"{part.name}.{v.name}": v.unit
        for part in system.parts
        if part.foreign and part.stands_for in COMPONENTS
        for v in COMPONENTS[part.stands_for].declaration.variables
    }
    given = zip(recording.names, recording.units, strict=True)
    return {name: unit or replaced.get(name, "") for name, unit in given}


def _parameters(system: System) -> dict[str, float]:
    """Real parameters and inputs that nothing feeds, of known parts, by `instance.variable`."""
    fed = {system.split(path) for pair in system.connections for path in pair}
    found: dict[str, float] = {}
    for part in system.parts:
        declared = COMPONENTS[part.component].declaration if part.component else None
        if declared is None:
            continue
        parameters = (v for v in declared.parameters if v.name != "interface_degree")
        free = (v for v in declared.inputs if fed.isdisjoint(_ends(part.name, v.name)))
        for v in (*parameters, *free):
            found[f"{part.name}.{v.name}"] = float(part.values.get(v.name, v.start))
    return found


def _ends(part: PartPath, variable: str) -> list[tuple[PartPath, str]]:
    """What a connection may name to feed an input: it, or what is in front of one of its dots."""
    dots = (i for i, c in enumerate(variable) if c == ".")
    return [(part, variable), *((part, variable[:i]) for i in dots)]


def _resources(system: System) -> dict[str, str]:
    """Files that the known parts read, as given, by `instance.variable`."""
    return {
        f"{part.name}.{text.name}": str(part.values.get(text.name, text.start))
        for part in system.parts
        if part.component
        for text in COMPONENTS[part.component].declaration.texts
    }


def twin_error(result: Result, system: System) -> tuple[dict[str, float], str] | None:
    """Errors against the monolithic twin at the communication points that were reached.

    By channel group, and which twin it was; None without channels or macro steps.
    """
    groups = {name: result.channel(name) for name in system.channels}
    columns = [column for names in groups.values() for column in names]
    time = result.data[TIME].to_numpy()
    if time.size < 2 or not columns:
        return None
    exact, how = reference(system, time, groups)
    twin = pd.DataFrame(exact, columns=columns)
    uneven = time if result.info.steps else None
    return {
        name: relative_error(result.data[names].to_numpy(), twin[names].to_numpy(), uneven)
        for name, names in groups.items()
    }, how


def decimated(result: Result, record_step: float) -> Result:
    """Keep the records that the scene asks for; an adaptive run has no others."""
    if result.info.steps:
        return result
    every = make_grid(result.info.t_end, result.info.communication_step, record_step).every
    data = result.data.iloc[::every].reset_index(drop=True)
    info = replace(result.info, record_step=every * result.info.communication_step)
    return replace(result, data=data, info=info)
