"""A system at an operating point, in the equilibrium of it."""

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.set_points import SPEED, TORQUE, set_point
from herringbone.analysis.steady.operating_point import Point, SetPoints
from herringbone.core import EquilibriumError, ParameterError
from herringbone.cosim.structure.system import System
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import commanded, with_known_values
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
    structure, folder = system_and_folder(system)
    if point.torque is not None and wishes.gear:  # what balances it follows from the pair
        structure = prepared(system, scene, asked).system
    wanted = {**SetPoints(structure).values(point), **wishes.values}
    asked = replace(asked, values=wanted, start=Start.EQUILIBRIUM)
    signals: dict[str, float | str] = {}
    if point.speed is not None or point.torque is not None:
        signals = _signals(with_known_values(structure, load_scene(folder, scene), asked), point)
    if not signals:
        return prepared(system, scene, asked)
    try:
        return prepared(system, scene, replace(asked, values={**wanted, **signals}))
    except EquilibriumError:  # a motion may be there all the same, as where run-outs open the teeth
        return prepared(system, scene, asked)


def _signals(system: System, point: Point) -> dict[str, float | str]:
    """Values with which what commands a system has the point's speed and torque.

    The flank that carries follows from these. None of what is an input, or changes with time.
    """
    found: dict[str, float | str] = {}
    for name, value in ((SPEED, point.speed), (TORQUE, point.torque)):
        at = None if value is None else set_point(system, name)
        if value is not None and at is not None and not at.given:
            with suppress(ParameterError):
                found |= commanded(system, {name: value})
    return found
