"""The tables of a comparison of two runs, whose columns `Comparison` names."""

import math
from collections.abc import Mapping, Sequence
from itertools import takewhile
from pathlib import Path

import numpy as np
import pandas as pd

from herringbone.analysis.accuracy.apart import Apart, differences
from herringbone.analysis.accuracy.common_ground import Sides
from herringbone.analysis.figures.operating_point import no_mesh_frequency, run_mesh_frequency
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, amplitudes_at_multiples
from herringbone.analysis.figures.standstill import stands_still
from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.roles import Quantity
from herringbone.core.places.files import is_file
from herringbone.core.reading.texts import read_text
from herringbone.result.result import TIME, Result

ORDERS = 6
"""Mesh orders that are compared."""
_SAME = 1e-9
_SAME_VALUE = 1e-7
"""Relative difference of parameters below which they are the same: iterations end about there."""


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
            "level_first": _level(ours, columns),
            "level_second": _level(theirs, columns),
        })  # fmt: skip
    return pd.DataFrame(rows)


def _level(side: Sides, columns: Sequence[str]) -> float:
    """Root mean square of the alternating parts over the steady part, of all columns together.

    0 where nothing turns: what alternates there is rounding.
    """
    if stands_still(side.result):
        return 0.0
    values = side.result.data[list(columns)].to_numpy(float)[side.part.rows]
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
        steady = side.result.data[list(shared)].to_numpy(float)[side.part.rows]
        table[f"mean_{name}"], table[f"rms_{name}"] = steady.mean(axis=0), steady.std(axis=0)
    return table


def table_of_orders(
    ours: Sides, theirs: Sides, groups: dict[str, list[str]]
) -> tuple[pd.DataFrame, tuple[str, ...]]:
    """Amplitudes of mesh orders, the largest of each group; or why there are none."""
    names = ["group", "unit", "order", "amplitude_first", "amplitude_second"]
    meshes: list[float] = []
    for side in (ours, theirs):
        rows, mesh = side.part.rows, run_mesh_frequency(side.result, part=side.part)
        if mesh is None or rows.stop - rows.start < FEWEST_SAMPLES:
            why = no_mesh_frequency(side.result)
            return pd.DataFrame(columns=names), (f"{side.name} has {why}",)
        meshes.append(mesh)
    found = []
    for name, columns in groups.items():
        one, other = (
            _mesh_amplitudes(side, mesh, columns)
            for side, mesh in zip((ours, theirs), meshes, strict=True)
        )
        unit = theirs.result.units[columns[0]]
        found += [
            (name, unit, k + 1, float(one[k].max()), float(other[k].max())) for k in range(ORDERS)
        ]
    return pd.DataFrame(found, columns=names), ()


def _mesh_amplitudes(side: Sides, mesh: float, columns: Sequence[str]) -> np.ndarray:
    """Amplitudes (ORDERS, columns) at multiples of the mesh frequency [Hz] in the steady part.

    NaN above half the record rate.
    """
    part, data = side.part, side.result.data
    time = data[TIME].to_numpy()[part.rows]
    values = data[list(columns)].to_numpy(float)[part.rows]
    found = amplitudes_at_multiples(time, values, mesh, ORDERS)
    found[mesh * np.arange(1, ORDERS + 1) > 0.5 / part.sample_step] = math.nan
    return found


def changed_parameters(first: Result, second: Result) -> pd.DataFrame:
    """One row per parameter whose values differ by more than rounding and iterations leave.

    Those that follow from the others, forces under which parts start at rest, are marked as
    "computed" and come last. Inner steps that one of the runs does not take are left out.
    """
    ours, theirs = first.info.parameters, second.info.parameters
    names = [n for n in {**ours, **theirs} if n not in {*_unused(first), *_unused(second)}]
    rows = [(n, ours.get(n, math.nan), theirs.get(n, math.nan)) for n in names]
    apart = [row for row in rows if not math.isclose(*row[1:], rel_tol=_SAME_VALUE)]
    model = {**first.info.model, **second.info.model}
    found = [(*row, _computed(row[0], model)) for row in apart]
    found.sort(key=lambda row: row[3])
    return pd.DataFrame(found, columns=["parameter", "first", "second", "computed"])


def _unused(result: Result) -> list[str]:
    """Inner steps of parts that a run has fused into a core."""
    known = result.info.anatomy
    parts = known.parts if result.info.core else ()
    return [column for part in parts for column in known.columns(part, Quantity.MICRO_STEP)]


def _computed(name: str, model: Mapping[str, str]) -> bool:
    """True if a parameter is set together with the start, as nobody sets it by hand."""
    parts = [part for part in model if name.startswith(f"{part}.")]
    component = COMPONENTS.get(model[max(parts, key=len)]) if parts else None
    declared = component.declaration.parameters if component else ()
    return any(v.at_rest and name.endswith(f".{v.name}") for v in declared)


def changed_resources(first: Result, second: Result) -> pd.DataFrame:
    """One row per file of a component that differs by name: "resource", "first", "second".

    Files of the cache have names by what they are made of. Where both are still there and have
    comments, such as the relief of a pair's table, those that differ stand in the names' place.
    """
    ours, theirs = first.info.resources, second.info.resources
    rows = []
    for name in {**ours, **theirs}:
        files = ours.get(name, ""), theirs.get(name, "")
        if files[0] != files[1]:
            rows.append((name, *_told_apart(*files)))
    return pd.DataFrame(rows, columns=["resource", "first", "second"])


def _told_apart(first: str, second: str) -> tuple[str, str]:
    """What the comments of two files say that the other's do not; else their names."""
    ours, theirs = _comments(first), _comments(second)
    alone = [" ".join(c for c in a if c not in b) for a, b in ((ours, theirs), (theirs, ours))]
    one, other = (Path(file).name or "none" for file in (first, second))
    return (alone[0], alone[1]) if all(alone) else (one, other)


def _comments(file: str) -> list[str]:
    """Sentences of a resource's comments, without those that programs read."""
    if not Path(file).is_absolute() or not is_file(Path(file)):
        return []
    found = takewhile(lambda line: line.startswith("# "), read_text(Path(file)).splitlines())
    return [line[2:] for line in found if line[2:3].isupper()]
