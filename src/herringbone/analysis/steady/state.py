"""A periodic steady state: its figures, harmonic by harmonic."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import pandas as pd

from herringbone.analysis.steady.bending import bending_parts
from herringbone.analysis.steady.harmonic_balance.accuracy import Accuracy
from herringbone.analysis.steady.harmonic_balance.floquet import Multipliers, multipliers
from herringbone.analysis.steady.harmonic_balance.orbit import Motion, Orbit
from herringbone.analysis.steady.outputs import Harmonics, harmonics, level_of, states
from herringbone.analysis.steady.set_points import Point
from herringbone.analysis.steady.structure import Structure
from herringbone.analysis.twin.fused.core import endings_of
from herringbone.core import ParameterError
from herringbone.core.declaring.facts import Facts
from herringbone.core.names import matches_any
from herringbone.core.one_thread import one_blas_thread

_R_MIN = 30.0 / np.pi
_STEPS, _BENT_STEPS = 32, 256
"""Of a mesh period, at least, in which deviations are followed; where laws bend."""


@dataclass(frozen=True, repr=False, eq=False)
class SteadyState(Facts):
    """A periodic steady state of a system.

    A column is an output, `instance.variable`; of its name any ending will do. Its signal is its
    mean plus the sum of Re(A_k exp(2 pi i k frequency t)), k = 1, 2, ...; angles grow besides.

    Attributes:
        structure: the system, prepared.
        point: operating point that was asked for.
        motion: what is given of the motion there.
        orbit: the motion as it was solved for.
        errors: of harmonics left out, and of the last correction.
        tolerance: that was asked for.
        notes: lines that the user should read.
    """

    structure: Structure
    point: Point
    motion: Motion
    orbit: Orbit
    errors: Accuracy
    tolerance: float
    notes: tuple[str, ...] = ()

    def noted(self, notes: Sequence[str]) -> "SteadyState":
        """The same state with further notes."""
        return replace(self, notes=(*self.notes, *notes))

    @property
    def converged(self) -> bool:
        """True if the motion was found, with all harmonics that the tolerance needs."""
        return self.orbit.converged and self.errors.worst <= self.tolerance

    @property
    def period(self) -> float:
        """Time after which the motion repeats [s]."""
        return self.orbit.period

    @property
    def frequency(self) -> float:
        """Of the first harmonic [Hz]."""
        return 1.0 / self.period

    @property
    def meshes(self) -> int:
        """Mesh periods of the first gear pair in the period."""
        return round(self.motion.turn / self.structure.turn) * self.structure.meshes

    @property
    def speed(self) -> float:
        """Mean speed of the first pinion [rad/s]."""
        turned = 2.0 * np.pi * self._turns / self.period
        return float(np.copysign(turned, self.orbit.response.speed))

    @property
    def _turns(self) -> float:
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
    def bends(self) -> tuple[str, ...]:
        """Parts whose laws bend within the period, as teeth that separate do."""
        return bending_parts(self.structure, self.orbit)

    @cached_property
    def multipliers(self) -> Multipliers:
        """Floquet multipliers: what a small deviation is multiplied by in a period.

        Takes some ten milliseconds for each mesh of the period.
        """
        per_mesh = _BENT_STEPS if self.bends and self.structure.meshes == 1 else _STEPS
        steps = max(per_mesh, self.orbit.places // self.meshes // 2) * self.meshes
        with one_blas_thread():
            return multipliers(self.structure.problem, self.motion, self.orbit, steps)

    @property
    def stable(self) -> bool:
        """True if small deviations die out; else a run would not stay on the state."""
        return self.multipliers.largest < 1.0

    @property
    def orders(self) -> np.ndarray:
        """Periods per turn of the first pinion, of all harmonics."""
        return self.orbit.response.orders / self._turns

    @property
    def mesh_orders(self) -> np.ndarray:
        """Periods per mesh period, of all harmonics."""
        return self.orbit.response.orders / self.meshes

    @property
    def frequencies(self) -> np.ndarray:
        """Frequencies [Hz] of all harmonics."""
        return self.orbit.response.orders * self.frequency

    def chosen(self, *names: str) -> list[str]:
        """Columns by name, of groups of channels, and those that match a pattern (`*`, `?`).

        Raises:
            ParameterError: a name is none of these.
        """
        found: dict[str, None] = {}
        known = frozenset(self.columns)
        for name in names:
            whole = [name] if name in known else []  # patterns of many names take long
            own = (
                self.channels.get(name)
                or whole
                or [c for c in self.columns if matches_any(endings_of(c), [name])]
            )
            if not own:
                groups = ", ".join(self.channels)
                raise ParameterError(f"no output matches '{name}'; groups of channels: {groups}")
            found.update(dict.fromkeys(own))
        return list(found)

    def amplitudes(self, *names: str) -> np.ndarray:
        """Complex amplitudes A_k (columns, harmonics) of chosen columns; A_0 is the mean."""
        found = self._harmonics(self.chosen(*names)).coefficients.copy()
        found[:, 1:] *= 2.0
        return found

    def signal(self, name: str, times: np.ndarray) -> np.ndarray:
        """Values (times,) of one column, or (times, columns) of several, at times [s]."""
        columns = self.chosen(name)
        found = self._harmonics(columns).at(
            np.asarray(times, dtype=float), 2.0 * np.pi / self.period
        )
        return found[:, 0] if len(columns) == 1 else found

    def level(self, name: str) -> float:
        """Root mean square of the alternating part, over time and the chosen columns."""
        return level_of(self._harmonics(self.chosen(name)).coefficients)

    def mean(self, name: str) -> float:
        """Mean over time of a column, or over several; of angles less what grows."""
        return float(self._harmonics(self.chosen(name)).coefficients[:, 0].real.mean())

    def table(self, *names: str) -> pd.DataFrame:
        """One row per chosen column (all without names) and harmonic.

        Columns: `output`, `unit`, `order` (of the first pinion), `mesh_order`, `frequency` [Hz],
        `amplitude`, `phase` [rad] of Re(amplitude exp(i (2 pi frequency t + phase))). The mean has
        order 0.
        """
        columns = self.chosen(*names) if names else list(self.columns)
        found, count = self.amplitudes(*columns), self.orders.size
        return pd.DataFrame({
            "output": np.repeat(columns, count),
            "unit": np.repeat([self.structure.core.unit(c) for c in columns], count),
            "order": np.tile(self.orders, len(columns)),
            "mesh_order": np.tile(self.mesh_orders, len(columns)),
            "frequency": np.tile(self.frequencies, len(columns)),
            "amplitude": np.abs(found).ravel(),
            "phase": np.angle(found).ravel(),
        })  # fmt: skip

    @cached_property
    def states(self) -> np.ndarray:
        """All states (n,) of the system at the start of the period, for a run from there."""
        return states(self.structure, self.orbit)[:, 0]

    def _harmonics(self, columns: Sequence[str]) -> Harmonics:
        return harmonics(self.structure, self.orbit, columns)

    def _facts(self) -> dict[str, str]:
        groups = {g: f"{self.level(g):.5g} rms" for g in self.channels}
        return {
            "system": self.structure.system.name,
            "speed": f"{self.speed * _R_MIN:.6g} r/min",
            "period": f"{self.period:.6g} s, {self.meshes} meshes",
            "outcome": "steady" if self.converged else "not converged",
            "bends": ", ".join(self.bends),
            "error": f"{self.errors.worst:.2g} (asked {self.tolerance:g})",
            **groups,
        }
