"""Points by periodic steady states: each from its neighbour, without any run."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from herringbone.analysis.figures.sensitivity import SENSITIVITY
from herringbone.analysis.set_points import SPEED, TORQUE, set_point
from herringbone.analysis.steady.of_runs.settled import SettledState
from herringbone.analysis.steady.operating_point import Point as SteadyPoint
from herringbone.analysis.steady.searching.guess import Guess, Neighbour
from herringbone.analysis.steady.searching.remarks import GROWS
from herringbone.analysis.steady.sensitivities.assumed import assumed
from herringbone.analysis.steady.sensitivities.changes import Changes
from herringbone.analysis.steady.sensitivities.sensitivity import sensitivities_of_groups
from herringbone.analysis.steady.solver import AUTO, SteadySolver
from herringbone.analysis.steady.state import BALANCE, SHOOTING, SteadyState
from herringbone.core import OutcomeKind, ParameterError
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.asked_tolerance import asked_tolerance
from herringbone.running.operating.commanded import commanded, with_known_values
from herringbone.running.operating.steady import prepared_solver
from herringbone.scenes import Scene
from herringbone.studies.evaluators.evaluator import Base, Evaluated, Evaluation, Figure
from herringbone.studies.evaluators.levels import (
    PERIOD,
    order_figures,
    prefixed,
    radiated_levels,
)
from herringbone.studies.study import Point

STEADY, UNSETTLED = "steady", "not_converged"
UNSTABLE = OutcomeKind.UNSTABLE.value
"""Outcomes of a point."""


@dataclass(frozen=True)
class Steady:
    """Steady states where all equations are known.

    Attributes:
        tolerance: error of the alternating part of each group of channels; None: as
            `herringbone.steady` chooses it.
        columns: further columns or patterns with figures of their own.
        sensitivities: of the levels of all groups, to parameters that match these patterns; to all
            dampings if there is none. None: they are not asked for.
        solver: see `herringbone.steady`.
    """

    tolerance: float | None = None
    columns: tuple[str, ...] = ()
    sensitivities: tuple[str, ...] | None = None
    solver: str = AUTO
    longest: int | None = None
    modules: tuple[str, ...] = ("herringbone.studies.evaluators.steady",)
    has_series: bool = False

    def as_fine_as_asked(self, scene: Scene) -> "Steady":
        """With the tolerance that is taken if none was given: rows are known by it."""
        given = self.tolerance
        return replace(self, tolerance=asked_tolerance(scene) if given is None else given)

    def opened(self, base: Base) -> Evaluation:
        """Load system and scene; raises HerringboneError."""
        return _States(self, base)


class _Near(NamedTuple):
    """What a state leaves its neighbour, what solved for it, and how that was prepared.

    Attributes:
        state: of the motion; None: of no point so far.
        solver: for points nearby.
        values: with which it was prepared.
        first: point for which it was prepared.
    """

    state: Neighbour | None
    solver: SteadySolver
    values: Point
    first: Point


class _States:
    """Steady states of one system and scene."""

    def __init__(self, asked: Steady, base: Base) -> None:
        self._asked, self._wishes = asked, base.wishes
        self._system, folder = system_and_folder(base.system)
        self._scene = load_scene(folder, base.scene)
        self._known = with_known_values(self._system, self._scene, base.wishes)
        self._changes = Changes()

    def __call__(self, point: Point, near: _Near | None, *, series: bool) -> Evaluated:
        """See `Evaluation`."""
        del series
        at, values = self._split(point)
        if near is None or not _renewable(near.values, values):
            near = self._begun(point)
        found = self._from(near, at, values)
        if not found.found and near.first != point:  # of another flank, or too far from its start
            near = self._begun(point)
            found = self._from(near, at, values)
        if not found.found:
            return Evaluated(UNSETTLED, "; ".join(found.notes))
        if not found.converged:
            error = f"the error is {found.errors.worst:.2g}, {found.tolerance:g} was asked for"
            message = "; ".join([error, *found.notes])
            return Evaluated(UNSETTLED, message, figures_of(found, self._asked.columns))
        return self._row(found, near._replace(state=found.neighbour))

    def _row(self, found: SteadyState, left: _Near) -> Evaluated:
        """Of a motion that has converged, with what it leaves its neighbour."""
        told = [*found.notes, *_told(found)]
        outcome = UNSTABLE if GROWS in found.notes else STEADY
        if outcome == UNSTABLE and self._asked.solver != SHOOTING:
            return Evaluated(outcome, "; ".join(told), state=left)  # no run has its figures
        figures = figures_of(found, self._asked.columns)
        if self._asked.sensitivities is not None:
            more, why = self._sensitivities(found, self._asked.sensitivities)
            figures |= more
            told += why
        return Evaluated(outcome, "; ".join(told), figures, left)

    def _from(self, near: _Near, at: dict[str, float], values: Point) -> SteadyState:
        changed = {n: float(v) for n, v in values.items() if near.values[n] != v}
        return near.solver.solve(SteadyPoint(**at, values=changed), near.state)

    def _begun(self, point: Point) -> _Near:
        at, values = self._split(point)
        return _Near(None, self._prepared(at, values), values, point)

    def kept(self, near: _Near) -> dict[str, np.ndarray]:
        """See `Resumable`."""
        assert near.state is not None
        arrays, told = {}, []
        for k, own in enumerate(n for n in (near.state, near.state.before) if n is not None):
            arrays[f"values.{k}"], arrays[f"orders.{k}"] = own.guess.values, own.guess.orders
            told.append([own.guess.per_mesh, own.meshes, own.point])
        return {**arrays, "told": np.array(json.dumps({"first": near.first, "states": told}))}

    def renewed(self, kept: Mapping[str, np.ndarray]) -> _Near:
        """See `Resumable`."""
        told, state = json.loads(str(kept["told"])), None
        for k, (per_mesh, meshes, at) in reversed(list(enumerate(told["states"]))):
            guess = Guess(kept[f"values.{k}"], kept[f"orders.{k}"], per_mesh)
            state = Neighbour(guess, meshes, SteadyPoint(*at), state)
        return self._begun(told["first"])._replace(state=state)

    def _sensitivities(
        self, state: SteadyState, patterns: tuple[str, ...]
    ) -> tuple[dict[str, Figure], list[str]]:
        """By group and parameter, and what is to be told of those that have none."""
        try:
            names = assumed(state.structure.system, patterns)
        except ParameterError as error:
            return {}, [str(error)]
        by_group, told = sensitivities_of_groups(state, names, self._changes)
        figures = {
            f"{group}{SENSITIVITY}{name}": Figure(found.relative, "1")
            for group, own in by_group.items()
            for name, found in own.items()
        }
        return figures, told

    def _split(self, point: Point) -> tuple[dict[str, float], Point]:
        """Speed and torque that the solver takes itself, and values of variables."""
        own = {
            name: float(point[name])
            for name in (SPEED, TORQUE)
            if name in point and not _is_given(set_point(self._known, name))
        }
        rest = {name: value for name, value in point.items() if name not in own}
        return own, commanded(self._known, rest)

    def _prepared(self, at: dict[str, float], values: Point) -> SteadySolver:
        wishes = replace(self._wishes, values={**self._wishes.values, **values})
        where = SteadyPoint(at.get(SPEED), at.get(TORQUE))
        asked = self._asked
        return prepared_solver(
            self._system, self._scene, where, wishes, asked.tolerance, asked.solver
        )[0]


def figures_of(state: SteadyState | SettledState, columns: Sequence[str]) -> dict[str, Figure]:
    """Figures of all groups of channels of a state, of further columns, and of radiated sound."""
    known = state.meshes > 0
    frequency = state.meshes * state.frequency if known else np.nan
    figures = {"mesh_frequency": Figure(frequency, "Hz")}
    chosen = state.chosen(*columns) if columns else []
    for name, own in {**state.channels, **{name: [name] for name in chosen}}.items():
        unit = state.unit(own[0])
        amplitudes = state.amplitudes(name)
        figures |= prefixed(name, _moments(amplitudes, state.numbers), unit)
        size = np.sqrt(np.mean(np.square(np.abs(amplitudes[:, 1:])), axis=0))
        orders = state.mesh_orders[1:]
        kept = slice(None) if known else slice(0)
        figures |= order_figures(name, orders[kept], size[kept], unit)
    figures |= radiated_levels(state)
    figures[PERIOD] = Figure(float(state.meshes) if known else np.nan, "1")
    figures["error"] = Figure(state.error, "1")
    return figures


def _told(found: SteadyState) -> list[str]:
    """What there is to say of a motion besides its notes."""
    bends = found.bends
    told = [f"laws bend within the period: {', '.join(bends)}"] if bends else []
    return told + ([f"found by {found.solver}"] if found.solver != BALANCE else [])


def _is_given(found: Any) -> bool:  # noqa: ANN401
    return found is not None and found.given


def _renewable(prepared: Point, values: Point) -> bool:
    """True if only numbers differ: files are read when a system is prepared."""
    return not any(isinstance(v, str) and prepared[n] != v for n, v in values.items())


def _moments(amplitudes: np.ndarray, numbers: np.ndarray) -> dict[str, float]:
    """rms, mean and peak of columns, see `levels`.

    Args:
        amplitudes: (columns, harmonics), complex; the first is the mean.
        numbers: (harmonics,) periods of each in the period, ascending from 0; where run-outs make
            the period long, most numbers are not among them.
    """
    means = amplitudes[:, 0].real
    squares = 0.5 * np.sum(np.square(np.abs(amplitudes[:, 1:])), axis=1)
    at = numbers[1:].astype(int)
    count = int(numbers[-1]) + 1
    places = 4 * count
    peak = 0.0
    for own in amplitudes:  # one by one: a period may have thousands of meshes
        off = np.zeros(count, complex)
        off[at] = 0.5 * places * own[1:]
        peak = max(peak, float(np.abs(np.fft.irfft(off, places)).max()))
    return {
        "rms": float(np.sqrt(np.mean(squares))),
        "mean": float(means[0]) if means.size == 1 else float(np.sqrt(np.mean(np.square(means)))),
        "peak": peak,
    }
