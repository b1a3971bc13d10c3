"""A system prepared for steady states: taken apart once, whatever operating points follow."""

from collections.abc import Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.steady.frozen import FrozenLaws, tangents_of
from herringbone.analysis.steady.harmonic_balance.problem import Problem
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.of_system import SystemLaws, problem_of, turns_of
from herringbone.analysis.steady.operating_point import SetPoints
from herringbone.analysis.twin.condensed.recorded.wanted import Wanted
from herringbone.analysis.twin.fused.core import Core
from herringbone.core import StructureError, common_period
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.core.lean import Lean
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.unfed import unfed

_MOST = 16
"""Selections of outputs that are kept."""
_CACHED = (
    "groups", "channels", "signals", "indicators", "start", "ideal", "ideal_start", "_kept",
)  # fmt: skip
"""What a structure has of its own."""


class Structure:
    """A system taken apart, with what harmonic balance needs.

    Args:
        system: its parts are all components of this package; with start values near steady
            rotation.
        like: of the same structure; what is the same is taken from it.
        same_tangents: see `Core`.
        lean: what the model leaves out; as `like` if not given.

    Attributes:
        core: the system, condensed.
        problem: linear part and laws.
        late: time [s] after which no set point changes.
        turn: angle of the reference shaft over a period [rad].
        bases: orders, in a period, of what turns and of the meshes.
        meshes: periods of the first gear pair's mesh in a period.
        points: what speed and torque stand for.

    Raises:
        StructureError: it cannot be taken apart, or its motion does not repeat.
    """

    @one_blas_thread()
    def __init__(
        self,
        system: System,
        like: "Structure | None" = None,
        *,
        same_tangents: bool = False,
        lean: Lean | None = None,
    ) -> None:
        self.system = system
        known = like.core if like else None
        self.core: Core = Core(system, known, same_tangents=same_tangents, lean=lean)
        condensed, twin = self.core.condensed, self.core.twin
        self.late = twin.settled
        try:
            self.problem: Problem = self._problem()
            every = turns_of(condensed, self.problem.of_angle)
        except StructureError as error:
            raise StructureError("; ".join((*unfed(system, twin.network), str(error)))) from None
        turns = common_period(every)
        self.bases = tuple(sorted({int(turns / each) for each in every}))
        self.turn = 2.0 * np.pi * float(turns)
        self.points = SetPoints(system)
        self.pinion = self._pinion()
        own = Wanted(condensed, self.core.affine, [self.pinion]).rows
        ratio = abs(float(own.turned[0, 0])) if own.turned.any() else 1.0
        self.turns_of_pinion = float(turns) * ratio
        self.meshes = round(self.turns_of_pinion * self._teeth())

    @one_blas_thread()
    def leaner(self, lean: Lean) -> "Structure":
        """The same of a leaner model, without taking the system apart again.

        Args:
            lean: what it leaves out besides what this one does.

        Raises:
            StructureError: it names what is not there.
        """
        found = copy(self)
        for name in _CACHED:
            found.__dict__.pop(name, None)
        found.core = self.core.leaner(lean)
        found.problem = found._problem()
        return found

    def _problem(self) -> Problem:
        """Linear part and laws, frozen where the model wants it."""
        condensed, lean = self.core.condensed, self.core.lean
        found = problem_of(condensed, self.late)
        if not lean.straight:
            return found
        chosen = tangents_of(condensed, lean.straight)
        straight = np.isin(chosen, tangents_of(condensed, lean.linear))
        return replace(found, laws=FrozenLaws(found, chosen, straight))

    def _pinion(self) -> str:
        """Column of the first pinion's angle."""
        known = anatomy(self.system)
        for pair in known.with_role(Role.GEAR_PAIR):
            for port in known.parts[pair].ports:
                if port.place == GEARS[0] and f"{pair}.{port.name}.phi" in self.core.names:
                    return f"{pair}.{port.name}.phi"
        raise StructureError(f"{self.system.name}: no gear pair in it tells its pinion's angle")

    def _teeth(self) -> float:
        known = anatomy(self.system)
        pair = known.with_role(Role.GEAR_PAIR)[0]
        column = known.column(pair, Quantity.NUMBER_OF_TEETH, GEARS[0])
        return float(self.core.twin.block[self.core.twin.index(str(column))])

    def wanted(self, columns: Sequence[str]) -> Wanted:
        """Rows of outputs; those of lately are kept: points over speed ask for the same."""
        key = tuple(columns)
        if key not in self._kept:
            if len(self._kept) >= _MOST:
                self._kept.clear()
            self._kept[key] = Wanted(self.core.condensed, self.core.affine, columns, settled=True)
        return self._kept[key]

    @cached_property
    def _kept(self) -> dict[tuple[str, ...], Wanted]:
        return {}

    @cached_property
    def groups(self) -> tuple[dict[str, slice], Rows]:
        """Where the affine columns of each group of channels lie in rows, and these rows."""
        found: dict[str, slice] = {}
        columns: list[str] = []
        for name, own in self.core.groups().items():
            affine = [own[k] for k in self.wanted(own).here]
            if affine:
                found[name] = slice(len(columns), len(columns) + len(affine))
                columns += affine
        return found, alternating_rows(self.wanted(columns))

    @cached_property
    def channels(self) -> tuple[str, ...]:
        """Columns that the rows of `groups` are of."""
        every = self.core.groups().values()
        return tuple(own[k] for own in every for k in self.wanted(own).here)

    @cached_property
    def signals(self) -> np.ndarray:
        """Its own signals of the sources (signals,), after the last change."""
        return self.core.condensed.signals(self.late)

    @cached_property
    def indicators(self) -> np.ndarray:
        """(laws + 1,) where the indicators of each part's laws begin."""
        return self.core.condensed.calls().indicator

    @cached_property
    def ideal(self) -> Problem:
        """The problem without what comes in over an angle, as deviations of teeth."""
        laws = SystemLaws(self.core.condensed, self.late, ideal=True)
        return replace(self.problem, laws=laws)

    @cached_property
    def start(self) -> np.ndarray:
        """Laws' values less mean tangents (values, 1) at the start values of the system."""
        return self._start(self.problem)

    @cached_property
    def ideal_start(self) -> np.ndarray:
        """The same of the laws of `ideal`."""
        return self._start(self.ideal)

    def _start(self, problem: Problem) -> np.ndarray:
        modes = self.core.condensed.modes
        channels = np.concatenate([np.zeros(problem.values), self.signals, [1.0]])
        z = (modes.arguments @ modes.start).real + modes.of_channels @ channels
        z += modes.of_angles @ modes.angles
        f = problem.laws(np.ascontiguousarray(z[None, :])).f[0]
        return (f - problem.tangent @ z)[:, None].astype(complex)


def alternating_rows(wanted: Wanted) -> Rows:
    """Rows of outputs over modes, angle and channels, without what stands still."""
    modal, turned, channels, _ = wanted.rows
    of_angle = turned[:, 0] if turned.shape[1] else np.zeros(len(turned))
    return Rows(modal, of_angle, channels)
