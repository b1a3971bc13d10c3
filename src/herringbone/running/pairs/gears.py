"""A gear pair put into a system: what follows from its file, in all parts that it touches.

What a scene, a system or the caller sets by name holds over the pair's file, with a line.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path

from herringbone.analysis.anatomy import anatomy
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError
from herringbone.core.declaring.anatomy import Anatomy
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.core.places.part_path import PartPath
from herringbone.core.wording import option
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.gears.accuracy.given import GivenDeviations
from herringbone.gears.files.read_job import read_mounted_job
from herringbone.gears.job import GearJob
from herringbone.gears.pair_values import pair_values
from herringbone.gears.table_cache import cached_deviations, cached_pair_law, cached_table

Gear = str | Path | GearJob
"""A gear file (TOML or REXS), or what it would give."""


def with_gears(
    system: System, gears: Mapping[str, Gear]
) -> tuple[System, dict[str, GearJob], tuple[str, ...]]:
    """The system with gear pairs in it, their jobs by part, and lines that the user should read.

    Args:
        system: with what is set by name, which holds.
        gears: file or job by path of the gear pair's part.

    Raises:
        ParameterError: a foreign part, or a pair that its component cannot be.
        ResourceError: a file cannot be read.
    """
    notes: list[str] = []
    jobs: dict[str, GearJob] = {}
    for name, gear in gears.items():
        what = option("gear", str(gear) if isinstance(gear, str | Path) else None)
        part = system.part(name).name
        if system.part(part).foreign:
            raise ParameterError(f"{what}: {part} is a foreign FMU; nothing of a pair can be set")
        job = gear if isinstance(gear, GearJob) else read_mounted_job(Path(gear))
        jobs[part] = job
        values, said = _values(system, part, job, what)
        system, kept = _fitted(system, values)
        notes += (*said, *kept)
    return system, jobs, tuple(notes)


def _fitted(system: System, values: Mapping[str, float | str]) -> tuple[System, list[str]]:
    """The system with values where nothing is set by name, and what is kept instead."""
    own = {f"{p.name}.{v}": value for p in system.parts for v, value in p.values.items()}
    kept = [path for path in values if path in own and own[path] != values[path]]
    lines = [f"{p} = {own[p]}: set by name, kept over the pair's {values[p]}" for p in kept]
    return system.with_values({p: v for p, v in values.items() if p not in own}), lines


def _values(
    system: System, gear: PartPath, job: GearJob, option: str
) -> tuple[dict[str, float | str], list[str]]:
    """What a pair gives to the parts that it touches, by `part.variable`; and lines."""
    known = anatomy(system)
    try:
        pair, assumed = pair_values(job)
    except ParameterError as error:
        raise ParameterError(f"{option}: {error}") from error
    notes = list(assumed)
    values: dict[str, float | str] = {}
    for part in _touched(system, known, gear):
        component = COMPONENTS.get(part.component or "")
        if component is None:
            notes.append(f"{part.name}: a foreign FMU, nothing of the pair is set in it")
        elif component.of_pair is not None:
            declared = component.declaration.parameters
            own = {v.name: float(part.values.get(v.name, v.start)) for v in declared}
            found = component.of_pair(pair, own)
            values |= {f"{part.name}.{variable}": value for variable, value in found.items()}
    if table := known.column(gear, Quantity.STIFFNESS_TABLE):
        values[table] = str(cached_table(job))
    if job.deviations is not None:
        values |= _deviating(known, gear, job, job.deviations)
        notes.append(f"{option}: {_described(job, job.deviations)}")
    pairs = known.with_role(Role.GEAR_PAIR)
    if len(pairs) > 1:
        notes += [
            f"{part}: its gear ratio is not set, as there are {len(pairs)} gear pairs"
            for part in known.with_role(Role.CONTROLLER)
            if known.column(part, Quantity.GEAR_RATIO)
        ]
    return values, notes


def _deviating(
    known: Anatomy, gear: PartPath, job: GearJob, deviations: GivenDeviations
) -> dict[str, float | str]:
    """Files of teeth that deviate, by `part.variable`."""
    found: dict[str, float | str] = {}
    if column := known.column(gear, Quantity.TOOTH_DEVIATIONS):
        found[column] = str(cached_deviations(job, deviations))
    if column := known.column(gear, Quantity.PAIR_LAW):
        found[column] = str(cached_pair_law(job))
    return found


def _described(job: GearJob, deviations: GivenDeviations) -> str:
    """What deviations are, and which flanks have none."""
    if deviations.of_coast_flanks(job.pair):
        return str(deviations)
    return (
        f"{deviations}; drive flanks only: at negative torque the teeth are perfect (columns "
        "coast_... of the files are of the coast flanks)"
    )


def _touched(system: System, known: Anatomy, gear: PartPath) -> Iterator[PartSpec]:
    """The pair's part, what carries it, and the controller if there is but one pair to control."""
    carriers = [part for part, _ in known.joined(gear, PortKind.JOURNAL)]
    alone = len(known.with_role(Role.GEAR_PAIR)) == 1
    controllers = known.with_role(Role.CONTROLLER) if alone else ()
    for name in dict.fromkeys([str(gear), *carriers, *controllers]):
        yield system.part(name)
