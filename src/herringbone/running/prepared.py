"""A system made ready for a run: its scene, its gears and housings, its start values."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.figures.system_housings import implausible_housings
from herringbone.core import EquilibriumError
from herringbone.core.given import check_mapping
from herringbone.cosim.structure.system import System
from herringbone.running.fitted import with_files
from herringbone.running.housings.fmu_remarks import HousingRemarks
from herringbone.running.housings.rigid_ground import driven_one_way
from herringbone.running.loading import load_scene, system_and_folder, with_options
from herringbone.running.operating.lean import refuse_lean
from herringbone.running.pairs.gears import Gear
from herringbone.running.pairs.impacts import with_impacts
from herringbone.running.pairs.open_flanges import balanced, unbalanced
from herringbone.running.settling.held import NOT_WANTED, Wanted
from herringbone.running.start import started
from herringbone.scenes import Scene

Named = str | Path | Mapping[str, str | Path]


@dataclass(frozen=True)
class Wishes:
    """What a caller asks for besides system and scene; None: as these have it.

    Attributes:
        t_end, record_step: durations [s].
        start: see `scenes.Start`.
        values: variables to set, by `instance.variable`.
        gear: file or job of the gear pair, or of each by path.
        housing: data, dimensions or FMU of the housing, or of each by path.
        replace_parts: FMU files by instance.
        start_offset: in place of the scene's.
        lean: the caller takes the leaner model that a scene may have.
        probe: foreign FMUs are tried; False: none of their steps is taken before the run.
    """

    t_end: float | None = None
    record_step: float | None = None
    start: str | None = None
    values: Mapping[str, float | str | Path] = field(default_factory=dict)
    gear: Gear | Mapping[str, Gear] | None = None
    housing: Named | None = None
    replace_parts: Mapping[str, str | Path] = field(default_factory=dict)
    start_offset: Mapping[str, float] | None = None
    lean: bool = False
    probe: bool = True

    def __post_init__(self) -> None:
        """Check kinds; raises ParameterError."""
        check_mapping("values", self.values, '{"PART.VARIABLE": 1e-4}')
        check_mapping("replace_parts", self.replace_parts, '{"PART": "Motor.fmu"}')


class Prepared(NamedTuple):
    """A system with all values, the scene that gave them, and lines that the user should read."""

    system: System
    scene: Scene
    notes: tuple[str, ...]


def prepared(
    system: str | Path | System,
    scene: str | Path | Scene | None,
    wishes: Wishes,
    check: Callable[[Scene], None] = lambda scene: None,
    remarked: Callable[[HousingRemarks], None] = lambda remarks: None,
    trial_step: float | None = None,
    wanted: Wanted = NOT_WANTED,
) -> Prepared:
    """Load a system and a scene, and set what is wished.

    The order in which values hold: those of the caller, those of the scene, those of the system by
    name, those of the gear pair, those that components declare.

    Args:
        system, scene: see `api.run`.
        wishes: over these.
        check: called with the scene before anything takes long.
        remarked: called with what is to be said of an FMU that replaces a housing.
        trial_step, wanted: see `started`.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    structure, folder = system_and_folder(system)
    w = wishes
    chosen = with_options(load_scene(folder, scene), w.t_end, w.record_step, w.start, w.values)
    if w.start_offset is not None:
        chosen = replace(chosen, start_offset=w.start_offset)
    if not w.lean:
        refuse_lean(chosen)
    check(chosen)
    found = with_files(structure, chosen, w, Path(folder))
    for own in found.remarks:
        remarked(own)
    structure = balanced(found.system)
    lines = (*unbalanced(structure), *driven_one_way(structure))
    try:
        structure, notes = started(structure, chosen, trial_step, wanted)
    except EquilibriumError as error:
        lines = (*lines, *implausible_housings(structure))
        raise EquilibriumError("; ".join((*lines, str(error)))) from error
    structure, impacts = with_impacts(structure, found.jobs)
    notes = (*found.notes, *lines, *notes, *impacts, *found.of_fmus)
    return Prepared(structure, chosen, notes)
