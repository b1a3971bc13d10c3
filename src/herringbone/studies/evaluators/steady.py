"""Points by periodic steady states: each from its neighbour, without any run."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from herringbone.analysis.set_points import SPEED, TORQUE, set_point
from herringbone.analysis.steady.set_points import Point as SteadyPoint
from herringbone.analysis.steady.solver import TOLERANCE, SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.running.loading import load_scene, load_system
from herringbone.running.steady import prepared_solver
from herringbone.studies.evaluators.evaluator import Base, Evaluated, Evaluation, Figure
from herringbone.studies.evaluators.levels import (
    order_figures,
    prefixed,
)
from herringbone.studies.evaluators.transient import with_known_values
from herringbone.studies.set_points import commanded
from herringbone.studies.study import Point

STEADY, UNSETTLED = "steady", "not_converged"
"""Outcomes of a point."""


@dataclass(frozen=True)
class Steady:
    """Steady states by harmonic balance.

    Attributes:
        tolerance: error of the alternating part of each group of channels.
        columns: further columns or patterns with figures of their own.
    """

    tolerance: float = TOLERANCE
    columns: tuple[str, ...] = ()
    longest: int | None = None
    modules: tuple[str, ...] = ("herringbone.studies.evaluators.steady",)
    has_series: bool = False

    def opened(self, base: Base) -> Evaluation:
        """Load system and scene; raises HerringboneError."""
        return _States(self, base)


class _Near(NamedTuple):
    """A state, what solved for it, and the values with which that was prepared."""

    state: SteadyState
    solver: SteadySolver
    values: Point


class _States:
    """Steady states of one system and scene."""

    def __init__(self, asked: Steady, base: Base) -> None:
        self._asked, self._wishes = asked, base.wishes
        self._system, folder = load_system(base.system)
        self._scene = load_scene(folder, base.scene)
        self._known = with_known_values(self._system, self._scene, base.wishes)

    def __call__(self, point: Point, near: _Near | None, *, series: bool) -> Evaluated:
        """See `Evaluation`."""
        del series
        at, values = self._split(point)
        if near is None or not _renewable(near.values, values):
            solver, prepared = self._prepared(at, values), values
            state = None
        else:
            state, solver, prepared = near
        changed = {n: float(v) for n, v in values.items() if prepared[n] != v}
        found = solver.solve(SteadyPoint(**at, values=changed), state)
        if not found.converged:
            message = f"the error is {found.errors.worst:.2g}, {found.tolerance:g} was asked for"
            return Evaluated(UNSETTLED, message, self._figures(found))
        bends = found.bends
        message = f"laws bend within the period: {', '.join(bends)}" if bends else ""
        figures = self._figures(found)
        return Evaluated(STEADY, message, figures, _Near(found, solver, prepared))

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
        wishes = self._wishes
        solver, _, _ = prepared_solver(
            self._system,
            scene=self._scene,
            **at,
            values={**wishes.values, **values},
            gear=wishes.gear,
            housing=wishes.housing,
            tolerance=self._asked.tolerance,
        )
        return solver

    def _figures(self, state: SteadyState) -> dict[str, Figure]:
        meshes = state.meshes * state.frequency
        figures = {"mesh_frequency": Figure(meshes, "Hz")}
        chosen = state.chosen(*self._asked.columns) if self._asked.columns else []
        for name, columns in {**state.channels, **{name: [name] for name in chosen}}.items():
            unit = state.structure.core.unit(columns[0])
            amplitudes = state.amplitudes(name)
            figures |= prefixed(name, _moments(amplitudes), unit)
            size = np.sqrt(np.mean(np.square(np.abs(amplitudes[:, 1:])), axis=0))
            figures |= order_figures(name, state.mesh_orders[1:], size, unit)
        figures["error"] = Figure(state.errors.worst, "1")
        return figures


def _is_given(found: Any) -> bool:  # noqa: ANN401
    return found is not None and found.given


def _renewable(prepared: Point, values: Point) -> bool:
    """True if only numbers differ: files are read when a system is prepared."""
    return not any(isinstance(v, str) and prepared[n] != v for n, v in values.items())


def _moments(amplitudes: np.ndarray) -> dict[str, float]:
    """rms, mean and peak of columns from their harmonics (columns, harmonics), see `levels`."""
    means = amplitudes[:, 0].real
    squares = 0.5 * np.sum(np.square(np.abs(amplitudes[:, 1:])), axis=1)
    places = 4 * amplitudes.shape[1]
    off = amplitudes.copy()
    off[:, 0] = 0.0
    signals = np.fft.irfft(0.5 * places * off, places, axis=1)
    return {
        "rms": float(np.sqrt(np.mean(squares))),
        "mean": float(means[0]) if means.size == 1 else float(np.sqrt(np.mean(np.square(means)))),
        "peak": float(np.abs(signals).max()),
    }
