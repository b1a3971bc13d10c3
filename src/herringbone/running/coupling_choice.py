"""How a prepared system is coupled: what is asked, and what is chosen where nothing is."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from herringbone.analysis.stability.instability import warn_if_unstable
from herringbone.analysis.stability.steps.clock_grid import clocks_of
from herringbone.core import HerringboneError
from herringbone.core.part import Part
from herringbone.core.process.activity import activity
from herringbone.core.wording import option
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi, choose_algorithm, start_step
from herringbone.cosim.cell.policy import policy
from herringbone.cosim.layouts.inner_stepping import NO_INNER, InnerStepping
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System
from herringbone.cosim.structure.unfed import unfed
from herringbone.result.budget import BudgetRow
from herringbone.running.foreign.foreign_parts import understood
from herringbone.running.foreign.linear_start import turned_back, under_load
from herringbone.running.foreign.speeding_up import speeding_up
from herringbone.running.foreign.started import declared_steps
from herringbone.running.foreign.surrogates import surrogates_of
from herringbone.running.loading import instances
from herringbone.running.remembered_answers import bond_of, stability_warning
from herringbone.running.steps.suited_step import suited_step
from herringbone.scenes import Scene


@dataclass(frozen=True)
class Asked:
    """What is asked of the coupling; None: chosen by what the parts are.

    Attributes:
        algorithm: of the coupling.
        step: macro step [s].
        tolerance: relative error of the run.
        slow: bodies that step once in several macro steps.
        fmu: kind of the parts' FMUs.
        probe: find out what foreign FMUs are.
        record_step: that the caller gave [s].
        all_points: keep all communication points beside the result.
        warn: say whether the step is stable.
        notes: lines that are known already.
        inner: steps of the own parts, of which an adaptive step takes account.
        part_tolerance: that parts are told; None: none.
        fuse: condense all parts of this package into one, which is coupled with the others.
        record: of a fused run, patterns of outputs, or groups of channels, that are recorded.
        core_step: longest base step of the condensed parts [s].
        judge: make the error budget, and lines on what does not fit together; False for runs that
            only tell the error of another.
        left_out: row of the error budget, of what the model leaves out.
        by_default: the tolerance is the default one, as nothing was said.
    """

    fmu: str
    algorithm: Algorithm | None = None
    step: float | None = None
    tolerance: float | None = None
    slow: Mapping[str, int] | None = None
    probe: bool = True
    record_step: float | None = None
    all_points: bool = False
    warn: bool = True
    notes: Sequence[str] = field(default=())
    inner: InnerStepping = NO_INNER
    part_tolerance: float | None = None
    fuse: bool = False
    record: tuple[str, ...] = ()
    core_step: float | None = None
    judge: bool = True
    left_out: BudgetRow | None = None
    by_default: bool = False


class Way(NamedTuple):
    """How parts are coupled.

    Attributes:
        parts: as the coupling takes them.
        algorithm: of the coupling.
        step: macro step [s].
        wanted: macro step that was asked for, or follows from the records [s]; None: chosen.
        bond: highest frequency of all bonds together [rad/s]; None if it is not known.
        lacks: lines on parts that are not connected, or in part; most others follow from them.
        lines: on what was chosen, and what is known of it.
    """

    parts: Sequence[Part]
    algorithm: Algorithm
    step: float
    wanted: float | None
    bond: float | None
    lacks: list[str]
    lines: list[str]


def way_of(
    system: System, scene: Scene, asked: Asked, exchanging: System, opened: Sequence[Part]
) -> Way:
    """Understand the parts, and choose what was not asked for.

    Args:
        system: with all values.
        scene: with duration and record step.
        asked: of the coupling.
        exchanging: the system as it is coupled, of the opened parts.
        opened: its parts, instantiated.

    Raises:
        HerringboneError: a part cannot be used.
    """
    parts, algorithm, wanted, lines = opened, asked.algorithm, asked.step, []
    if not system.connections and algorithm is None:
        wanted = asked.step or min(scene.record_step, scene.t_end)
        algorithm = Jacobi(order=0)
        lines.append(f"auto: {algorithm}, once per record, because nothing is connected")
    elif asked.probe and system.connections:
        trial = asked.step or (algorithm or LI()).start_step
        parts, found = understood(exchanging, opened, instances, trial)
        lines += found
    joined = bool(system.connections)
    lacks = unfed(exchanging, build_network(exchanging, parts)) if joined else []
    if algorithm is None:
        algorithm, why = choose_algorithm(parts, wanted)
        lines.append(why)
    bond = bond_of(system)
    own = start_step(algorithm, parts)
    step = wanted or suited_step(system, scene, algorithm, own, bond, asked.record_step)
    if wanted is None and step > own:
        lines.append(
            f"auto: steps of {step:.3g} s, because no bond is faster than {bond:.3g} rad/s"
        )
    lines += _other_lengths(system, parts, step)
    if asked.warn:
        lines += _stability_notes(system, parts, algorithm, step, scene.t_end, asked)
    return Way(parts, algorithm, step, wanted, bond, lacks, lines)


def _other_lengths(system: System, parts: Sequence[Part], step: float) -> Iterator[str]:
    """A line for each foreign part whose declared steps do not fit that of the run."""
    for part in parts:
        fmu = next((p.fmu for p in system.parts if p.name == part.name and p.foreign), None)
        if not fmu:
            continue
        proposed, inner, _ = declared_steps(fmu)
        if part.one_step and proposed and not math.isclose(proposed, step):
            yield (
                f"{part.name} takes steps of one length only, and proposes {proposed:g} s: if it "
                f"refuses {step:g} s, use {option('step', proposed)}"
            )
        elif inner and not math.isclose(step, inner * round(step / inner)):
            fitting = inner * max(round(step / inner), 1)
            yield (
                f"{part.name} takes inner steps of {inner:g} s, of which {step:g} s is no whole "
                f"number: its outputs may be those of another time; {option('step', fitting)} fits"
            )


def _stability_notes(
    system: System,
    parts: Sequence[Part],
    algorithm: Algorithm,
    step: float,
    t_end: float,
    asked: Asked,
) -> list[str]:
    """A line if the step is unstable; nothing is predicted with slow bodies, or without trials.

    An adaptive step needs none: it finds the limit, and goes below.
    """
    known = not system.foreign_parts or (asked.probe and system.connections)
    if algorithm.adaptive or asked.slow or not known:
        return []
    if asked.fuse:
        return ["whether the step is stable is not known: that of fused parts is not predicted"]

    def predicted() -> str | None:
        if system.foreign_parts:
            return _with_surrogates(system, parts, algorithm, step, t_end)
        return warn_if_unstable(under_load(system), algorithm, step, t_end)

    try:
        with activity(f"predicting whether {system.name} is stable"):
            warning = stability_warning(system, algorithm, step, t_end, predicted)
    except _UnknownError as error:
        return [f"whether the step is stable is not known: {error}"]
    return [warning] if warning else []


class _UnknownError(HerringboneError):
    """Nothing is known of the stability of a run; says why."""


def _with_surrogates(
    system: System, parts: Sequence[Part], algorithm: Algorithm, step: float, t_end: float
) -> str | None:
    """See `warn_if_unstable`, of a system with foreign parts; raises _UnknownError."""
    with surrogates_of(system, parts, step) as found:
        if found.missing:
            raise _UnknownError(found.why)
        for clock in clocks_of(found.strangers):
            try:
                clock.parts_of_period(step)
            except HerringboneError as error:
                raise _UnknownError(str(error)) from error
        loaded = speeding_up(turned_back(under_load(system)), found.strangers)
        warning = warn_if_unstable(
            loaded, algorithm, step, t_end, strangers=found.strangers, start=system
        )
    if not warning and (ended := policy().trials_ended):
        raise _UnknownError(f"no more trials of {', '.join(ended)} are made")
    return warning
