"""The stiffness table: whose it is, and its load range against the forces of the run."""

from collections.abc import Iterator

import numpy as np

from herringbone.analysis.asked import mesh_forces, resource_file
from herringbone.components.resources.flat_csv import read_header
from herringbone.components.resources.stiffness_table import PAIR, read_stiffness_table
from herringbone.core import ResourceError
from herringbone.core.roles import SIDES, Quantity
from herringbone.result.result import Result


def of_table(result: Result, gear: str) -> Iterator[str]:
    """Lines on the stiffness table of a gear pair."""
    file = resource_file(result, gear, Quantity.STIFFNESS_TABLE)
    if file is None:
        return
    try:
        tables = read_stiffness_table(file)
    except ResourceError:  # it was read when the run began
        return
    if np.isnan(read_header(file, *PAIR)).any():
        yield (
            f"{gear}: its stiffness table {file} does not tell of which pair it is, so that this "
            "was not tested; those that 'herringbone gear' writes do"
        )
    for side, (loads, _) in zip(SIDES, tables, strict=True):
        force = mesh_forces(result, gear).get(side)
        largest = float(result.data[force].abs().max()) if force in result.data else 0.0
        if largest > loads[-1]:
            yield (
                f"{gear}: the {side} mesh carries up to {largest:.4g} N, its stiffness table ends "
                f"at {loads[-1]:.4g} N: above that the law goes on as a straight line"
            )
