"""What in a run does not fit together: gear pair, bearings, controller, housing, table and scene.

Each is a line with the numbers of both sides. Nothing is refused here: a user may mean it.
"""

from herringbone.analysis.figures.misfits.displaced import of_axes
from herringbone.analysis.figures.misfits.flanks import of_flank
from herringbone.analysis.figures.misfits.housings import of_housing
from herringbone.analysis.figures.misfits.ratios import of_ratio
from herringbone.analysis.figures.misfits.records import of_records
from herringbone.analysis.figures.misfits.tables import of_table
from herringbone.core.declaring.roles import Role
from herringbone.result.result import Result


def misfits(result: Result) -> tuple[str, ...]:
    """Lines on what does not fit together, each with both numbers."""
    return tuple(
        line
        for gear in result.parts_with(Role.GEAR_PAIR)
        for of in (of_ratio, of_housing, of_table, of_flank, of_axes, of_records)
        for line in of(result, gear)
    )
