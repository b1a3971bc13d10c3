"""A leaner model as a system to be exported: fewer modes in the data, states that are held."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.figures.system_housings import data_of
from herringbone.components.registry import COMPONENTS
from herringbone.core import ParameterError, StructureError
from herringbone.core.declaring.roles import Role
from herringbone.core.names import shown
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing, write_housing
from herringbone.running.exporting.export import ready
from herringbone.running.fitted import housings_of
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import operated
from herringbone.running.operating.lean import changed_by, lean_notes
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Model, Scene


class Leaner(NamedTuple):
    """How an FMU becomes a leaner model.

    Attributes:
        wishes: with the data of housings without the modes that are left out.
        held: states that keep their start values.
    """

    wishes: Wishes
    held: tuple[str, ...]


def ready_leaner(
    system: str | Path | System, scene: str | Path | Scene | None, wishes: Wishes, folder: Path
) -> tuple[System, Scene, tuple[str, ...]]:
    """The system with all values, its scene, and states that keep their start values.

    Args:
        system, scene, wishes: see `running.prepared.prepared`; a leaner model is that of the scene.
        folder: for the data of housings with fewer modes.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    chosen = load_scene(system_and_folder(system)[1], scene)
    if not chosen.model:
        return *ready(system, chosen, wishes), ()
    whole, at = replace(chosen, model=Model()), chosen.operating
    lowest = [None if ends is None else ends[0] for ends in (at.speed, at.torque)]
    asked = operated(system, whole, wishes, *lowest)
    own = _as_leaner(prepared(system, whole, asked).system, chosen, asked, folder)
    structure, scene = ready(system, whole, own.wishes)
    (said,) = lean_notes(chosen.model, changed_by(wishes), own=(lowest[0], lowest[1]))
    return replace(structure, description=f"{structure.description}; {said}"), scene, own.held


def _as_leaner(whole: System, scene: Scene, wishes: Wishes, folder: Path) -> Leaner:
    """What a scene's model asks of an FMU.

    Modes whose deflection and rate are both held go out of the data, so that they cost nothing;
    their static deflection, which no alternating part feels, goes with them.

    Args:
        whole: the system, prepared.
        scene: with the model.
        wishes: with which it was prepared.
        folder: for the data of housings.

    Raises:
        ParameterError: the model leaves out more than states, or other values are set besides.
        StructureError: the system has no such state.
    """
    if scene.model.parts:
        raise ParameterError(
            f"scene {scene.name}: [model]: an FMU can hold states, but has no one_way, frozen, "
            "linear or harmonics; plan anew with 'herringbone export SYSTEM --as-fmu --plan "
            "--scene SCENE'"
        )
    known = _states(whole)
    if missing := [name for name in scene.model.hold if name not in known]:
        raise StructureError(
            f"{whole.name}: model: it has no state {shown(missing[0], 60)} to hold"
        )
    rest, housings = set(scene.model.hold), housings_of(whole, scene, wishes)
    for part in anatomy(whole).with_role(Role.HOUSING):
        modes = dict(_modes_of(whole, part))
        out = [k for k, own in modes.items() if set(own) <= rest]
        rest -= {name for k in out for name in modes[k]}
        data = data_of(whole, part)
        gone = [k for k in out if k < data.frequency_hz.size]
        if gone:
            housings[part] = folder / part
            write_housing(_without(data, gone), folder / part)
    own = replace(wishes, housing=housings or None)
    return Leaner(own, tuple(name for name in scene.model.hold if name in rest))


def _states(system: System) -> set[str]:
    """All states that do not grow with every turn, those of vectors by element."""
    found = set()
    for part in system.parts:
        declaration = COMPONENTS[str(part.component)].declaration
        own = [s.name for s in declaration.states if s.steady != "rotating"]
        found |= {f"{part.name}.{name}" for name in own}
        for vector in declaration.vectors:
            elements = range(1, vector.capacity + 1)
            found |= {f"{part.name}.{vector.element(k)}" for k in elements}
    return found


def _modes_of(system: System, part: str) -> Iterator[tuple[int, tuple[str, str]]]:
    """Deflection and rate of each oscillator, by its place in the data."""
    component = COMPONENTS[str(system.part(part).component)]
    vectors = {vector.name: vector for vector in component.declaration.vectors}
    for name, vector in vectors.items():
        if rate := vectors.get(f"der({name})"):
            for k in range(vector.capacity):
                own = (vector.element(k + 1), rate.element(k + 1))
                yield k, (f"{part}.{own[0]}", f"{part}.{own[1]}")


def _without(data: ModalHousing, gone: list[int]) -> ModalHousing:
    kept = np.setdiff1d(np.arange(data.frequency_hz.size), gone)
    return replace(
        data,
        kind=tuple(data.kind[k] for k in kept),
        frequency_hz=data.frequency_hz[kept],
        damping_ratio=data.damping_ratio[kept],
        shapes=data.shapes[:, kept],
        gram=None if data.gram is None else np.asarray(data.gram)[np.ix_(kept, kept)],
        static=None,
        certificate={},
    )
