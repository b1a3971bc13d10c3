"""Periodic steady states of systems, by name."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.steady.set_points import Point, SetPoints
from herringbone.analysis.steady.solver import TOLERANCE, SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.cosim.structure.system import System
from herringbone.running.lean import certified, lean_error, lean_notes, lean_of
from herringbone.running.loading import load_system
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Prepared, Wishes, prepared
from herringbone.scenes import Scene, Start


def steady(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    tolerance: float = TOLERANCE,
    near: SteadyState | None = None,
) -> SteadyState:
    """The periodic steady state of a system at an operating point, by harmonic balance.

    Set points that change with time are taken as they are in the end.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file; gives values, as in `run`.
        speed: of the pinion [rad/s], where the system declares a set point of it, or nothing is
            joined to its gear pair; the scene's if not given.
        torque: at the pinion [N m], likewise.
        values, gear, housing: see `herringbone.run`.
        tolerance: error of the alternating part of each group of channels, harmonics left out
            included.
        near: a state nearby, to begin from; it decides on the branch where there are several.

    Returns:
        A state; ask it whether it is `converged`.

    Raises:
        HerringboneError: something about the input is wrong, or the motion does not repeat.
    """
    point = Point(speed, torque)
    found = prepared_at(point, system, scene, values=values, gear=gear, housing=housing)
    model, changed = found.scene.model, values or {}
    solver = SteadySolver(found.system, tolerance, lean=lean_of(found.scene))
    state = solver.solve(point, near)
    notes = (*found.notes, *lean_notes(model, changed, speed, torque))
    if model and state.converged and not certified(model, changed, speed, torque):
        whole = SteadySolver(found.system, tolerance).solve(point, near)
        if whole.converged:
            notes = (*notes, lean_error(state, whole))
    return state.noted(notes)


def prepared_solver(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    tolerance: float = TOLERANCE,
) -> tuple[SteadySolver, Point, tuple[str, ...]]:
    """What solves for steady states, the operating point asked for, and notes; see `steady`."""
    point = Point(speed, torque)
    found = prepared_at(point, system, scene, values=values, gear=gear, housing=housing)
    solver = SteadySolver(found.system, tolerance, lean=lean_of(found.scene))
    said = lean_notes(found.scene.model, values or {}, speed, torque)
    return solver, point, (*found.notes, *said)


def prepared_at(
    point: Point,
    system: str | Path | System,
    scene: str | Path | Scene | None = None,
    *,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
) -> Prepared:
    """A system in the equilibrium of an operating point; see `steady`.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    point.check()
    wishes = Wishes(
        values=values or {},
        gear=gear,
        housing=housing,
        start=Start.REST,
        start_offset={},
        lean=True,
    )
    structure = system if isinstance(system, System) else load_system(system)[0]
    if point.torque is not None and gear:  # what balances it at the wheel follows from the pair
        structure = prepared(system, scene, wishes).system
    wanted = {**SetPoints(structure).values(point), **(values or {})}
    return prepared(system, scene, replace(wishes, values=wanted, start=Start.EQUILIBRIUM))
