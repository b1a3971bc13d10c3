"""A motion that repeats: its outputs, harmonic by harmonic, wherever they come from."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.steady.outputs import Harmonics, level_of
from herringbone.core import ParameterError
from herringbone.core.facts import Facts
from herringbone.core.places.part_path import PartPath, find_columns
from herringbone.core.places.wrong_column import meant_columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class PeriodicMotion(Facts):
    """Outputs of a periodic motion.

    A column is an output, `instance.variable`; of its name any ending will do. Its signal is its
    mean plus the sum of Re(A_k exp(2 pi i k frequency t)), k = 1, 2, ...; angles grow besides.
    """

    @property
    @abstractmethod
    def system_name(self) -> str:
        """Of the system that moves."""

    @property
    @abstractmethod
    def converged(self) -> bool:
        """True if the motion was found, as exactly as was asked for."""

    @property
    def found(self) -> bool:
        """True if there is a motion, how exactly ever: else it has no figures."""
        return True

    @property
    @abstractmethod
    def error(self) -> float:
        """Of the worst group of channels, over its alternating part."""

    @property
    @abstractmethod
    def speed(self) -> float:
        """Mean speed of the first pinion [rad/s]; NaN: not known."""

    @property
    @abstractmethod
    def period(self) -> float:
        """Time after which the motion repeats [s]."""

    @property
    @abstractmethod
    def meshes(self) -> int:
        """Mesh periods of the first gear pair in the period; 0: not known."""

    @property
    @abstractmethod
    def turns(self) -> float:
        """Turns of the first pinion in the period; NaN: not known."""

    @property
    @abstractmethod
    def numbers(self) -> np.ndarray:
        """(harmonics,) k of all harmonics, ascending, from 0."""

    @property
    @abstractmethod
    def parts(self) -> tuple[PartPath, ...]:
        """Of the system."""

    @property
    @abstractmethod
    def columns(self) -> tuple[str, ...]:
        """All outputs."""

    @property
    @abstractmethod
    def channels(self) -> Mapping[str, Sequence[str]]:
        """Columns by group of channels."""

    @abstractmethod
    def unit(self, column: str) -> str:
        """Of a column."""

    @abstractmethod
    def harmonics(self, columns: Sequence[str]) -> Harmonics:
        """Coefficients of columns."""

    @property
    def frequency(self) -> float:
        """Of the first harmonic [Hz]."""
        return 1.0 / self.period

    @property
    def orders(self) -> np.ndarray:
        """Periods per turn of the first pinion, of all harmonics."""
        return self.numbers / self.turns

    @property
    def mesh_orders(self) -> np.ndarray:
        """Periods per mesh period, of all harmonics."""
        return self.numbers / (self.meshes or np.nan)

    @property
    def frequencies(self) -> np.ndarray:
        """Frequencies [Hz] of all harmonics."""
        return self.numbers * self.frequency

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
                or find_columns(self.parts, self.columns, [name])[name]
            )
            if not own:
                hint = meant_columns(name, self.columns, self.channels)
                raise ParameterError(f"no output matches '{name}'; {hint}")
            found.update(dict.fromkeys(own))
        return list(found)

    def amplitudes(self, *names: str) -> np.ndarray:
        """Complex amplitudes A_k (columns, harmonics) of chosen columns; A_0 is the mean."""
        found = self.harmonics(self.chosen(*names)).coefficients.copy()
        found[:, 1:] *= 2.0
        return found

    def signal(self, name: str, times: np.ndarray) -> np.ndarray:
        """Values (times,) of one column, or (times, columns) of several, at times [s]."""
        columns = self.chosen(name)
        found = self.harmonics(columns).at(
            np.asarray(times, dtype=float), 2.0 * np.pi / self.period
        )
        return found[:, 0] if len(columns) == 1 else found

    def level(self, name: str) -> float:
        """Root mean square of the alternating part, over time and the chosen columns."""
        return level_of(self.harmonics(self.chosen(name)).coefficients)

    def mean(self, name: str) -> float:
        """Mean over time of a column, or over several; of angles less what grows."""
        return float(self.harmonics(self.chosen(name)).coefficients[:, 0].real.mean())

    def table(self, *names: str) -> pd.DataFrame:
        """One row per chosen column (all without names) and harmonic.

        Columns: `output`, `unit`, `order` (of the first pinion), `mesh_order`, `frequency` [Hz],
        `amplitude`, `phase` [rad] of Re(amplitude exp(i (2 pi frequency t + phase))). The mean has
        order 0.
        """
        columns = self.chosen(*names) if names else list(self.columns)
        found, count = self.amplitudes(*columns), self.numbers.size
        return pd.DataFrame({
            "output": np.repeat(columns, count),
            "unit": np.repeat([self.unit(c) for c in columns], count),
            "order": np.tile(self.orders, len(columns)),
            "mesh_order": np.tile(self.mesh_orders, len(columns)),
            "frequency": np.tile(self.frequencies, len(columns)),
            "amplitude": np.abs(found).ravel(),
            "phase": np.angle(found).ravel(),
        })  # fmt: skip

    def plot(self) -> "Figure":
        """Signals over one period, orders, and multipliers where they are known."""
        from herringbone.plotting.studies.steady_state import (  # noqa: PLC0415 (matplotlib: lazy)
            steady_picture,
        )

        return steady_picture(self)

    def levels(self) -> dict[str, str]:
        """Levels of all groups, as short texts."""
        return {group: f"{self.level(group):.5g} rms" for group in self.channels}
