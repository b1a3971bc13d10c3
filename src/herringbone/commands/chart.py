"""The speed-accuracy chart of a system's scene: runs, table, picture, files."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tqdm import tqdm

from herringbone.analysis.accuracy.converged import Converged
from herringbone.analysis.accuracy.step_ladder import (
    STEPS,
    OpenParts,
    Progress,
    Reference,
    charted_algorithms,
    ladder,
    run_points,
)
from herringbone.analysis.accuracy.work_precision import MARKS, Reach, WorkPrecision
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import HerringboneError, OutcomeKind, ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.part import Part
from herringbone.core.places.files import write_whole
from herringbone.cosim.algorithms import AUTO, LI, parse_algorithm, refuse_adaptive
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.structure.system import System
from herringbone.fmi.kind import AUTO as AUTO_FMU
from herringbone.fmi.kind import choose_kind
from herringbone.running.foreign.foreign_parts import alike, understood
from herringbone.running.fused.charted import fused_points
from herringbone.running.fused.fused import refuse_strangers
from herringbone.running.loading import instances, open_parts
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared

LEVELS = (1e-2, 1e-3)
"""Errors at which steps are compared [1]."""
_FILES = ("chart.csv", "chart.json", "chart.png")


def measure(
    system: str | Path,
    *,
    scene: str | None = None,
    algorithms: Sequence[str] = (),
    steps: Sequence[float] = STEPS,
    tolerances: Sequence[float] = (),
    t_end: float | None = None,
    values: Mapping[str, float | str] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    replace_parts: Mapping[str, str | Path] | None = None,
    fmu: str = AUTO_FMU,
    fuse: bool = False,
    progress: Progress = lambda algorithm, step: None,
) -> WorkPrecision:
    """Run algorithms up a ladder of steps, against the monolithic twin.

    Args:
        system: name of a shipped system, folder with system.toml, or .ssp file.
        scene: name or file of a scene; the system's "loaded" if not given.
        algorithms: such as "jacobi:order=2"; all, in the variants worth showing, if none is given.
        steps: communication step sizes [s].
        tolerances: relative errors for which li adapts its step, one more curve; none if not given.
        t_end: duration of each run [s]; the scene's if not given.
        values, gear, housing, replace_parts: as in `herringbone.run`.
        fmu: kind of the parts' FMUs, as in `herringbone.run`.
        fuse: curves of the fused system, too; its steps are the base steps of the core.
        progress: called before each run with the algorithm and the step [s].

    Raises:
        HerringboneError: something about the input is wrong.
    """
    if AUTO in algorithms:
        raise ParameterError(
            f"{AUTO} is a choice among the algorithms that a chart compares; leave it out"
        )
    chosen = list(dict.fromkeys(map(parse_algorithm, algorithms))) or charted_algorithms()
    if 0.0 in tolerances:
        raise ParameterError("tolerances: 0 keeps the step; name li among the algorithms for that")
    refuse_adaptive(chosen, "a curve is drawn over steps or over --tolerances")
    chosen = [*chosen, *(LI(tolerance=tolerance) for tolerance in sorted(tolerances))]
    wishes = Wishes(
        t_end=t_end,
        values=values or {},
        gear=gear,
        housing=housing,
        replace_parts=replace_parts or {},
    )
    structure, options, notes = prepared(system, scene, wishes)
    fmu, why = choose_kind(fmu)
    notes = (*notes, *why)
    grids = ladder(steps, options.t_end)
    if structure.foreign_parts and tolerances:
        raise ParameterError("tolerances: with foreign FMUs a curve is drawn over fixed steps only")

    known: list[Part] = []

    def opened() -> list[Part]:
        parts = open_parts(structure, fmu)
        if known:
            return [
                alike(first, part) if spec.foreign else part
                for spec, first, part in zip(structure.parts, known, parts, strict=True)
            ]
        known.extend(understood(structure, parts, instances, grids[0].step)[0])
        return list(known)

    reference = _reference(structure, opened, grids)
    found = list(run_points(structure, opened, reference, chosen, grids, progress))
    if fuse:
        refuse_strangers(structure)
    if fuse and isinstance(reference, Reference):
        found += [(p, ()) for p in fused_points(structure, reference, grids, progress)]
    modes, micro_step = 0, 0.0
    if isinstance(reference, Reference):
        modes, micro_step = _internals(reference.twin)
    else:
        notes = (*notes, reference.note)
    return WorkPrecision(
        structure.name,
        options.name,
        options.t_end,
        fmu,
        modes,
        micro_step,
        tuple(point for point, _ in found),
        tuple(dict.fromkeys([*notes, *(note for _, own in found for note in own)])),
        bool(structure.foreign_parts),
    )


def _reference(system: System, opened: OpenParts, grids: Sequence[Grid]) -> Reference | Converged:
    """The twin, or finer runs where there is none."""
    if system.foreign_parts:
        return Converged(system, opened, grids)
    return Reference(system, grids)


def _internals(twin: Twin) -> tuple[int, float]:
    """Modes of the housing, and shortest micro step [s] of the parts."""
    modes, micro_steps = 0, []
    for instance in twin.instances:
        declaration = instance.component.declaration
        if Role.HOUSING in declaration.roles:
            counts = {declaration.first_table + v.length for v in declaration.vectors if v.text}
            modes += sum(int(instance.block[count]) for count in counts)
        micro_steps += [instance[v.name] for v in declaration.offered(Quantity.MICRO_STEP)]
    return modes, min(micro_steps, default=0.0)


def chart(
    system: str,
    folder: Path | None,
    *,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> tuple[str, OutcomeKind]:
    """Measure, write chart.csv, chart.json and chart.png, and say what came out.

    Args:
        system: see `measure`.
        folder: for the files; results/chart-SYSTEM-SCENE if not given.
        as_json: one JSON object in place of a table.
        options: see `measure`.

    Returns:
        What to show, and "interrupted" or "completed".

    Raises:
        HerringboneError: something about the input is wrong, or files cannot be written.
    """
    with tqdm(unit=" runs", disable=None, bar_format="{n} runs [{elapsed}] {desc}") as bar:

        def show(algorithm: str, step: float) -> None:
            bar.set_description_str(f"{algorithm} at {step * 1e6:.4g} us", refresh=False)
            bar.update()

        found = measure(system, progress=show, **options)
    scene = Path(found.scene).stem
    files = _write(found, folder or Path("results") / f"chart-{found.system}-{scene}")
    interrupted = any(p.outcome == OutcomeKind.INTERRUPTED for p in found.points)
    kind = OutcomeKind.INTERRUPTED if interrupted else OutcomeKind.COMPLETED
    text = json.dumps({**found.summary(), "results": files}) if as_json else table(found, files)
    return text, kind


def _write(found: WorkPrecision, folder: Path) -> list[str]:
    from herringbone.plotting.work_precision import write_chart  # noqa: PLC0415 (lazy)

    files = [folder / name for name in _FILES]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        found.to_csv(files[0])
        write_whole(files[1], json.dumps(found.summary(), indent=1) + "\n")
        write_chart(found, files[2])
    except OSError as error:
        raise HerringboneError(
            f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        ) from error
    return [str(file) for file in files]


def table(found: WorkPrecision, files: Sequence[str]) -> str:
    """Steps and passes by algorithm at the levels of error, for people."""
    wide = max(map(len, found.algorithms)) + 2
    lines = [
        f"{found.system}, {found.scene}, {1e3 * found.t_end:g} ms, {found.fmu} parts: largest step "
        "with an error up to",
        " " * wide + "".join(f"{f'{100 * level:g} %':^26}" for level in LEVELS).rstrip(),
        " " * wide + f"{'step [us]':>12}{'passes/ms':>11}   " * len(LEVELS),
    ]
    for algorithm in found.algorithms:
        reached = [found.reach(algorithm, level) for level in LEVELS]
        lines.append(f"{algorithm:<{wide}}" + "".join(map(_cells, reached)))
    lines += ["; ".join(f"{mark} {meaning}" for mark, meaning in MARKS.items()), ""]
    lines += [*found.notes, "Files: " + ", ".join(files)]
    return "\n".join(line.rstrip() for line in lines)


def _cells(reach: Reach | None) -> str:
    if reach is None:
        return f"{'-':>12}{'-':>11}   "
    return f"{f'{reach.mark}{reach.step * 1e6:.1f}':>12}{reach.passes_per_ms:>11.0f}   "
