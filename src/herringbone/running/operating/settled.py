"""Systems with foreign parts: runs, longer and longer ones, until nothing changes any more."""

from dataclasses import replace
from pathlib import Path

from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.operating_point import Point
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System
from herringbone.running.api import run
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import commanded, with_known_values
from herringbone.running.prepared import Wishes
from herringbone.scenes import Scene

LONGEST = 10.0
"""Run that is tried at most, if not asked for otherwise [s]."""
_FIRST, _LONGER = 0.2, 2.0
"""The first run [s], and how many times longer each next one is."""


def settled(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    point: Point,
    wishes: Wishes,
    tolerance: float,
    longest: float = LONGEST,
    algorithm: str | Algorithm | None = None,
    step: float | None = None,
) -> SettledState:
    """What a system settles to in a run; it is begun anew and is twice as long until it does.

    Where outputs do not repeat with the mesh, it is also long enough for the same teeth to meet
    three times in the last quarter, if `longest` allows it.

    Args:
        system, scene: see `herringbone.run`.
        point: operating point.
        wishes: over the scene, but for the duration.
        tolerance: change of levels and means that counts as none, see `SettledState`.
        longest: duration that is tried at most [s].
        algorithm, step: of the coupling, see `herringbone.run`; nothing said is no tolerance here:
            with foreign parts it is none by default.

    Returns:
        A state; ask it whether it is `converged`.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    structure, folder = system_and_folder(system)
    own = load_scene(folder, scene)
    asked = {SPEED: point.speed, TORQUE: point.torque}
    given = {name: value for name, value in asked.items() if value is not None}
    wishes = replace(wishes, values={**wishes.values, **point.values})
    values = commanded(with_known_values(structure, own, wishes), given)
    duration = min(_FIRST, longest)
    while True:
        result = run(
            system,
            scene=own,
            algorithm=algorithm,
            step=step,
            t_end=duration,
            record_step=wishes.record_step,
            start=wishes.start,
            replace_parts=wishes.replace_parts,
            values={**wishes.values, **values},
            gear=wishes.gear,
            housing=wishes.housing,
        )
        found = SettledState(result, tolerance)
        if not result.outcome.completed or duration >= longest:
            return found
        if found.converged:
            if not duration < found.ending.longer <= longest:
                return found
            duration = found.ending.longer
        else:
            duration = min(_LONGER * duration, longest)
