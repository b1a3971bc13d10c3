"""A system with the gears and housings that it, its scene and the caller give it."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from herringbone.analysis.anatomy import check_numbers
from herringbone.analysis.figures.sensing.sensors import check_sensors
from herringbone.analysis.figures.system_housings import misplaced_seats
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.wording import option
from herringbone.cosim.ssp.format import is_ssp
from herringbone.cosim.structure.system import System
from herringbone.gears.job import GearJob
from herringbone.running.chosen_parts import part_for
from herringbone.running.housings.fmu_remarks import HousingRemarks
from herringbone.running.housings.given import split_housings, with_housing_data
from herringbone.running.loading import with_replacements
from herringbone.running.pairs.gears import Gear, with_gears
from herringbone.scenes import Scene

if TYPE_CHECKING:
    from herringbone.running.prepared import Wishes


class WithFiles(NamedTuple):
    """A system with its gears and housings.

    Attributes:
        system: with the values of its scene.
        jobs: of gear pairs, by part.
        notes: lines on gears and on data of housings: the same at all operating points.
        remarks: on FMUs in the place of housings.
    """

    system: System
    jobs: Mapping[str, GearJob]
    notes: tuple[str, ...]
    remarks: Sequence[HousingRemarks]

    @property
    def of_fmus(self) -> tuple[str, ...]:
        """The lines of all remarks."""
        return tuple(line for own in self.remarks for line in own.lines)


def with_files(system: System, scene: Scene, wishes: "Wishes", folder: Path) -> WithFiles:
    """The system with its scene's values, its gear pairs and housings, and what they say.

    Args:
        system, scene: loaded.
        wishes: over these.
        folder: of the system; an .ssp file takes no gears and housings.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    gears: dict[str, Gear] = _merged(
        system, Role.GEAR_PAIR, system.gears, scene.gears, _by_path(wishes.gear)
    )
    housings = housings_of(system, scene, wishes)
    if (gears or housings) and is_ssp(folder):
        raise ParameterError(
            f"{folder}: an .ssp file sets all values by name; {option('gear')} and "
            f"{option('housing')} are of systems"
        )
    data, fmus = split_housings(housings)
    replaced = {**wishes.replace_parts, **fmus}
    system, remarks = with_replacements(system, replaced, probe=wishes.probe)
    system = with_housing_data(system, data).with_values(scene.values)
    check_sensors(system)
    check_numbers(system)
    system, jobs, notes = with_gears(system, gears)
    return WithFiles(system, jobs, (*notes, *misplaced_seats(system)), remarks)


def housings_of(system: System, scene: Scene, wishes: "Wishes") -> dict[str, str | Path]:
    """Data, dimensions or FMUs of housings by their whole paths; raises ParameterError."""
    return _merged(system, Role.HOUSING, system.housings, scene.housings, _by_path(wishes.housing))


def _merged(system: System, role: Role, *levels: Mapping[str, Any]) -> dict[str, Any]:
    """What is given for parts of a role, by their whole paths; a later level holds.

    Raises:
        ParameterError: see `part_for`; or one level gives a part twice, by different paths.
    """
    found: dict[str, Any] = {}
    for level in levels:
        own: dict[str, Any] = {}
        for path, given in level.items():
            part = part_for(system, role, path, _called(role, given))
            if part in own:
                raise ParameterError(
                    f"{_called(role, given)}: {part} has {_called(role, own[part])} already; "
                    "give one of them"
                )
            own[part] = given
        found |= own
    return found


def _called(role: Role, given: object) -> str:
    """What messages call a file of a role; of what is no file they say the role alone."""
    return f"{role} {given}" if isinstance(given, str | Path) else role


def _by_path(given: object) -> dict:
    """What is given for each part by its path; "": for the only one."""
    if given is None:
        return {}
    return dict(given) if isinstance(given, Mapping) else {"": given}
