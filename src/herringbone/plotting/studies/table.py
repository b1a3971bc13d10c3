"""What the pictures of studies read of a table, and how they show what is not there.

A table has a row per point. Columns: parameters (`speed` [r/min], `torque` [N.m],
`instance.variable`), `outcome`, `mesh_frequency` [Hz], and per group or output G the figures
`G.rms`, `G.mean`, `G.peak`, `G.order_1`, `G.order_2`, ... (amplitudes of mesh orders), and
`radiated_power` of the housing [dB], `radiated_power.PART` of several; NaN where a point has none.
Units stand beside it, by column.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from herringbone.analysis.figures.radiated_power import RADIATED
from herringbone.analysis.set_points import SPEED, TORQUE
from herringbone.core import ParameterError
from herringbone.core.wording import several_values
from herringbone.plotting.style import scaled_unit

OUTCOME, MESH = "outcome", "mesh_frequency"
LABELS = {SPEED: "pinion speed", TORQUE: "pinion torque"}
_SHOWN_UNITS = {"N.m": "N m", "": "1", "rpm": "r/min"}
_NOT_VARIED = {"point", OUTCOME, "message", MESH}
_MOST_LINES = 12


@dataclass(frozen=True)
class Points:
    """A table with its units.

    Attributes:
        table: see above.
        units: by column.
        title: of its pictures.
    """

    table: pd.DataFrame
    units: Mapping[str, str]
    title: str = ""

    @cached_property
    def groups(self) -> tuple[str, ...]:
        """Groups and outputs that have an rms."""
        return tuple(c.removesuffix(".rms") for c in self.table.columns if c.endswith(".rms"))

    @cached_property
    def powers(self) -> tuple[str, ...]:
        """Columns of radiated sound power, a level in dB."""
        names = (RADIATED, f"{RADIATED}.")
        return tuple(c for c in self.table.columns if c == names[0] or c.startswith(names[1]))

    def called(self, group: str) -> str:
        """A group in words; an output by its name as it is."""
        if group in self.powers:
            return group.replace("_", " ", RADIATED.count("_")).replace(".", " of ", 1)
        return group if "." in group else group.replace("_", " ")

    @cached_property
    def parameters(self) -> tuple[str, ...]:
        """Parameters of which the points have several values."""
        figures = tuple(f"{group}." for group in self.groups)
        before = list(self.table.columns)
        before = before[: before.index(OUTCOME)] if OUTCOME in before else before
        return tuple(
            c
            for c in before
            if c not in _NOT_VARIED
            and not c.startswith(figures)
            and self.table[c].nunique(dropna=False) > 1
        )

    @property
    def numbers(self) -> tuple[str, ...]:
        """Parameters that are numbers."""
        return tuple(c for c in self.parameters if pd.api.types.is_numeric_dtype(self.table[c]))

    def across(self, wanted: str | None = None) -> str:
        """The parameter along the abscissa: the one that is wanted, speed, or the first number.

        Raises:
            ParameterError: there is none.
        """
        choice = [wanted] if wanted else [c for c in (SPEED, *self.numbers) if c in self.numbers]
        if not choice or choice[0] not in self.numbers:
            known = ", ".join(self.numbers)
            count = len(self.table)
            if not known:
                raise ParameterError(
                    f"{count} point{'s' * (count != 1)} and no number that is varied: there is no "
                    f"curve; give several values, such as {several_values('speed')}"
                )
            raise ParameterError(
                f"parameter {wanted}: it has not several numbers; there are: {known}"
            )
        return choice[0]

    def orders(self, group: str) -> tuple[int, ...]:
        """Mesh orders of a group that have columns."""
        pattern = re.compile(re.escape(group) + r"\.order_(\d+)$")
        return tuple(int(m[1]) for c in self.table.columns if (m := pattern.match(c)))

    def label(self, column: str) -> str:
        """Name and unit for an axis."""
        unit = self.units.get(column, "")
        return f"{LABELS.get(column, column)} [{_SHOWN_UNITS.get(unit, unit)}]"

    def scaled_label(self, column: str) -> str:
        """Name, and the unit that reads well, for an axis."""
        return f"{LABELS.get(column, column)} [{self.scale(column)[1]}]"

    def scale(self, column: str) -> tuple[float, str]:
        """Factor and unit that read well for a figure."""
        values = self.table[column].to_numpy(float)
        peak = float(np.nanmax(np.abs(values), initial=0.0)) if values.size else 0.0
        return scaled_unit(self.units.get(column, ""), peak)

    def headline(self, what: str) -> str:
        """Title of a picture: what it shows, and of what, if that is known."""
        return f"{what}: {self.title}" if self.title else what

    def curves(self, across: str) -> list[tuple[str, pd.DataFrame]]:
        """Points by curve: one per combination of the other parameters, along the abscissa.

        Returns:
            Label and rows of each; more than a dozen are thinned, which the labels do not hide:
            see `thinned`.
        """
        others = [c for c in self.parameters if c != across]
        if not others:
            return [("", self.table.sort_values(across))]
        found = []
        for values, rows in self.table.groupby(others, sort=True, dropna=False):
            key = values if isinstance(values, tuple) else (values,)
            told = [
                f"{self._short_name(c)} {self._told(c, v)}"
                for c, v in zip(others, key, strict=True)
            ]
            found.append((", ".join(told), rows.sort_values(across)))
        return found

    def _short_name(self, parameter: str) -> str:
        """The shortest ending of a parameter's name that no other parameter has."""
        words = parameter.split(".")
        endings = [".".join(words[k:]) for k in range(len(words))]
        return next(
            ending
            for ending in reversed(endings)
            if [c for c in self.parameters if f".{c}".endswith(f".{ending}")] == [parameter]
        )

    def _told(self, column: str, value: object) -> str:
        """A value of a parameter in the unit in which all its values read well."""
        if column not in self.numbers or not isinstance(value, float | int | np.number):
            return _short(value)
        factor, unit = self.scale(column)
        return f"{factor * float(value):g} {'' if unit == '1' else unit}".rstrip()

    def told_largest(self, *shown: str) -> str:
        """For titles of pictures that show the largest of points alike in the columns shown."""
        several = (self.table.groupby(list(shown), dropna=False).size() > 1).any()
        return ", largest of the further parameters" if several else ""

    @property
    def lost(self) -> pd.DataFrame:
        """Points without figures."""
        if not self.groups:
            return self.table
        return self.table[self.table[[f"{g}.rms" for g in self.groups]].isna().all(axis=1)]

    @property
    def told_lost(self) -> str:
        """What a title says of points without figures; "" if there are none."""
        count = len(self.lost)
        if not count:
            return ""
        kinds = self.lost[OUTCOME].value_counts() if OUTCOME in self.table else {}
        told = ", ".join(f"{n} {kind}" for kind, n in dict(kinds).items())
        return f"; {count} of {len(self.table)} points have no figures" + (
            f" ({told})" if told else ""
        )


def thinned(curves: Sequence[tuple[str, pd.DataFrame]]) -> list[tuple[str, pd.DataFrame]]:
    """At most a dozen curves, spread over all."""
    if len(curves) <= _MOST_LINES:
        return list(curves)
    picked = np.unique(np.linspace(0, len(curves) - 1, _MOST_LINES).round().astype(int))
    return [curves[i] for i in picked]


def _short(value: object) -> str:
    return f"{value:g}" if isinstance(value, float | int | np.floating) else str(value)


def checked_groups(points: Points, groups: Sequence[str]) -> Sequence[str]:
    """The groups whose levels are to be shown; all of the table if none are named.

    Raises:
        ParameterError: the table has no levels of a group, or none at all.
    """
    if wrong := [g for g in groups if g not in points.groups]:
        known = ", ".join(points.groups) or "none"
        raise ParameterError(f"the table has no level of '{wrong[0]}'; there are: {known}")
    if not points.groups:
        raise ParameterError("the table has no levels: there is no column that ends in .rms")
    return groups or points.groups
