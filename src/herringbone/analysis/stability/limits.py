"""Stable macro steps of every algorithm, bonds, and what to choose: known before the run."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial

from herringbone.analysis.stability.bonds import Bond, bond_table, highest_frequency
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    Strangers,
    linear_network,
)
from herringbone.analysis.stability.recommendation import (
    CHARTED_MICRO_STEP,
    Ranking,
    Recommendation,
    rank,
)
from herringbone.analysis.stability.steps.clock_grid import clocks_of, common_steps
from herringbone.analysis.stability.steps.simulated_limit import nonlinear_limit
from herringbone.analysis.stability.steps.step_limits import (
    StepLimits,
    step_limits,
)
from herringbone.core import HerringboneError, Instance, ParameterError
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.facts import Facts
from herringbone.core.process.activity import activity
from herringbone.core.process.telling import Tell
from herringbone.cosim.algorithms import ALGORITHMS, Algorithm, Jacobi
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import check_tolerance

Remember = Callable[[Algorithm, bool, Callable[[], StepLimits]], StepLimits]
"""Limits of an algorithm, with those that runs show or without: known ones, or found by a call."""


@dataclass(frozen=True, repr=False)
class Stability(Facts):
    """What is known of a system's coupling before a run.

    Attributes:
        system, scene: names.
        limits: by algorithm.
        bonds: where bodies act on each other through an element.
        highest_frequency: of all bonds together [rad/s].
        tolerance: relative error for which the step is recommended.
        ranking: algorithms and steps for that, the best first.
        notes: algorithms that this system cannot have, and those that are not ranked.
        orders: of what stands for foreign parts, by name.
        fresh_instances: on how many of a foreign part it was tried, of those that save no state.
        left_out: foreign parts for which nothing stands: of the whole, nothing is promised.
    """

    system: str
    scene: str
    limits: tuple[StepLimits, ...]
    bonds: tuple[Bond, ...]
    highest_frequency: float
    tolerance: float
    ranking: Ranking
    notes: tuple[str, ...] = field(default=())
    orders: Mapping[str, int] = field(default_factory=dict)
    fresh_instances: Mapping[str, int] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()

    @property
    def recommended(self) -> Recommendation | None:
        """The best algorithm and step; None if none is ranked."""
        return self.ranking.best

    def __str__(self) -> str:
        from herringbone.analysis.stability.report import stability_text  # noqa: PLC0415 (of this)

        return stability_text(self)

    def _facts(self) -> dict[str, str]:
        best = self.recommended
        return {
            "system": self.system,
            "scene": self.scene,
            "recommended": f"{best.algorithm}, step {best.step:.3g} s" if best else "",
            "first unstable": ", ".join(f"{x.algorithm} {x.limit:.3g} s" for x in self.limits),
            "notes": "; ".join(self.notes),
        }


def default_algorithms() -> tuple[Algorithm, ...]:
    """Jacobi of all orders, and every other algorithm with its default options."""
    others = (kind() for name, kind in ALGORITHMS.items() if name != Jacobi.name)
    return (Jacobi(0), Jacobi(1), Jacobi(2), *others)


def stability(
    system: System,
    scene: str = "",
    algorithms: Sequence[Algorithm] | None = None,
    *,
    tolerance: float = 1e-3,
    simulate: bool = False,
    progress: Tell | None = None,
    strangers: Strangers = NO_STRANGERS,
    started: System | None = None,
    remember: Remember = lambda algorithm, simulated, find: find(),
) -> Stability:
    """Stable steps, bonds and a recommended algorithm and step.

    Args:
        system: at the start values of an equilibrium under load.
        scene: name, for the report.
        algorithms: all if not given.
        tolerance: relative error of bearing forces that is asked for.
        simulate: also find the limits of the non-linear system, by runs.
        progress: called after every matrix.
        strangers: what stands for foreign parts.
        started: the system as runs start, if that is not at the same angles.
        remember: knows limits that were found before.

    Raises:
        StructureError: nothing stands for a foreign part.
        ParameterError: a mesh is open at the start, or the tolerance is out of range.
    """
    check_tolerance(tolerance)
    network, members = linear_network(system, strangers=strangers)
    instances = [member for member in members if isinstance(member, Instance)]
    bonds = bond_table(network, members)
    highest = highest_frequency(network, members)
    limits, chosen, notes = [], [], []
    what = f"predicting the stable steps of {system.name}"
    runs = (started or system) if simulate else None
    for algorithm in algorithms or default_algorithms():
        try:
            with activity(f"{what} with {algorithm}", shown=progress is not None):
                find = partial(_found, system, algorithm, runs, progress, strangers)
                limits.append(remember(algorithm, simulate, find))
            chosen.append(algorithm)
        except ParameterError as error:
            notes.append(f"{algorithm}: {error}")
    by_limit = [(a, found.limit) for a, found in zip(chosen, limits, strict=True)]
    ranking = Ranking()
    if strangers:
        notes.append("algorithms are not ranked: the rule of accuracy knows no foreign parts")
    else:
        ranking = rank(by_limit, highest, tolerance, _micro_step(instances))
    notes += _on_a_grid(limits, strangers)
    notes += [f"{name} is not ranked: {why}" for name, why in ranking.unranked.items()]
    notes += _unfrozen(instances)
    return Stability(
        system.name,
        scene,
        tuple(limits),
        bonds,
        highest,
        tolerance,
        ranking,
        tuple(notes),
        {name: stranger.surrogate.order for name, stranger in strangers.items()},
        {
            name: stranger.surrogate.fresh_instances
            for name, stranger in strangers.items()
            if stranger.surrogate.fresh_instances
        },
    )


def _on_a_grid(limits: Sequence[StepLimits], strangers: Strangers) -> list[str]:
    """A line on which steps were looked at, if parts have clocks."""
    clocks, looked = clocks_of(strangers), max((found.steps for found in limits), default=0)
    if not clocks or not looked:
        return []
    known = ", ".join(f"{clock.name} every {clock.period:g} s" for clock in clocks)
    return [f"parts with clocks: {known}: {looked} steps that go with these were looked at"]


def _found(
    system: System,
    algorithm: Algorithm,
    runs: System | None,
    progress: Tell | None,
    strangers: Strangers,
) -> StepLimits:
    """Limits of a system's linear parts, and those of runs if it is given as these start."""
    limit = step_limits(system, algorithm, progress, strangers)
    if runs is None:
        return limit
    grid: list[float] = []
    if limit.steps:
        near = {step for step in (limit.below, limit.limit) if 0.0 < step < math.inf}
        grid = sorted({*common_steps(clocks_of(strangers), limit.largest), *near})
    seen = nonlinear_limit(runs, algorithm, limit.limit, limit.unstable_bands, strangers, grid)
    return replace(limit, simulated_limit=seen)


def _gear_pairs(instances: Sequence[Instance]) -> list[Instance]:
    return [i for i in instances if Role.GEAR_PAIR in i.component.declaration.roles]


def _micro_step(instances: Sequence[Instance]) -> float:
    """Longest micro step [s] of the gear pairs."""
    found = [
        gear[v.name]
        for gear in _gear_pairs(instances)
        for v in gear.component.declaration.offered(Quantity.MICRO_STEP)
    ]
    return max(found, default=CHARTED_MICRO_STEP)


def _unfrozen(instances: Sequence[Instance]) -> list[str]:
    """A line for each gear pair whose meshes cannot be frozen."""
    return [
        f"{gear.name}: {gear.component.name} does not say how its meshes are frozen; its limits "
        "hold at the phase of the start, for all three stiffnesses"
        for gear in _gear_pairs(instances)
        if gear.component.freeze is None
    ]


def fastest_bond(system: System) -> float | None:
    """Highest frequency of all bonds together [rad/s]; None if it cannot be told.

    That is so with foreign parts, without bonds, or with a mesh that is open at the start.
    """
    if system.foreign_parts:
        return None
    try:
        return highest_frequency(*linear_network(system)) or None
    except HerringboneError:
        return None
