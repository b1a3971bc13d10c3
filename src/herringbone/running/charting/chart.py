"""What a speed-accuracy chart shows: runs of algorithms up a ladder of steps, and their errors."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import NamedTuple

from herringbone.analysis.accuracy.converged import Converged
from herringbone.analysis.accuracy.step_ladder import (
    STEPS,
    OpenParts,
    Progress,
    Reference,
    charted_algorithms,
    ladder,
    left_out,
    run_points,
)
from herringbone.analysis.accuracy.work_precision import WorkPrecision
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.given import check_called
from herringbone.core.part import Part
from herringbone.core.wording import option
from herringbone.cosim.algorithms import AUTO, LI, Algorithm, parse_algorithm, refuse_adaptive
from herringbone.cosim.cell.policy import foreign_fmus_housed
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.structure.system import System
from herringbone.fmi.kind import AUTO as AUTO_FMU
from herringbone.fmi.kind import choose_kind
from herringbone.running.charting.fused_curves import fused_points
from herringbone.running.charting.kept_points import Kept, Noted, kept_points
from herringbone.running.foreign.foreign_parts import alike, understood
from herringbone.running.fused.fused import refuse_strangers
from herringbone.running.loading import instances, open_parts
from herringbone.running.operating.commanded import operated
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Scene

_SET_UP = (
    "fused: each run makes the matrices of its steps first, some milliseconds of CPU time that "
    "show in short runs"
)


def chart(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    speed: float | None = None,
    torque: float | None = None,
    algorithms: Sequence[str | Algorithm] = (),
    steps: Sequence[float] = STEPS,
    tolerances: Sequence[float] = (),
    t_end: float | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    replace_parts: Mapping[str, str | Path] | None = None,
    fmu: str = AUTO_FMU,
    fuse: bool = False,
    in_process: bool | None = None,
    call_deadline: float | None = None,
    longest_trial: int | None = None,
    most_trial_steps: int | None = None,
    progress: bool | Progress = False,
) -> WorkPrecision:
    """Run algorithms up a ladder of steps, against the monolithic twin.

    Args:
        system: name of a shipped system, folder with system.toml, .ssp file, or a System.
        scene: name or file of a scene; the system's "loaded" if not given.
        speed, torque: set points at the pinion [rad/s], [N m], as in `herringbone.run`.
        algorithms: such as "jacobi:order=2" or `Jacobi(order=2)`; all, in the variants worth
            showing, if none is given.
        steps: communication step sizes [s].
        tolerances: relative errors for which li adapts its step, one more curve; none if not given.
        t_end: duration of each run [s]; the scene's if not given.
        values, gear, housing, replace_parts: as in `herringbone.run`.
        fmu: kind of the parts' FMUs, as in `herringbone.run`.
        fuse: curves of the fused system, too; its steps are the base steps of the core.
        in_process, call_deadline, longest_trial, most_trial_steps: of foreign FMUs, as in
            `herringbone.run`.
        progress: True for a count of runs; or called before each with algorithm and step [s].

    Returns:
        Errors and costs of all runs; `plot()` draws them.

    Raises:
        HerringboneError: something about the input is wrong.
        KeyboardInterrupt: before there is any point; later the points so far are returned.
    """
    check_called("progress", progress)
    with (
        foreign_fmus_housed(in_process, call_deadline, longest_trial, most_trial_steps) as remarks,
        _counted(progress) as counted,
    ):
        wishes = Wishes(
            t_end=t_end, values=values or {}, gear=gear, housing=housing,
            replace_parts=replace_parts or {},
        )  # fmt: skip
        curves = _curves(algorithms, tolerances)
        wishes = operated(system, scene, wishes, speed, torque)
        structure, options, notes = prepared(system, scene, wishes)
        fmu, why = choose_kind(fmu)
        grids = ladder(steps, options.t_end)
        if tuple(steps) != STEPS:
            notes = (*notes, *left_out(steps, options.t_end))
        if structure.foreign_parts and tolerances:
            raise ParameterError(
                "tolerances: with foreign FMUs a curve is drawn over fixed steps only"
            )
        if fuse:
            refuse_strangers(structure)
        shown = _Shown(structure, curves, grids, counted)
        opened = _Opened(structure, fmu, grids[0].step)
        found = (
            _beside_finer(shown, opened)
            if structure.foreign_parts
            else _beside_twin(shown, opened, fuse=fuse)
        )
        told = list(map(str, remarks))
    points, stopped = found.kept
    said = (*notes, *why, *found.notes)
    return WorkPrecision(
        structure.name,
        options.name,
        options.t_end,
        fmu,
        found.modes,
        found.micro_step,
        tuple(point for point, _ in points),
        tuple(filter(None, dict.fromkeys([*said, *said_once(points), *told, stopped]))),
        bool(structure.foreign_parts),
        interrupted=bool(stopped),
    )


@contextmanager
def _counted(progress: bool | Progress) -> Iterator[Progress]:
    """What is called before each run: shows the count of runs for True, nothing for False."""
    if not isinstance(progress, bool):
        yield progress
        return
    from tqdm import tqdm  # noqa: PLC0415 (many callers show none)

    with tqdm(unit=" runs", disable=not progress, bar_format="{n} runs [{elapsed}] {desc}") as bar:

        def show(algorithm: str, step: float) -> None:
            bar.set_description_str(f"{algorithm} at {step * 1e6:.4g} us", refresh=False)
            bar.update()

        yield show


class _Shown(NamedTuple):
    """What is run for a chart."""

    system: System
    algorithms: Sequence[Algorithm]
    grids: Sequence[Grid]
    progress: Progress


class _Measured(NamedTuple):
    """Points with notes on them, what the parts themselves resolve, and notes on the reference."""

    kept: Kept
    modes: int = 0
    micro_step: float = 0.0
    notes: tuple[str, ...] = ()


def _beside_finer(shown: _Shown, opened: OpenParts) -> _Measured:
    """Errors against the same parts at shorter steps: foreign ones have no twin."""
    system, algorithms, grids, progress = shown
    finer = Converged(system, opened, grids)
    found = kept_points(run_points(system, opened, finer, algorithms, grids, progress))
    return _Measured(found, notes=(finer.note,))


def _beside_twin(shown: _Shown, opened: OpenParts, *, fuse: bool) -> _Measured:
    system, algorithms, grids, progress = shown
    twin = Reference(system, grids)
    coupled = run_points(system, opened, twin, algorithms, grids, progress)
    cores = fused_points(system, twin, grids, progress) if fuse else ()
    found = kept_points(chain(coupled, ((point, (_SET_UP,)) for point in cores)))
    return _Measured(found, *_internals(twin.twin))


def said_once(found: Sequence[Noted]) -> Iterator[str]:
    """Notes on runs, without the algorithm where those of all algorithms have the same one."""
    by_text: dict[str, list[str]] = {}
    for point, notes in found:
        for note in notes:
            by_text.setdefault(note.removeprefix(f"{point.algorithm}: "), []).append(note)
    algorithms = {point.algorithm for point, _ in found}
    for text, notes in by_text.items():
        different = dict.fromkeys(notes)
        yield from [text] if len(different) == len(algorithms) else different


def _curves(algorithms: Sequence[str | Algorithm], tolerances: Sequence[float]) -> list[Algorithm]:
    """One algorithm for each curve: those named, or all worth showing, and li by tolerance."""
    if AUTO in algorithms:
        raise ParameterError(
            f"{AUTO} is a choice among the algorithms that a chart compares; leave it out"
        )
    named = dict.fromkeys(parse_algorithm(str(algorithm)) for algorithm in algorithms)
    chosen = list(named) or list(charted_algorithms())
    if 0.0 in tolerances:
        raise ParameterError("tolerances: 0 keeps the step; name li among the algorithms for that")
    refuse_adaptive(chosen, f"a curve is drawn over steps or over {option('tolerances')}")
    return [*chosen, *(LI(tolerance=tolerance) for tolerance in sorted(tolerances))]


class _Opened:
    """Opens a system's parts again for each run; foreign ones are tried once.

    Args:
        system: structure with start values.
        fmu: kind of the parts' FMUs.
        step: macro step [s] of the trials.
    """

    def __init__(self, system: System, fmu: str, step: float) -> None:
        self._system, self._fmu, self._step = system, fmu, step
        self._first: list[Part] = []

    def __call__(self) -> list[Part]:
        """Its parts, as the coupling takes them."""
        parts = open_parts(self._system, self._fmu)
        if not self._first:
            self._first = understood(self._system, parts, instances, self._step)[0]
            return list(self._first)
        return [
            alike(first, part) if spec.foreign else part
            for spec, first, part in zip(self._system.parts, self._first, parts, strict=True)
        ]


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
