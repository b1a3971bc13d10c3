"""A plan for what is asked of steady states."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from herringbone.analysis.leaner.question import Lines, Question, lines_of
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.fused.core import Steps, closeness
from herringbone.analysis.twin.fused.measured import DEGREES, LONGEST
from herringbone.core import ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.core.lean import WHOLE, Lean
from herringbone.scenes import Scene
from herringbone.scenes.asking import SHARE
from herringbone.studies.planning.certified import Certifier
from herringbone.studies.planning.estimated import Ladder, frozen_where_they_bend
from herringbone.studies.planning.marching import marched
from herringbone.studies.planning.points import points_to_probe, points_to_test
from herringbone.studies.planning.rung import FUSED, STEADY, Rung

_TRIED = 3
"""Rungs that are solved at most."""
_TRIAL = 5e-3
"""Length of a run of which the cost is measured [s]."""
_ALIKE = 1.1
"""Cost over the least that is no difference, of one turn."""
_WORTH = 0.95
"""Cost over that of the whole model below which leaving something out is worth it."""


def steady_rungs(
    solver: SteadySolver,
    questions: Sequence[Question],
    scene: Scene,
    by_hand: Lean,
    *,
    for_fmu: bool = False,
    estimated: Callable[[Sequence[Rung]], None] | None = None,
) -> tuple[list[Rung], Certifier, list[str]]:
    """The ladder with its choice, what it was certified with, and what is to be said.

    Args:
        solver: of the whole model, fine enough to compare models.
        questions: what is asked.
        scene: that asks.
        by_hand: a leaner model that the user gave.
        for_fmu: an FMU is wanted: what leaves out most is chosen, and states alone.
        estimated: called with the rungs before any leaner model is solved.

    Raises:
        ParameterError: there is no steady state where it is asked for.
    """
    states: list[SteadyState] = []
    for point in points_to_probe(scene.operating):
        states.append(_steady(solver, point, states[-1] if states else None))
    ladder = Ladder(solver, states, questions)
    rungs = list(ladder.rungs(for_fmu=for_fmu))
    long = any(state.meshes > 1 for state in states)
    certifier = Certifier(solver, questions, points_to_test(scene.operating, long=long), SHARE)
    if by_hand:
        rungs.append(ladder.by_hand(by_hand))
    if estimated:
        estimated(rungs)
    hand = rungs[-1] if by_hand else None
    may = [
        rung
        for rung in rungs
        if ladder.allowed(rung) and not frozen_where_they_bend(rung.lean, certifier.states)
    ]
    tried = _leanest(may) if for_fmu else _cheapest(certifier, may)
    certified = {
        id(rung): replace(rung, measured=certifier.error(rung.lean))
        for rung in (*tried, *([hand] if hand and hand not in tried else []))
    }
    rungs = [certified.get(id(rung), rung) for rung in rungs]
    whole = Rung("whole model", STEADY)
    good = [rung for rung in rungs if rung.measured and rung.measured.ratio <= SHARE]
    costs = certifier.costs([WHOLE, *(rung.lean for rung in good)])
    cost_of = {id(rung): cost for rung, cost in zip(good, costs[1:], strict=True)}
    every = [replace(whole, cost=costs[0])]
    every += [_run(solver, questions, scene)]
    every += [replace(rung, cost=cost_of.get(id(rung))) for rung in rungs]
    chosen = chosen_of(every, leanest=for_fmu)
    return chosen, certifier, _remarks(questions, states)


def _leanest(rungs: Sequence[Rung]) -> list[Rung]:
    """Those that leave out most."""
    return sorted(rungs, key=lambda rung: -len(rung.lean.hold))[:_TRIED]


def _cheapest(certifier: Certifier, rungs: Sequence[Rung]) -> list[Rung]:
    """Those whose answers cost least, by one turn; of equal ones those that leave out most.

    One that leaves out less than another of them is not priced: it would save less.
    """
    if len(rungs) <= _TRIED:
        return list(rungs)
    leanest = [
        rung
        for rung in rungs
        if not any(rung.lean != other.lean and other.lean >= rung.lean for other in rungs)
    ]
    if len(leanest) >= _TRIED:
        rungs = leanest
    costs = certifier.costs([rung.lean for rung in rungs], rounds=1, most=_TRIED)
    least = min(costs)
    order = sorted(
        range(len(rungs)), key=lambda k: (costs[k] > _ALIKE * least, -len(rungs[k].lean.hold))
    )
    return [rungs[k] for k in order[:_TRIED]]


def _run(solver: SteadySolver, questions: Sequence[Question], scene: Scene) -> Rung:
    """What a run of the core costs that waits until all has settled, by its first part."""
    columns = tuple(dict.fromkeys(c for q in questions for c in q.columns))
    steps = Steps(LONGEST, DEGREES[0], closeness(min(q.tolerance for q in questions)))
    trial = min(_TRIAL, scene.t_end)
    core, record = solver.structure.core, min(scene.record_step, trial)
    spent = [marched(core, trial, record, steps, columns).seconds for _ in range(2)]
    cost = min(spent) * scene.t_end / trial  # the first one may compile
    name = f"whole model, a run of {scene.t_end:g} s to settle"
    why = f"not known to settle in {scene.t_end:g} s"
    return Rung(name, FUSED, cost=cost, step=steps.length, why=why)


def chosen_of(rungs: Sequence[Rung], *, leanest: bool) -> list[Rung]:
    """The rungs, the whole model first, each with why it is not the choice; a run is never it."""
    priced = [rung for rung in rungs if rung.cost is not None and rung.solver == STEADY]
    whole = rungs[0]
    if leanest:
        leaner = max(priced, key=lambda rung: len(rung.lean.hold))
        return [replace(rung, why=_why(rung, leaner, "more is in it")) for rung in rungs]
    cheapest = min(priced, key=lambda rung: rung.cost or 0.0)
    if (cheapest.cost or 0.0) > _WORTH * (whole.cost or 0.0):
        cheapest = whole
    return [replace(rung, why=_why(rung, cheapest)) for rung in rungs]


def _why(rung: Rung, choice: Rung, dearer: str = "dearer") -> str:
    if rung is choice:
        return ""
    if rung.solver == FUSED:
        return dearer if (rung.cost or 0.0) > (choice.cost or 0.0) else rung.why
    if rung.cost is not None:
        return "no cheaper" if choice.whole else dearer
    if rung.measured is not None and rung.measured.ratio > SHARE:
        return "its measured error is above half of the tolerance"
    return rung.why or "not tried: others cost less or leave out more"


def _steady(solver: SteadySolver, point, near: SteadyState | None) -> SteadyState:  # noqa: ANN001
    found = solver.solve(point, near)
    if not found.converged:
        raise ParameterError(
            f"plan: {solver.structure.system.name} has no steady state that was found at "
            f"{found.speed * R_MIN:.5g} r/min; narrow the range, or ask for a transient"
        )
    return found


def _remarks(questions: Sequence[Question], states: Sequence[SteadyState]) -> list[str]:
    """Bands that end below what is largest, and contacts that are left."""
    found = []
    for question in questions:
        for state in states:
            lines: Lines = lines_of(state, question)
            if lines.highest > question.band:
                found.append(
                    f"{question.name}: the largest line, at {lines.highest:.5g} Hz, lies beyond "
                    "the band"
                )
                break
    for state in states:
        if state.bends:
            where = f"{state.speed * R_MIN:.5g} r/min"
            found.append(f"laws bend at {where}: {', '.join(state.bends)}")
            break
    return found
