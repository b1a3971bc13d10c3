"""How long a pair takes until all teeth that differ have met, beside how long a run is."""

import math

from herringbone.analysis.asked import has_own, of_both_gears
from herringbone.analysis.figures.operating_point import run_mesh_frequency
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.result.result import Result


def longest_hunt(result: Result) -> tuple[int, float] | None:
    """Mesh periods, and time [s], after which all teeth that meet have met, of the slowest pair.

    None where all teeth are alike, or the speed is not steady.
    """
    found = []
    for pair in result.parts_with(Role.GEAR_PAIR):
        teeth = of_both_gears(result, pair, Quantity.NUMBER_OF_TEETH)
        mesh = run_mesh_frequency(result, gear=pair)
        if teeth and mesh and has_own(result, pair, Quantity.TOOTH_DEVIATIONS):
            meshes = math.lcm(*(round(z) for z in teeth))
            found.append((meshes, meshes / mesh))
    return max(found, key=lambda hunt: hunt[1], default=None)
