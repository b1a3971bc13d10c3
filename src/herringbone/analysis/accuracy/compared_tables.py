"""The tables of a comparison of two runs, whose columns `Comparison` names."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.apart import Apart, differences
from herringbone.analysis.figures.operating_point import run_mesh_frequency, steady_part
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, amplitudes_at_multiples
from herringbone.result.result import TIME, Result

ORDERS = 6
"""Mesh orders that are compared."""
_SAME = 1e-9


class Sides(NamedTuple):
    """A run and what it is called in a comparison."""

    name: str
    result: Result


def table_of_groups(
    ours: Sides,
    theirs: Sides,
    groups: dict[str, list[str]],
    found: Apart,
    values: tuple[np.ndarray, np.ndarray],
    shared: Sequence[str],
) -> pd.DataFrame:
    """One row per group of columns; `values` are (times, shared columns) of both."""
    place = {name: i for i, name in enumerate(shared)}
    rows = []
    for name, columns in groups.items():
        own = [place[c] for c in columns]
        alone = differences(values[0][:, own], values[1][:, own], columns, {name: columns})
        rows.append({
            "group": name,
            "unit": theirs.result.units[columns[0]],
            "channels": len(columns),
            "difference": found.groups.get(name, math.nan),
            "worst": alone.worst or columns[0],
            "worst_difference": alone.worst_difference if alone.worst else math.nan,
            "level_first": _level(ours.result, columns),
            "level_second": _level(theirs.result, columns),
        })  # fmt: skip
    return pd.DataFrame(rows)


def _level(result: Result, columns: Sequence[str]) -> float:
    """Root mean square of the alternating parts over the steady part, of all columns together."""
    values = result.data[list(columns)].to_numpy(float)[steady_part(result).rows]
    return float(np.sqrt(values.var(axis=0).mean()))


def table_of_columns(
    ours: Sides,
    theirs: Sides,
    shared: Sequence[str],
    values: tuple[np.ndarray, np.ndarray],
    units: Mapping[str, str],
) -> pd.DataFrame:
    """One row per common column; `values` are (times, shared columns) of both."""
    off = np.sqrt(np.mean((values[0] - values[1]) ** 2, axis=0))
    spread = values[1].std(axis=0)
    varies = spread > _SAME * np.abs(values[1]).max(axis=0)
    relative = np.where(varies, off / np.where(varies, spread, 1.0), np.nan)
    table = pd.DataFrame({"column": list(shared), "unit": [units[c] for c in shared]})
    table["difference"] = relative
    for name, side in (("first", ours), ("second", theirs)):
        steady = side.result.data[list(shared)].to_numpy(float)[steady_part(side.result).rows]
        table[f"mean_{name}"], table[f"rms_{name}"] = steady.mean(axis=0), steady.std(axis=0)
    return table


def table_of_orders(
    ours: Sides, theirs: Sides, groups: dict[str, list[str]]
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Amplitudes of mesh orders, the largest of each group; or why there are none."""
    names = ["group", "unit", "order", "amplitude_first", "amplitude_second"]
    meshes: list[float] = []
    for side in (ours, theirs):
        rows, mesh = steady_part(side.result).rows, run_mesh_frequency(side.result)
        if mesh is None or rows.stop - rows.start < FEWEST_SAMPLES:
            return pd.DataFrame(columns=names), (f"{side.name} has no steady mesh frequency",)
        meshes.append(mesh)
    found = []
    for name, columns in groups.items():
        one, other = (
            _mesh_amplitudes(side.result, mesh, columns)
            for side, mesh in zip((ours, theirs), meshes, strict=True)
        )
        unit = theirs.result.units[columns[0]]
        found += [
            (name, unit, k + 1, float(one[k].max()), float(other[k].max())) for k in range(ORDERS)
        ]
    return pd.DataFrame(found, columns=names), ()


def _mesh_amplitudes(result: Result, mesh: float, columns: Sequence[str]) -> np.ndarray:
    """Amplitudes (ORDERS, columns) at multiples of the mesh frequency [Hz] in the steady part.

    NaN above half the record rate.
    """
    part = steady_part(result)
    time = result.data[TIME].to_numpy()[part.rows]
    values = result.data[list(columns)].to_numpy(float)[part.rows]
    found = amplitudes_at_multiples(time, values, mesh, ORDERS)
    found[mesh * np.arange(1, ORDERS + 1) > 0.5 / part.sample_step] = math.nan
    return found


def changed_parameters(first: Result, second: Result) -> pd.DataFrame:
    """One row per parameter whose values differ."""
    ours, theirs = first.info.parameters, second.info.parameters
    names = [n for n in {**ours, **theirs} if ours.get(n) != theirs.get(n)]
    rows = [(n, ours.get(n, math.nan), theirs.get(n, math.nan)) for n in names]
    return pd.DataFrame(rows, columns=["parameter", "first", "second"])
