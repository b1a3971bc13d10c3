"""Stable macro steps of every algorithm, known before the run.

The spectral radius of the amplification matrix is scanned over the step, at minimum, mean and
maximum mesh stiffness. Not covered: teeth that separate, and parametric excitation by the mesh.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np

from herringbone.analysis.stability.amplification import GROWTH, Amplification, Growth
from herringbone.analysis.stability.bonds import Bond, bond_table, highest_frequency
from herringbone.analysis.stability.linear_parts import MeshStiffness, linear_network
from herringbone.analysis.stability.recommendation import (
    CHARTED_MICRO_STEP,
    Ranking,
    Recommendation,
    rank,
)
from herringbone.analysis.stability.simulated_limit import nonlinear_limit
from herringbone.analysis.stability.step_scan import GrowthOf, first_unstable_near, unstable_bands
from herringbone.components.registry import component
from herringbone.core import HerringboneError, Instance, ParameterError
from herringbone.core.activity import activity
from herringbone.core.roles import Quantity, Role
from herringbone.cosim.algorithms import ALGORITHMS, Algorithm, Jacobi
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import check_tolerance

Progress = Callable[[str], None]
"""Called after every matrix, with the name of the algorithm."""
_BEYOND = 1.01


@dataclass(frozen=True)
class StepLimits:
    """Unstable macro steps of one algorithm.

    Attributes:
        algorithm: what it is called on the command line.
        unstable_bands: at mean mesh stiffness, (from, to) [s]; `to` is infinite if everything
            that was examined above `from` is unstable, and finite for the last band, too, if
            steps are stable again up to where the scan ended.
        mesh_stiffness: first unstable step [s] at minimum, mean and maximum; infinite if none.
        frequency: of the motion that grows at the mean's limit [Hz].
        simulated_limit: first step [s] at which runs of the non-linear system are unstable; None
            if none was looked for, or if none is from half to twice the predicted limit.
    """

    algorithm: str
    unstable_bands: tuple[tuple[float, float], ...]
    mesh_stiffness: Mapping[str, float]
    frequency: float = np.nan
    simulated_limit: float | None = None

    @property
    def limit(self) -> float:
        """Step [s] below which everything examined is stable, at all stiffnesses."""
        return min(self.mesh_stiffness.values())


@dataclass(frozen=True)
class Stability:
    """What is known of a system's coupling before a run.

    Attributes:
        system, scene: names.
        limits: by algorithm.
        bonds: where bodies act on each other through an element.
        highest_frequency: of all bonds together [rad/s].
        tolerance: relative error for which the step is recommended.
        ranking: algorithms and steps for that, the best first.
        notes: algorithms that this system cannot have, and those that are not ranked.
    """

    system: str
    scene: str
    limits: tuple[StepLimits, ...]
    bonds: tuple[Bond, ...]
    highest_frequency: float
    tolerance: float
    ranking: Ranking
    notes: tuple[str, ...] = field(default=())

    @property
    def recommended(self) -> Recommendation | None:
        """The best algorithm and step; None if none is ranked."""
        return self.ranking.best


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
    progress: Progress | None = None,
) -> Stability:
    """Stable steps, bonds and a recommended algorithm and step.

    Args:
        system: of components of this package, at the start values of an equilibrium under load.
        scene: name, for the report.
        algorithms: all if not given.
        tolerance: relative error of bearing forces that is asked for.
        simulate: also find the limits of the non-linear system, by runs.
        progress: called after every matrix.

    Raises:
        StructureError: a part is a foreign FMU.
        ParameterError: a mesh is open at the start, or the tolerance is out of range.
    """
    check_tolerance(tolerance)
    network, instances = linear_network(system)
    bonds = bond_table(network, instances)
    highest = highest_frequency(network, instances)
    limits, chosen, notes = [], [], []
    what = f"predicting the stable steps of {system.name}"
    for algorithm in algorithms or default_algorithms():
        try:
            with activity(f"{what} with {algorithm}", shown=progress is not None):
                limit = step_limits(system, algorithm, progress)
                if simulate:
                    seen = nonlinear_limit(system, algorithm, limit.limit, limit.unstable_bands)
                    limit = replace(limit, simulated_limit=seen)
            limits.append(limit)
            chosen.append(algorithm)
        except ParameterError as error:
            notes.append(f"{algorithm}: {error}")
    by_limit = [(a, found.limit) for a, found in zip(chosen, limits, strict=True)]
    ranking = rank(by_limit, highest, tolerance, _micro_step(instances))
    notes += [f"{name} is not ranked: {why}" for name, why in ranking.unranked.items()]
    notes += _unfrozen(instances)
    return Stability(
        system.name, scene, tuple(limits), bonds, highest, tolerance, ranking, tuple(notes)
    )


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


def step_limits(
    system: System, algorithm: Algorithm, progress: Progress | None = None
) -> StepLimits:
    """Unstable steps of an algorithm at mean mesh stiffness, and its limit at all stiffnesses."""

    def growth_at(stiffness: MeshStiffness) -> GrowthOf:
        amplification = Amplification(*linear_network(system, stiffness), algorithm)

        @cache
        def growth(step: float) -> Growth:
            if progress:
                progress(str(algorithm))
            return amplification.growth(step)

        return growth

    growth = growth_at(MeshStiffness.MEAN)
    bands = unstable_bands(growth)
    first = bands[0][0] if bands else np.inf
    found = {MeshStiffness.MINIMUM.value: first, "mean": first, MeshStiffness.MAXIMUM.value: first}
    inside = min(_BEYOND * first, np.sqrt(np.prod(bands[0]))) if bands else np.nan
    frequency = growth(float(inside)).frequency if bands else np.nan
    has_mesh = any(component(str(part.component)).freeze for part in system.parts)
    for extreme in (MeshStiffness.MINIMUM, MeshStiffness.MAXIMUM):
        if has_mesh and bands:
            found[extreme.value] = first_unstable_near(growth_at(extreme), first)
    return StepLimits(str(algorithm), bands, found, frequency)


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


def warn_if_unstable(system: System, algorithm: Algorithm, step: float) -> str | None:
    """One line if an algorithm is unstable at a step, or None; one matrix at mean stiffness.

    Args:
        system: as it is started.
        algorithm: coupling algorithm.
        step: macro step [s].

    Returns None also where nothing can be said: foreign parts, or a start with an open mesh.
    """
    if system.foreign_parts:
        return None
    try:
        amplification = Amplification(*linear_network(system), algorithm)
        growth = amplification.growth(step)
    except HerringboneError:
        return None
    if growth.radius <= 1.0 + GROWTH:
        return None
    return (
        f"{algorithm} is unstable at a step of {step:g} s: a motion at {growth.frequency:.0f} Hz "
        f"grows by {100.0 * (growth.radius - 1.0):.3g} % per step; 'herringbone stability' shows "
        "the limits"
    )
