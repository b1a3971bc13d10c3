"""Speeds at which orders meet natural frequencies: those of the mesh, and those of other parts."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from herringbone.analysis.anatomy import anatomy
from herringbone.core.declaring.roles import Role

if TYPE_CHECKING:
    from herringbone.analysis.modes.natural_modes import NaturalModes

ORDERS = (1, 2, 3, 4, 5, 6)
"""Of the mesh, that are shown."""
LEAST = 1e-3
"""Answer, over the largest, below which a mode is not heard."""
COLUMNS = "excitation", "part", "order", "mode", "frequency", "speed", "from_present", "answer"


def mesh_crossings(
    found: "NaturalModes", orders: Sequence[int], highest_speed: float
) -> pd.DataFrame:
    """See `NaturalModes.crossings`."""
    names = ["speed", "order", "mode", "frequency", "mesh_answer"]
    teeth = found.teeth
    if teeth is None:
        return pd.DataFrame(columns=names, dtype=float)
    rows = [
        (60.0 * f / (order * teeth), order, k + 1, f, found.mesh_answer[k, 0])
        for order in orders
        for k, f in enumerate(found.frequency_hz)
        if 60.0 * f / (order * teeth) <= highest_speed
    ]
    table = pd.DataFrame(rows, columns=names, dtype=float)
    table[["order", "mode"]] = table[["order", "mode"]].astype(int)
    first = np.argsort(-found.mesh_weight[table["mode"] - 1], kind="stable")
    return table.iloc[first].reset_index(drop=True)


def critical_speeds(
    found: "NaturalModes", highest_speed: float, highest: float, orders: Sequence[int] = ORDERS
) -> pd.DataFrame:
    """See `NaturalModes.critical_speeds`."""
    rows = [
        (one.label, one.part, one.order, k + 1, f, f / one.slope, one.answer[k])
        for one in found.excited.orders
        for k, f in enumerate(found.frequency_hz)
    ]
    if found.excited.reference and (teeth := found.teeth_of_reference) is not None:
        pair = anatomy(found.system).with_role(Role.GEAR_PAIR)[0]
        strongest = float(found.mesh_weight.max(initial=0.0)) or 1.0
        rows += [
            (mesh_label(order), pair, order * teeth, k + 1, f, 60.0 * f / (order * teeth),
             found.mesh_weight[k] / strongest)
            for order in orders
            for k, f in enumerate(found.frequency_hz)
        ]  # fmt: skip
    table = pd.DataFrame(rows, columns=[name for name in COLUMNS if name != "from_present"])
    table = table[(table["speed"] <= highest_speed) & (table["frequency"] <= highest)]
    table.insert(
        COLUMNS.index("from_present"), "from_present", table["speed"] - found.excited.speed
    )
    nearest = np.argsort(table["from_present"].abs().to_numpy(dtype=float), kind="stable")
    return table.iloc[nearest].reset_index(drop=True)


def mesh_label(order: int) -> str:
    """A multiple of the mesh frequency."""
    return "f_m" if order == 1 else f"{order} f_m"
