"""The meshing impact of gear pairs whose file asks for it, at the operating point of the start."""

from collections.abc import Mapping

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core.declaring.roles import GEARS, PortKind, Quantity
from herringbone.cosim.structure.system import System
from herringbone.gears.job import GearJob
from herringbone.gears.job_stiffness import stiffness_for
from herringbone.gears.load.impact import impact_at

_STANDS, _OPEN = 1e-6, 1e-6
"""Speed [rad/s] and force [N] below which there is no operating point."""


def with_impacts(system: System, jobs: Mapping[str, GearJob]) -> tuple[System, tuple[str, ...]]:
    """The system with the impact force of each pair that has a share of it, and lines.

    Args:
        system: with its start values.
        jobs: by path of the gear pair's part.

    Raises:
        ParameterError: see `impact_at`.
    """
    wanted = {part: job for part, job in jobs.items() if job.mesh.impact_share > 0.0}
    notes: list[str] = []
    known = anatomy(system)
    for part, job in wanted.items():
        column = known.column(part, Quantity.IMPACT_FORCE)
        if column is None or system.foreign_parts:
            notes.append(f"{part}: no impact is set: its operating point is not known here")
            continue
        if system.split(column)[1] in system.part(part).values:
            notes.append(f"{column}: set by name, kept over the impact of the pair")
            continue
        speed, load = _operating_point(system, part)
        if abs(speed) < _STANDS or abs(load) < _OPEN:
            notes.append(f"{part}: no impact is set: the start has no speed, or no load")
            continue
        driven = 1 if speed * load > 0.0 else 0
        impact = impact_at(job, stiffness_for(job), abs(speed), abs(load), driven)
        force = job.mesh.impact_share * impact.force
        system = system.with_values({column: force})
        notes.append(
            f"{column} = {force:.4g} N: {job.mesh.impact_share:g} of the largest at "
            f"{speed:.5g} rad/s and {load:.5g} N per half, as tips of the {GEARS[driven]} enter"
        )
    return system, tuple(notes)


def _operating_point(system: System, gear: str) -> tuple[float, float]:
    """Speed of the pinion [rad/s], and mean normal force of the halves [N], at the start.

    The force is negative where the coast flank carries.
    """
    known = anatomy(system)
    (flange,) = known.ports(gear, PortKind.FLANGE, GEARS[0])
    columns = [f"{gear}.{flange.name}.w", *known.columns(gear, Quantity.MESH_FORCE)]
    twin = Twin(system)
    speed, *forces = twin.observe(np.zeros(1), twin.state[:, None], columns)[0]
    return float(speed), float(np.mean(forces))
