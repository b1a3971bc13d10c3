"""Steady states of systems, by name: by harmonic balance, or of a run where parts are foreign."""

from collections.abc import Mapping
from pathlib import Path

from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import AS_IT_IS, AUTO, TOLERANCE, SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.core import ParameterError
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import check_tolerance
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.asked_tolerance import asked_tolerance, tolerance_notes
from herringbone.running.operating.at_point import NOTHING, prepared_at
from herringbone.running.operating.by_hand import said_by_hand
from herringbone.running.operating.commanded import own_point, with_known_values
from herringbone.running.operating.lean import changed_by, lean_notes
from herringbone.running.operating.settled import LONGEST, settled
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Prepared, Wishes
from herringbone.scenes import Scene


def steady(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    replace_parts: Mapping[str, str | Path] | None = None,
    tolerance: float | None = None,
    near: SteadyState | None = None,
    longest: float = LONGEST,
    solver: str = AUTO,
) -> SteadyState | SettledState:
    """The steady state of a system at an operating point: by harmonic balance.

    With foreign parts, whose equations nobody knows, it is what a run settles to: the system is run
    until levels and means of all groups of channels change by less than the tolerance from the
    third to the last quarter, see `SettledState`.

    Set points that change with time are taken as they are in the end.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file; gives values, as in `run`.
        speed: of the pinion [rad/s], where the system declares a set point of it, or nothing is
            joined to its gear pair; the scene's if not given.
        torque: at the pinion [N m], likewise.
        values, gear, housing, replace_parts: see `herringbone.run`.
        tolerance: error of the alternating part of each group of channels, harmonics left out
            included; small channels beside large ones may err more; of a run see above. None:
            1e-3, or less if a scene that asks needs it.
        near: a state nearby, to begin from; it decides on the branch where there are several.
        longest: duration of a run that is tried at most [s].
        solver: "auto", the cheapest way that finds a motion, or "shooting"; see `docs/steady.md`.

    Returns:
        A state; ask it whether it is `converged`.

    Raises:
        HerringboneError: something about the input is wrong, or the motion does not repeat.
    """
    wishes = Wishes(
        values=values or {}, gear=gear, housing=housing, replace_parts=replace_parts or {}
    )
    point = Point(speed, torque)
    if is_foreign(system, scene, wishes):
        if solver != AUTO:
            raise ParameterError(f"solver = {solver}: foreign parts show no equations; drop it")
        point.check()
        least = TOLERANCE if tolerance is None else tolerance
        check_tolerance(least)
        return settled(system, scene, point, wishes, least, longest)
    found = prepared_at(point, system, scene, wishes)
    prepared, notes = _solver_of(found, point, wishes, tolerance, solver)
    state = prepared.solve(point, near)
    if state.converged:
        notes = (*notes, *said_by_hand(system, scene, wishes, point, state).notes)
    return state.noted(notes)


def is_foreign(
    system: str | Path | System, scene: str | Path | Scene | None, wishes: Wishes
) -> bool:
    """True if a part of a system is foreign, so that no equations of it are known."""
    structure, folder = system_and_folder(system)
    known = with_known_values(structure, load_scene(folder, scene), wishes)
    return bool(known.foreign_parts)


def prepared_solver(
    system: str | Path | System,
    scene: str | Path | Scene | None = None,
    point: Point = AS_IT_IS,
    wishes: Wishes = NOTHING,
    tolerance: float | None = TOLERANCE,
    solver: str = AUTO,
) -> tuple[SteadySolver, tuple[str, ...]]:
    """What solves for steady states near an operating point, and notes; see `steady`.

    A tolerance of None is what the scene asks for.
    """
    found = prepared_at(point, system, scene, wishes)
    return _solver_of(found, point, wishes, tolerance, solver)


def _solver_of(
    found: Prepared, point: Point, wishes: Wishes, tolerance: float | None, solver: str
) -> tuple[SteadySolver, tuple[str, ...]]:
    """With the model that the scene leaves, and what is to be said of it."""
    least = asked_tolerance(found.scene) if tolerance is None else tolerance
    prepared = SteadySolver(found.system, least, lean=found.scene.model.left_out, solver=solver)
    own = own_point(found.system) if found.scene.model else (None, None)
    said = lean_notes(found.scene.model, changed_by(wishes), point.speed, point.torque, own)
    return prepared, (*found.notes, *tolerance_notes(found.scene, tolerance), *said)
