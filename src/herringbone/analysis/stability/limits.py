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
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    MeshStiffness,
    Strangers,
    linear_network,
)
from herringbone.analysis.stability.recommendation import (
    CHARTED_MICRO_STEP,
    Ranking,
    Recommendation,
    rank,
)
from herringbone.analysis.stability.simulated_limit import nonlinear_limit
from herringbone.analysis.stability.step_scan import (
    COARSE,
    LARGEST_STEP,
    GrowthOf,
    first_unstable_near,
    unstable_bands,
)
from herringbone.analysis.stability.surrogate import PROMISED
from herringbone.components.registry import component
from herringbone.core import HerringboneError, Instance, ParameterError
from herringbone.core.activity import activity
from herringbone.core.energy_report import hertz
from herringbone.core.roles import Quantity, Role
from herringbone.cosim.algorithms import ALGORITHMS, Algorithm, Jacobi
from herringbone.cosim.structure.system import System
from herringbone.cosim.tolerance import check_tolerance

Progress = Callable[[str], None]
"""Called after every matrix, with the name of the algorithm."""
_BEYOND = 1.01
_SCAN_OF_STRANGERS = 1.1
_SHORTER, _ALIKE = 8.0, 0.1
"""A motion grows of itself if with so much shorter steps its rate is the same to this share."""
_UNSEEN = 3.0
"""Powers of e that a motion may grow by in a run that still looks sound."""
_LARGEST_OF_STRANGERS = 1.0
"""Step [s] at which the scan of systems of foreign parts alone ends: these may be slow."""


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
        residual: largest deviation of what stands for foreign parts from trials that were not
            fitted, at the limit; 0 without foreign parts.
        largest: step [s] at which the scan ends.
    """

    algorithm: str
    unstable_bands: tuple[tuple[float, float], ...]
    mesh_stiffness: Mapping[str, float]
    frequency: float = np.nan
    simulated_limit: float | None = None
    residual: float = 0.0
    largest: float = LARGEST_STEP

    @property
    def promised(self) -> bool:
        """False if what stands for foreign parts is too far from them."""
        return self.residual <= PROMISED

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
        orders: of what stands for foreign parts, by name.
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
    strangers: Strangers = NO_STRANGERS,
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
    for algorithm in algorithms or default_algorithms():
        try:
            with activity(f"{what} with {algorithm}", shown=progress is not None):
                limit = step_limits(system, algorithm, progress, strangers)
                if simulate:
                    seen = nonlinear_limit(
                        system, algorithm, limit.limit, limit.unstable_bands, strangers
                    )
                    limit = replace(limit, simulated_limit=seen)
            limits.append(limit)
            chosen.append(algorithm)
        except ParameterError as error:
            notes.append(f"{algorithm}: {error}")
    by_limit = [(a, found.limit) for a, found in zip(chosen, limits, strict=True)]
    ranking = Ranking()
    if strangers:
        notes.append("algorithms are not ranked: the rule of accuracy knows no foreign parts")
    else:
        ranking = rank(by_limit, highest, tolerance, _micro_step(instances))
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
    system: System,
    algorithm: Algorithm,
    progress: Progress | None = None,
    strangers: Strangers = NO_STRANGERS,
    *,
    again: bool = True,
) -> StepLimits:
    """Unstable steps of an algorithm at mean mesh stiffness, and its limit at all stiffnesses.

    Foreign parts are identified once more, at the limit, if what stands for them misses them there.
    """
    alone = len(strangers) == len(system.parts)
    largest = _LARGEST_OF_STRANGERS if alone else LARGEST_STEP

    def amplification_at(stiffness: MeshStiffness) -> Amplification:
        return Amplification(*linear_network(system, stiffness, strangers), algorithm)

    def growth_of(amplification: Amplification) -> GrowthOf:

        @cache
        def growth(step: float) -> Growth:
            if progress:
                progress(str(algorithm))
            return amplification.growth(step)

        return growth

    amplification = amplification_at(MeshStiffness.MEAN)
    growth = growth_of(amplification)
    bands = unstable_bands(growth, largest=largest, coarse=_SCAN_OF_STRANGERS if alone else COARSE)
    first = bands[0][0] if bands else np.inf
    found = {MeshStiffness.MINIMUM.value: first, "mean": first, MeshStiffness.MAXIMUM.value: first}
    inside = min(_BEYOND * first, np.sqrt(np.prod(bands[0]))) if bands else np.nan
    frequency = growth(float(inside)).frequency if bands else np.nan
    has_mesh = any(
        component(str(part.component)).freeze for part in system.parts if not part.foreign
    )
    for extreme in (MeshStiffness.MINIMUM, MeshStiffness.MAXIMUM):
        if has_mesh and bands:
            found[extreme.value] = first_unstable_near(growth_of(amplification_at(extreme)), first)
    residual = _residual(amplification, strangers, min(found.values()))
    if residual > PROMISED and again and np.isfinite(first):
        for stranger in strangers.values():
            stranger.surrogate.look_at(first)
        return step_limits(system, algorithm, progress, strangers, again=False)
    return StepLimits(str(algorithm), bands, found, frequency, residual=residual, largest=largest)


def _residual(amplification: Amplification, strangers: Strangers, step: float) -> float:
    """Of what stands for foreign parts, at a macro step [s]; at that of its trials if infinite."""
    if not strangers:
        return 0.0
    if not np.isfinite(step):
        return max(s.surrogate.residual(s.surrogate.base) for s in strangers.values())
    amplification.growth(step)
    return amplification.residual


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


def warn_if_unstable(
    system: System,
    algorithm: Algorithm,
    step: float,
    duration: float = np.inf,
    strangers: Strangers = NO_STRANGERS,
) -> str | None:
    """One line if an algorithm is unstable at a step, or None; one matrix at mean stiffness.

    Args:
        system: as it is started.
        algorithm: coupling algorithm.
        step: macro step [s].
        duration: of the run [s].
        strangers: what stands for foreign parts.

    Returns None also where nothing can be said: nothing stands for a foreign part, or it stands
    too far from it, or a mesh is open at the start.
    """
    try:
        members = linear_network(system, strangers=strangers)
        amplification = Amplification(*members, algorithm)
        growth = amplification.growth(step)
    except HerringboneError:
        return None
    if growth.radius <= 1.0 + GROWTH:
        return None
    if amplification.residual > PROMISED:
        return None
    if _grows_itself(amplification, growth, step):
        return (
            f"{system.name} itself, linear at the start, grows at {hertz(growth.frequency)} "
            f"{_in_time(growth, step, duration)}, whatever the step"
        )
    return (
        f"{algorithm} is unstable at a step of {step:g} s: a motion at {hertz(growth.frequency)} "
        f"grows by {100.0 * (growth.radius - 1.0):.3g} % per step, "
        f"{_in_time(growth, step, duration)}; 'herringbone stability' shows the limits"
    )


def _grows_itself(amplification: Amplification, growth: Growth, step: float) -> bool:
    """True if a motion grows alike with an eighth of the step: the coupling is not to blame."""
    try:
        shorter = amplification.growth(step / _SHORTER).radius
    except HerringboneError:
        return False
    rate, known = _SHORTER * np.log(max(shorter, 1e-300)), np.log(growth.radius)
    return bool(abs(rate - known) < _ALIKE * known)


def _in_time(growth: Growth, step: float, duration: float) -> str:
    """Growth per second, and within a run of a duration [s]."""
    rate = float(np.log(growth.radius)) / step
    text = f"as exp({rate:.3g} t/s)"
    if not np.isfinite(duration):
        return text
    folds = rate * duration
    if folds < _UNSEEN:
        return f"{text}: by {100.0 * np.expm1(folds):.2g} % within the run, which does not show it"
    return f"{text}: {folds:.3g} powers of e within the run"
