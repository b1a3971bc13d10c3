"""Models that a user made leaner by hand: what that changes of what the scene asks."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.steady.operating_point import Point
from herringbone.components.registry import component_for
from herringbone.core import HerringboneError
from herringbone.core.declaring.roles import Role
from herringbone.core.places.files import is_folder
from herringbone.cosim.structure.system import System
from herringbone.housing import ModalHousing, read_housing
from herringbone.housing.files.file_format import DATA
from herringbone.result.budget import BudgetRow, Known
from herringbone.running.fitted import housings_of
from herringbone.running.housings.given import split_housings
from herringbone.running.housings.rigid_ground import rigid_bearings
from herringbone.running.loading import load_scene, system_and_folder
from herringbone.running.operating.commanded import changing, own_point, with_known_values
from herringbone.running.operating.lean import SOURCE, certified, changed_by
from herringbone.running.prepared import Wishes
from herringbone.scenes import Model, Scene

if TYPE_CHECKING:
    from herringbone.analysis.steady.state import SteadyState

_ASKED = "what the scene asks"
_ALIKE = 1e-6
"""Relative difference of static compliances that are the same: a reduction keeps them exactly."""


@dataclass(frozen=True)
class ByHand:
    """What a user left out, and how to put it back.

    Attributes:
        names: of what is left out, for people.
        scene, wishes: with which nothing is.
        unknown: why the whole model is not known; "" if it is.
        is_leaner: False if parts are replaced by what may know as much as they.
        changing: set points that change in a run.
    """

    names: tuple[str, ...]
    scene: Scene
    wishes: Wishes
    unknown: str = ""
    is_leaner: bool = True
    changing: tuple[str, ...] = ()


class SaidByHand(NamedTuple):
    """What is said of what a user left out.

    Attributes:
        notes: a line; none if nothing is left out.
        row: of the error budget; None likewise.
    """

    notes: tuple[str, ...] = ()
    row: BudgetRow | None = None


def said_by_hand(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    wishes: Wishes,
    point: Point,
    state: "SteadyState | None" = None,
) -> SaidByHand:
    """The model error of what a user left out by hand, as a line and as a row of the budget.

    Model errors are those of the steady state of the operating point, for what the scene asks, or
    for bearing forces and seat velocities if it asks nothing. The row, which is of a run, has none
    if its set points change.

    Args:
        system, scene, wishes: see `running.prepared.prepared`.
        point: operating point.
        state: steady state there, with what the user left out, if it is known.
    """
    own = _left_out(system, scene, wishes, point)
    if not own.names:
        return SaidByHand()
    what = " and ".join(own.names)
    if own.unknown:
        return _unknown(what, own.unknown, warn=own.is_leaner)
    from herringbone.running.operating.model_error import model_errors  # noqa: PLC0415 (numba)

    whole = (system, own.scene, own.wishes)
    try:
        found = model_errors(whole, (system, scene, wishes), point, state)
    except HerringboneError as error:
        return _unknown(what, str(error), warn=True)
    if own.changing:
        named = " and ".join(own.changing)
        row = _unknown_row(f"{what}: not known in a run whose set points of {named} change")
    else:
        how, worst = f"{what}: {found.where}", found.worst
        row = BudgetRow(SOURCE, worst.name, found.errors[worst], Known.MEASURED, how)
    line = f"{'warning: ' if found.is_large else ''}{what}: {found}"
    return SaidByHand((line,), row)


def _unknown(what: str, why: str, *, warn: bool) -> SaidByHand:
    line = f"{what}: the model error is not known at this operating point: {why}"
    row = _unknown_row(f"{what}: not known at this operating point: {why}")
    return SaidByHand((f"warning: {line}" if warn else line,), row)


def _unknown_row(how: str) -> BudgetRow:
    return BudgetRow(SOURCE, _ASKED, None, Known.UNKNOWN, how)


def _left_out(
    system: str | Path | System, scene: str | Path | Scene | None, wishes: Wishes, point: Point
) -> ByHand:
    structure, folder = system_and_folder(system)
    chosen = load_scene(folder, scene)
    names, unknown = [], []
    known = with_known_values(structure, chosen, wishes)
    if chosen.model:
        at = (point.speed, point.torque, own_point(known))
        if not certified(chosen.model, changed_by(wishes), *at):
            names.append("leaner model of the scene")
    housings = housings_of(structure, chosen, wishes)
    for part, data in split_housings(housings)[0].items():
        reduced = read_housing(data) if is_folder(data) else None
        full = None if reduced is None else _full_data(reduced)
        if reduced is None or not (full or DATA in reduced.certificate):
            continue
        names.append(f"housing {data}, reduced to {reduced.valid_to_hz:g} Hz")
        if full is None:
            unknown.append(f"the data that {data} was made of are not there any more")
        else:
            housings[part] = full
    leaner = bool(names)
    names += [
        f"{part}, replaced by an FMU"
        for part in anatomy(structure).with_role(Role.HOUSING)
        if part in known.foreign_parts and part not in structure.foreign_parts
    ]
    one_way = [b for b in rigid_bearings(known) if value_at(structure, b.column) != 0.0]
    names += [f"{', '.join(bearing.housings)} driven one way" for bearing in one_way]
    if known.foreign_parts:
        unknown.append(f"{', '.join(known.foreign_parts)}: nobody knows the equations")
    values = {**wishes.values, **dict.fromkeys((bearing.column for bearing in one_way), 1.0)}
    return ByHand(
        tuple(names),
        replace(chosen, model=Model()),
        replace(wishes, housing=housings, values=values),
        "; ".join(unknown),
        leaner or bool(one_way),
        tuple(changing(known)),
    )


def _full_data(reduced: ModalHousing) -> Path | None:
    """Folder of the data that a housing was reduced from; None: it is not there any more."""
    of = Path(str(reduced.certificate.get(DATA, "")))
    for folder in (of, Path(component_for(Role.HOUSING).resources)):
        if not folder.is_absolute() or not is_folder(folder):
            continue
        try:
            full = read_housing(folder)
        except HerringboneError:
            continue
        static, own = full.static_compliance(), reduced.static_compliance()
        same = np.allclose(static, own, rtol=0.0, atol=_ALIKE * np.abs(static).max())
        if same and full.frequency_hz.size > reduced.frequency_hz.size:
            return folder
    return None
