"""Running a system: from names and options to a result."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.diagnosis import diagnose
from herringbone.analysis.monolithic import refuse_foreign_parts
from herringbone.analysis.stability import fastest_bond, warn_if_unstable
from herringbone.components.in_process import InProcessPart
from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.components.registry import component
from herringbone.core import HerringboneError, Instance, OutcomeKind, ParameterError
from herringbone.core.energy_report import Verdict
from herringbone.core.part import Part
from herringbone.cosim.algorithms import (
    AUTO,
    Algorithm,
    choose_algorithm,
    parse_algorithm,
    with_tolerance,
)
from herringbone.cosim.open_fmu import open_fmu
from herringbone.cosim.simulation import Progress, Recording, make_grid, simulate
from herringbone.cosim.ssp_format import is_ssp
from herringbone.cosim.system import PartSpec, System
from herringbone.cosim.system_file import find_system, read_system
from herringbone.fmi.build import build_python_fmus
from herringbone.fmi.kind import AUTO as AUTO_FMU
from herringbone.fmi.kind import choose_kind
from herringbone.fmi.native import build_native_fmus
from herringbone.housing_check import replacement_notes
from herringbone.result import Result
from herringbone.run_result import decimated, make_result, with_error
from herringbone.scenes import Scene, Start, find_scene, read_scene
from herringbone.scenes.scene import DEFAULT_SCENE
from herringbone.ssp_import import load_ssp, ssp_scene
from herringbone.start import started

_BUILDERS = {"native": build_native_fmus, "python": build_python_fmus}
_TINY = 1e-12  # stands for a step [s] that is not yet known


def load_system(reference: str | Path) -> tuple[System, Path]:
    """A system by name, folder or .ssp file, and the folder (or .ssp file) that has its scenes.

    Raises:
        StructureError: it cannot be found or read.
    """
    if is_ssp(Path(reference)):
        return load_ssp(Path(reference)), Path(reference)
    return read_system(reference), find_system(reference)


def load_scene(folder: Path, scene: str | Scene | None) -> Scene:
    """A scene by name or file; the system's default scene, or plain defaults if it has none.

    An .ssp file has start values and a stop time in place of scenes.

    Raises:
        ParameterError: there is no such scene.
    """
    if isinstance(scene, Scene):
        return scene
    if scene is None and is_ssp(folder):
        return ssp_scene(folder)
    if scene is None and not (folder / "scenes" / f"{DEFAULT_SCENE}.toml").is_file():
        return Scene("default")
    return read_scene(find_scene(folder, scene or DEFAULT_SCENE))


def run(
    system: str | Path | System,
    *,
    scene: str | Scene | None = None,
    algorithm: str | Algorithm | None = None,
    step: float | None = None,
    tolerance: float | None = None,
    slow: Mapping[str, int] | None = None,
    t_end: float | None = None,
    record_step: float | None = None,
    start: str | None = None,
    fmu: str = AUTO_FMU,
    replace_parts: Mapping[str, str | Path] | None = None,
    values: Mapping[str, float | str] | None = None,
    reference: bool = False,
    progress: Progress | None = None,
) -> Result:
    """Run a system.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene; the system's "loaded" if not given.
        algorithm: coupling algorithm, such as `LI(degree=3)` or "li:degree=3"; "auto", the
            default, takes li if all parts can repeat a step, and jacobi otherwise.
        step: communication step size [s]; the algorithm's default if not given. With a tolerance
            the largest one, and the others go down to 1/200 of it.
        tolerance: relative error (see `analysis.error`) for which `li` adapts its step, as in
            "li:tolerance=1e-3".
        slow: heavy bodies that step once in several macro steps, and in how many, such as
            {"drive_motor": 5, "load_motor": 5}; the others see their predicted motion.
        t_end: duration [s]; the scene's if not given.
        record_step: time between records [s]; the scene's if not given.
        start: "equilibrium", "ramp" or "rest"; the scene's if not given.
        fmu: "native", "python", "in-process" (the same kernels without FMU), or "auto": native
            FMUs if there is a C compiler, Python FMUs otherwise.
        replace_parts: FMU files by instance name; a housing is tested against the contract of
            housings first, and what it breaks becomes a note.
        values: variables to set, by `instance.variable`.
        reference: also solve the monolithic twin, and report the errors against it.
        progress: called with the simulated time reached and its end [s].

    Returns:
        The result; a run that ends early is an outcome of it, not an exception.

    Raises:
        HerringboneError: something about the input is wrong.
    """
    structure, folder = (system, Path.cwd()) if isinstance(system, System) else load_system(system)
    chosen = _with_options(load_scene(folder, scene), t_end, record_step, start, values)
    coupling = _algorithm(algorithm)
    if tolerance is not None and coupling is not None:
        coupling = with_tolerance(coupling, tolerance)
    make_grid(chosen.t_end, _TINY if step is None else step, chosen.record_step)
    replaced: list[str] = []
    for instance, file in (replace_parts or {}).items():
        if structure.part(instance).component == MODAL_HOUSING.name:
            replaced += replacement_notes(Path(file))
        structure = structure.with_fmu(instance, Path(file))
    structure, notes = started(structure, chosen)
    notes = (*notes, *replaced)
    if reference:
        refuse_foreign_parts(structure)
    fmu, why = choose_kind(fmu)
    notes = (*notes, *why)
    parts = open_parts(structure, fmu)
    try:
        if coupling is None:
            coupling, why = choose_algorithm(parts)
            coupling = coupling if tolerance is None else with_tolerance(coupling, tolerance)
            notes = (*notes, why)
        step = coupling.start_step if step is None else step
        if warning := _stability_warning(structure, coupling, step, slow):
            notes = (*notes, warning)
        grid = make_grid(chosen.t_end, step, step if reference else chosen.record_step)
        if record_step is not None and record_step < grid.step and not coupling.adaptive:
            notes = (*notes, f"record_step = {record_step:g} s: records are taken at communication "
                     f"points, every {grid.step:g} s; use a shorter step for more")  # fmt: skip
        recording = simulate(
            structure,
            parts,
            coupling,
            grid,
            progress,
            bond_frequency=fastest_bond(structure),
            slow=slow,
        )
    finally:
        for part in parts:
            part.close()
    result = make_result(structure, chosen, coupling, fmu, recording, notes)
    if _unstable(recording):
        result = replace(
            result, info=replace(result.info, why=diagnose(structure, coupling, recording.step))
        )
    if reference:
        result = with_error(result, structure)
        result = decimated(result, chosen.record_step)
    return result


def _unstable(recording: Recording) -> bool:
    """True if a run diverged, or its coupling was seen to add energy without end."""
    energy = recording.energy
    return recording.outcome.kind is OutcomeKind.DIVERGED or (
        energy is not None and energy.verdict is Verdict.UNSTABLE
    )


def _stability_warning(
    system: System, algorithm: Algorithm, step: float, slow: Mapping[str, int] | None
) -> str | None:
    """A line if the step is unstable; nothing is predicted with slow bodies.

    An adaptive step needs none: it finds the limit, and goes below.
    """
    if system.foreign_parts or algorithm.adaptive or slow:
        return None
    return warn_if_unstable(system, algorithm, step)


def _algorithm(algorithm: str | Algorithm | None) -> Algorithm | None:
    """The algorithm that was asked for; None for the automatic choice."""
    if algorithm is None or algorithm == AUTO:
        return None
    return parse_algorithm(algorithm) if isinstance(algorithm, str) else algorithm


def _with_options(
    scene: Scene,
    t_end: float | None,
    record_step: float | None,
    start: str | None,
    values: Mapping[str, float | str] | None,
) -> Scene:
    """The scene with what the caller overrides."""
    if start is not None and start not in list(Start):
        raise ParameterError(f"start = {start!r}; it must be one of {', '.join(Start)}")
    return replace(
        scene,
        t_end=scene.t_end if t_end is None else t_end,
        record_step=scene.record_step if record_step is None else record_step,
        start=scene.start if start is None else Start(start),
        values={**scene.values, **(values or {})},
    )


def open_parts(system: System, fmu: str) -> list[Part]:
    """Instantiate all parts and set their start values.

    Args:
        system: the parts.
        fmu: kind of the parts' FMUs, see `run`.

    Raises:
        HerringboneError: an FMU cannot be used, or a value is wrong.
    """
    kind, _ = choose_kind(fmu)
    wanted = {str(spec.component) for spec in system.parts if not spec.foreign}
    for name in wanted:
        component(name)
    files = _BUILDERS[kind](sorted(wanted)) if kind in _BUILDERS and wanted else {}
    parts: list[Part] = []
    try:
        for spec in system.parts:
            parts.append(_open_part(spec, files))
            for name, value in spec.values.items():
                parts[-1].set(name, value)
    except HerringboneError:
        for part in parts:
            part.close()
        raise
    return parts


def _open_part(spec: PartSpec, files: Mapping[str, Path]) -> Part:
    if spec.fmu is not None:
        return open_fmu(spec.name, spec.fmu)
    if str(spec.component) in files:
        return open_fmu(spec.name, files[str(spec.component)])
    return InProcessPart(Instance(component(str(spec.component)), spec.name))
