"""A periodic steady state: its figures, harmonic by harmonic."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from herringbone.analysis.steady.bending import bending_parts
from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy
from herringbone.analysis.steady.harmonic_balance.floquet import Multipliers, multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.marching.shooting import Shot
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.outputs import Harmonics, harmonics, slips, states
from herringbone.analysis.steady.periodic import PeriodicMotion
from herringbone.analysis.steady.searching.found import Settled
from herringbone.analysis.steady.searching.guess import Guess, Neighbour
from herringbone.analysis.steady.searching.irregular import Irregular
from herringbone.analysis.steady.structure import Structure
from herringbone.core.declaring.units import R_MIN
from herringbone.core.places.part_path import PartPath
from herringbone.core.process.one_thread import one_blas_thread

BALANCE, SHOOTING, MARCH = "harmonic balance", "shooting", "march"
"""What may have found a state."""
_STEPS, _BENT_STEPS = 32, 256
"""Of a mesh period, at least, in which deviations are followed; where laws bend."""


@dataclass(frozen=True, repr=False, eq=False)
class SteadyState(PeriodicMotion):
    """A periodic steady state of a system; see `PeriodicMotion`.

    Attributes:
        structure: the system, prepared.
        point: operating point that was asked for.
        motion: what is given of the motion there.
        orbit: the motion as it was solved for.
        errors: of harmonics left out, and of the last correction.
        tolerance: that was asked for.
        notes: lines that the user should read.
        by: the march or the shot by which it was found, None: by harmonic balance; or what tells
            that there is none that could be found.
        before: the neighbour from which it was found.
    """

    structure: Structure
    point: Point
    motion: Motion
    orbit: Orbit
    errors: Accuracy
    tolerance: float
    notes: tuple[str, ...] = ()
    by: Settled | Shot | Irregular | None = None
    before: Neighbour | None = None

    def noted(self, notes: Sequence[str]) -> "SteadyState":
        """The same state with further notes."""
        return replace(self, notes=(*self.notes, *notes))

    @property
    def system_name(self) -> str:
        """Of the system."""
        return self.structure.system.name

    @property
    def parts(self) -> tuple[PartPath, ...]:
        """Of the system."""
        return self.structure.system.paths

    @property
    def converged(self) -> bool:
        """True if the motion was found, with all harmonics that the tolerance needs."""
        return self.orbit.converged and self.errors.worst <= self.tolerance

    @property
    def found(self) -> bool:
        """True if the iteration has come to a motion."""
        return self.orbit.converged

    @property
    def error(self) -> float:
        """What harmonics that are left out would add, of the worst group of channels."""
        return self.errors.worst

    @property
    def solver(self) -> str:
        """What has found it: `BALANCE`, `SHOOTING` or `MARCH`."""
        if self.by is None:
            return BALANCE
        return SHOOTING if isinstance(self.by, Shot) else MARCH

    @property
    def settled(self) -> Settled | None:
        """How the march has settled by which it was found; None: by no march."""
        return self.by if isinstance(self.by, Settled) else None

    @property
    def irregular(self) -> Irregular | None:
        """What a march tells that never repeats, with its levels; None: there is no such one."""
        return self.by if isinstance(self.by, Irregular) else None

    @property
    def shot(self) -> Shot | None:
        """The shot by which it was found; None: by none."""
        return self.by if isinstance(self.by, Shot) else None

    @property
    def worst_channel(self) -> tuple[str, float]:
        """The channel that errs most over its own alternating part, and by how much; "": none."""
        errors = self.errors.of_channels
        if not np.isfinite(errors).any():
            return "", math.nan
        worst = int(np.nanargmax(errors))
        return self.structure.channels[worst], float(errors[worst])

    @property
    def neighbour(self) -> Neighbour:
        """From which a point nearby begins."""
        orbit = self.orbit
        values = orbit.channels[: self.structure.problem.values]
        guess = Guess(values, orbit.response.orders, orbit.resolved.per_mesh)
        return Neighbour(guess, self.meshes, self.point, self.before)

    @property
    def period(self) -> float:
        """Time after which the motion repeats [s]."""
        return self.orbit.period

    @property
    def meshes(self) -> int:
        """Mesh periods of the first gear pair in the period."""
        return round(self.motion.turn / self.structure.turn) * self.structure.meshes

    @property
    def speed(self) -> float:
        """Mean speed of the first pinion [rad/s]."""
        turned = 2.0 * np.pi * self.turns / self.period
        return float(np.copysign(turned, self.orbit.response.speed))

    @property
    def turns(self) -> float:
        """Turns of the first pinion in the period."""
        return self.structure.turns_of_pinion * self.meshes / self.structure.meshes

    @property
    def drift(self) -> float:
        """What the speed changes by where nothing holds it [rad/s2]: torques that are left over."""
        return self.orbit.response.free_torque(self.orbit.channels)

    @property
    def columns(self) -> tuple[str, ...]:
        """All outputs."""
        return self.structure.core.names

    @property
    def channels(self) -> Mapping[str, Sequence[str]]:
        """Columns by group of channels."""
        return self.structure.core.groups()

    @cached_property
    def slips(self) -> dict[str, float]:
        """What turns at a speed of its own, by how much faster than with the rest [rad/s].

        As what may be overrun is, for all of the period or for parts of it.
        """
        return slips(self.structure, self.orbit)

    @cached_property
    def bends(self) -> tuple[str, ...]:
        """Parts whose laws bend within the period, as teeth that separate do."""
        return bending_parts(self.structure, self.orbit)

    @cached_property
    def multipliers(self) -> Multipliers:
        """Floquet multipliers: what a small deviation is multiplied by in a period.

        Takes some ten milliseconds for each mesh of the period.
        """
        if self.shot:
            return self.shot.multipliers
        per_mesh = _BENT_STEPS if self.bends and self.structure.meshes == 1 else _STEPS
        steps = max(per_mesh, self.orbit.resolved.per_mesh // 2) * self.meshes
        with one_blas_thread():
            return multipliers(self.structure.problem, self.motion, self.orbit, steps)

    @property
    def stable(self) -> bool:
        """True if small deviations die out, as they did in a march; a run would leave others."""
        return self.settled is not None or self.multipliers.largest < 1.0

    @property
    def numbers(self) -> np.ndarray:
        """(harmonics,) k of those that are in use."""
        return self.orbit.response.orders

    @cached_property
    def states(self) -> np.ndarray:
        """All states (n,) of the system at the start of the period, for a run from there."""
        return states(self.structure, self.orbit)[:, 0]

    def unit(self, column: str) -> str:
        """Of a column."""
        return self.structure.core.unit(column)

    def harmonics(self, columns: Sequence[str]) -> Harmonics:
        """Coefficients of columns."""
        return harmonics(self.structure, self.orbit, columns)

    def _facts(self) -> dict[str, str]:
        if not self.found:
            return {
                "system": self.system_name,
                "outcome": "not found",
                "why": "; ".join(self.notes),
            }
        return {
            "system": self.system_name,
            "speed": f"{self.speed * R_MIN:.6g} r/min",
            "period": f"{self.period:.6g} s, {self.meshes} meshes",
            "outcome": "steady" if self.converged else "not converged",
            "bends": ", ".join(self.bends),
            "error": f"{self.errors.worst:.2g} (asked {self.tolerance:g})",
            **self.levels(),
        }
