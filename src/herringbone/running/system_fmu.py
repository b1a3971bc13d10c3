"""A whole system as one native FMU."""

import shutil
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from herringbone.analysis.twin.composite import make_composite
from herringbone.core import ParameterError
from herringbone.fmi.native.build import build_models
from herringbone.fmi.native.model import Model
from herringbone.running.export import ready, written
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named
from herringbone.scenes import Scene


def export_fmu(
    system: str | Path,
    file: str | Path,
    *,
    outside: Sequence[str] = (),
    scene: str | Path | Scene | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    platforms: Sequence[str] = (),
    fmi: int = 2,
) -> Path:
    """Write a system as one native FMU, without any coupling delay inside.

    Args:
        system: name of a shipped system, folder with system.toml, or .ssp file; no foreign FMUs.
        file: the .fmu file to write.
        outside: instances that stay outside; what they feed becomes inputs of the FMU.
        scene: name or file of the scene that gives start values; the system's default if not given.
        values: variables to set, by `instance.variable`.
        gear, housing: see `herringbone.run`.
        platforms: see `herringbone.fmi.native.PLATFORMS`; this one if not given.
        fmi: FMI version, 2 or 3.

    Returns:
        The file.

    Raises:
        HerringboneError: something about the input is wrong, or the FMU cannot be built.
    """
    file = Path(file)
    if file.suffix != ".fmu":
        raise ParameterError(f"{file}: the name of an exported FMU must end in .fmu")
    structure, _ = ready(system, scene, values, gear, housing)
    composite = make_composite(structure, tuple(outside))
    model = Model(
        composite.component,
        (make_composite.__module__,),
        composite.resources,
        identity=repr((asdict(structure), tuple(outside))),
    )
    (built,) = build_models([model], platforms=platforms, fmi=fmi).values()
    with written(file):
        shutil.copyfile(built, file)
    return file
