"""A whole system as one native FMU."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from herringbone.analysis.hosted.boundary import is_gearbox
from herringbone.analysis.hosted.component import make_hosted
from herringbone.analysis.twin.composite import make_composite
from herringbone.analysis.twin.monolithic import refuse_foreign_parts
from herringbone.core import Component, ParameterError
from herringbone.core.declaring.hosting import Wanted
from herringbone.core.declaring.variable import Causality
from herringbone.core.places.files import write_whole
from herringbone.core.wording import option
from herringbone.cosim.ssp.write import parameter_set
from herringbone.cosim.structure.system import System
from herringbone.fmi import interface
from herringbone.fmi.native.build import build_models
from herringbone.fmi.native.model import Model
from herringbone.running.exporting.export import written
from herringbone.running.exporting.lean_system import ready_leaner
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes
from herringbone.scenes import Scene

_log = logging.getLogger(__name__)


def export_fmu(
    system: str | Path | System,
    file: str | Path,
    *,
    outside: Sequence[str] = (),
    scene: str | Path | Scene | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    platforms: Sequence[str] = (),
    fmi: int = 2,
    wanted: Wanted | None = None,
) -> Path:
    """Write a system as one native FMU, without any coupling delay inside, or its start values.

    A gearbox, one pair with its bearings and housing, can be made for hosts: few variables, its own
    equilibrium at the start. Other systems keep all variables of their parts and start where the
    scene does. Inner steps follow the host's tolerance; those of systems without condensed form,
    which a line says, are fixed.

    A scene whose model a plan made leaner gives a leaner FMU: without the modes of housings that
    are left out, and with the other states of it held; its description states the certified error.

    A parameter file (.ssv) has the start values alone: inputs, parameters, and states that are set,
    for an FMU that was exported at another operating point. It says nothing of resource files.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System; no
            foreign FMUs.
        file: the .fmu file to write, or the .ssv file.
        outside: instances that stay outside; what they feed becomes inputs of the FMU.
        scene: name or file of the scene that gives start values; the system's default if not given.
        values: variables to set, by `instance.variable`.
        gear, housing: see `herringbone.run`.
        platforms: see `herringbone.fmi.native.PLATFORMS`; this one if not given.
        fmi: FMI version, 2 or 3.
        wanted: what the host of a gearbox gives and wants to see; with `Wanted()` other systems
            are taken, too. None: no FMU made for hosts.

    Returns:
        The file.

    Raises:
        HerringboneError: something about the input is wrong, or the FMU cannot be built.
    """
    file = Path(file)
    if file.suffix not in {".fmu", ".ssv"}:
        raise ParameterError(
            f"{file}: the name of an exported FMU must end in .fmu, that of its start values in "
            ".ssv"
        )
    with TemporaryDirectory() as folder:
        return _exported(
            file, system, scene, Wishes(values=values or {}, gear=gear, housing=housing),
            outside, platforms, fmi, wanted, Path(folder),
        )  # fmt: skip


def _exported(
    file: Path,
    system: str | Path | System,
    scene: str | Path | Scene | None,
    wishes: Wishes,
    outside: Sequence[str],
    platforms: Sequence[str],
    fmi: int,
    wanted: Wanted | None,
    folder: Path,
) -> Path:
    """See `export_fmu`; a leaner model's data go into a folder meanwhile."""
    structure, chosen, held = ready_leaner(system, scene, wishes, folder)
    hosted = wanted is not None and not outside and is_gearbox(structure)
    if wanted not in (None, Wanted()) and not hosted:
        raise ParameterError(
            f"{structure.name}: what a host gives and sees can be chosen of a whole gearbox alone: "
            "one gear pair with bearings and housing, whose two flanges are the ports of the system"
        )
    inside = structure.without(*outside)
    kept_out = option("outside", list(inside.foreign_parts))
    refuse_foreign_parts(
        inside,
        "the system cannot become a single FMU",
        f"leave it out ({kept_out}), or export an .ssp, which carries it (no {option('as_fmu')})",
    )
    if wanted is not None and hosted:
        structure = structure.with_values(chosen.values)
        if held:
            raise ParameterError(
                f"scene {chosen.name}: [model]: a gearbox made for hosts can leave out modes of "
                f"its housing, but not {held[0]}; add {option('outside')}, or hold modes alone"
            )
        composite = make_hosted(structure, wanted)
    else:
        composite = make_composite(structure, tuple(outside), held)
    if composite.note:
        _log.warning(composite.note)
    if file.suffix == ".ssv":
        with written(file):
            write_whole(file, parameter_set(_started(composite.component)))
        return file
    model = Model(
        composite.component,
        (make_composite.__module__, make_hosted.__module__),
        composite.resources,
        identity=_kernels_of(composite.component, [part.name for part in structure.parts]),
    )
    (built,) = build_models([model], platforms=platforms, fmi=fmi).values()
    with written(file):
        write_whole(file, built.read_bytes())
    return file


def _kernels_of(component: Component, parts: Sequence[str]) -> str:
    """What decides on the kernels: the generated source, whose name is its digest, and the layout.

    Start values do not, so that another operating point needs no compilation, and neither does what
    the system and its parts are called: kernels know places.
    """
    d = component.declaration
    index = {_numbered(name, parts): place for name, place in d.index.items()}
    return repr((component.kernels.out.__module__, index, d.size, d.work, d.tables))


def _numbered(name: str, parts: Sequence[str]) -> str:
    """A variable's name, the number of its part in place of the part's path."""
    path = max((part for part in parts if name.startswith(f"{part}.")), key=len, default="")
    return f"{parts.index(path)}{name.removeprefix(path)}" if path else name


def _started(component: Component) -> Iterator[tuple[str, str, str]]:
    """Start values of an FMU; states count where it does not calculate them."""
    for v in interface.reals(component.declaration).values():
        state = v.state and component.hosting is None
        if state or v.causality in {Causality.INPUT, Causality.PARAMETER}:
            named = ("Enumeration", v.items[int(v.start)]) if v.items else None
            yield v.name, *(named or ("Real", repr(float(v.start))))
