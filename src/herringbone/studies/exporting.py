"""Export of a system for other tools: an .ssp file, or one native FMU, as planned or whole."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.core.declaring.roles import GEARS
from herringbone.core.process.telling import Tell, untold
from herringbone.core.wording import option
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.system_file import short_name
from herringbone.running.exporting.export import (
    chosen_platforms,
    export_ssp,
    fmu_file_name,
    untested,
)
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named
from herringbone.scenes import Scene
from herringbone.studies.planning.plan import plan as planned
from herringbone.studies.planning.text import plan_text


def export(
    system: str | Path | System,
    output: str | Path | None = None,
    *,
    as_fmu: bool = False,
    scene: str | Path | Scene | None = None,
    step: float | None = None,
    plan: bool = False,
    outside: Sequence[str] = (),
    pinion: str | None = None,
    wheel: str | None = None,
    outputs: Sequence[str] = (),
    internals: bool = False,
    nodes: bool = False,
    parameters: bool = False,
    me: bool = False,
    python: bool = False,
    nested: bool = False,
    platforms: Sequence[str] = (),
    fmi: int = 2,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    told: Tell = untold,
) -> Path:
    """Export a system as .ssp file, or as one native FMU; see `docs/other_tools.md`.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        output: file; SYSTEM.ssp, SYSTEM.fmu, or for FMI 3 SYSTEM_fmi3.fmu if not given. A .ssv file
            with `as_fmu`: start values of the scene alone.
        as_fmu: one native FMU of the whole system.
        scene: name or file of a scene that gives start values; the system's default if not given.
        step: communication step size [s], of an .ssp file; a stable one if not given.
        plan: of one FMU: plan what the scene asks, and leave out what the choice does.
        outside: instances that are left out of the FMU; what they feed becomes inputs.
        pinion, wheel: what the host gives at the flange of a gearbox, "torque", "motion" or
            "speed"; torque if not given.
        outputs: patterns of further outputs of a gearbox FMU, such as "*.deflection".
        internals: a gearbox FMU shows all variables of its parts, as locals.
        nodes: it shows the signals' nodes, for masters that know them.
        parameters: it shows all parameters.
        me: it offers model exchange besides co-simulation.
        python: Python FMUs in the .ssp file; native ones if not given.
        nested: nested systems stay so in the .ssp file, with connectors.
        platforms: of native FMUs, or ["all"]; this one if not given.
        fmi: version, 2 or 3, of the FMU.
        values, gear, housing: as in `herringbone.run`.
        told: called with lines on a plan, and on platforms that were built and cannot be run here.

    Returns:
        The file.

    Raises:
        HerringboneError: something about the input is wrong, or the export fails.
    """
    platforms = chosen_platforms(platforms)
    flanges = {gear: x for gear, x in zip(GEARS, (pinion, wheel), strict=True) if x is not None}
    switches = {"internals": internals, "nodes": nodes, "parameters": parameters, "me": me}
    own = _Given(values, gear, housing)
    name = system.name if isinstance(system, System) else short_name(system)
    if as_fmu:
        _refuse(
            f"of .ssp files; leave out {option('as_fmu')}",
            {"step": step is not None, "nested": nested, "python": python},
        )
        if output and Path(output).suffix == ".ssv":
            _refuse(
                "of FMUs; a .ssv file has start values alone, leave it out",
                {"platforms": platforms, "fmi": fmi != 2},
            )
        if plan:
            scene = _planned(system, scene, own, told)
        file = export_fmu(
            system,
            output or fmu_file_name(name, fmi),
            outside=outside,
            scene=scene,
            platforms=platforms,
            fmi=fmi,
            wanted=_wanted(flanges, outputs, switches),
            **own._asdict(),
        )
    else:
        of_fmus = {"plan": plan, "outside": outside, "fmi": fmi != 2, "outputs": outputs}
        _refuse(f"of one FMU; add {option('as_fmu', True)}", {**of_fmus, **flanges, **switches})
        if platforms:
            _refuse("of Python FMUs, which have no platforms; leave it out", {"python": python})
        file = export_ssp(
            system,
            output or f"{name}.ssp",
            scene=scene,
            step=step,
            native=not python,
            platforms=platforms,
            nested=nested,
            **own._asdict(),
        )
    for line in untested(platforms):
        told(line)
    return file


class _Given(NamedTuple):
    """What is set over a scene, see `herringbone.run`."""

    values: Mapping[str, float | str | Path] | None
    gear: Gear | Mapping[str, Gear] | None
    housing: Named | None


def _refuse(why: str, given: Mapping[str, object]) -> None:
    """Refuse what belongs to the other kind of file; raises ParameterError."""
    if wrong := [name for name, value in given.items() if value]:
        raise ParameterError(f"{option(wrong[0])}: {why}")


def _planned(
    system: str | Path | System, scene: str | Path | Scene | None, own: _Given, told: Tell
) -> Scene:
    """The scene with the model that a plan chose, which is told."""
    found = planned(system, scene=scene, for_fmu=True, **own._asdict())
    for line in plan_text(found):
        told(line)
    return found.scene


def _wanted(
    flanges: Mapping[str, str], outputs: Sequence[str], switches: Mapping[str, bool]
) -> Wanted:
    """What the host of a gearbox gives and wants to see; raises ParameterError."""
    known = [given.value for given in Given]
    for gear, given in flanges.items():
        if given not in known:
            raise ParameterError(f"{option(gear)} = {given!r}: it takes {' or '.join(known)}")
    shown = {name: switches[name] for name in ("internals", "nodes", "parameters")}
    by_gear = {gear: Given(given) for gear, given in flanges.items()}
    return Wanted(by_gear, tuple(outputs), exchange=switches["me"], **shown)
