"""A system at an operating point, in the equilibrium of it."""

from dataclasses import replace
from pathlib import Path

from herringbone.analysis.steady.set_points import Point, SetPoints
from herringbone.cosim.structure.system import System
from herringbone.running.loading import load_system
from herringbone.running.prepared import Prepared, Wishes, prepared
from herringbone.scenes import Scene, Start

NOTHING = Wishes()


def prepared_at(
    point: Point,
    system: str | Path | System,
    scene: str | Path | Scene | None = None,
    wishes: Wishes = NOTHING,
) -> Prepared:
    """A system in the equilibrium of an operating point; see `steady`.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    point.check()
    asked = replace(wishes, start=Start.REST, start_offset={}, lean=True)
    structure = system if isinstance(system, System) else load_system(system)[0]
    if point.torque is not None and wishes.gear:  # what balances it follows from the pair
        structure = prepared(system, scene, asked).system
    wanted = {**SetPoints(structure).values(point), **wishes.values}
    return prepared(system, scene, replace(asked, values=wanted, start=Start.EQUILIBRIUM))
