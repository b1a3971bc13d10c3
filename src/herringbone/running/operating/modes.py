"""Natural modes of systems, by name."""

from collections.abc import Mapping
from pathlib import Path

from herringbone.analysis.modes.natural_modes import NaturalModes, natural_modes
from herringbone.analysis.twin.monolithic import refuse_foreign_parts
from herringbone.cosim.structure.system import System
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Scene, Start


def modes(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
) -> NaturalModes:
    """Natural modes of a system about the equilibrium of a scene.

    The system has no gyroscopic terms, so that frequencies do not depend on speed; they depend on
    the load by the stiffness of the mesh.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file; gives values and load, as in `run`.
        values, gear, housing: see `herringbone.run`.

    Raises:
        HerringboneError: something about the input is wrong, or a part is a foreign FMU.
    """
    wishes = Wishes(
        values=values or {}, gear=gear, housing=housing, start=Start.EQUILIBRIUM, start_offset={}
    )
    found = prepared(system, scene, wishes)
    refuse_foreign_parts(
        found.system,
        "the system's natural modes cannot be computed",
        "take components in their place, or look at the spectra of a run (herringbone run)",
    )
    return natural_modes(found.system, found.notes)
