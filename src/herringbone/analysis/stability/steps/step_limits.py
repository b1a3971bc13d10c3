"""Unstable macro steps of one algorithm.

The spectral radius of the amplification matrix is scanned over the step, at minimum, mean and
maximum mesh stiffness. Not covered: teeth that separate, and parametric excitation by the mesh.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH, Growth
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    MeshStiffness,
    Strangers,
    linear_network,
)
from herringbone.analysis.stability.steps.step_scan import (
    COARSE,
    LARGEST_STEP,
    GrowthOf,
    first_unstable_near,
    safe_growth,
    unstable_bands,
)
from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate, common_steps
from herringbone.analysis.stability.surrogates.surrogate import PROMISED
from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System

_BEYOND = 1.01
_SCAN_OF_STRANGERS = 1.1
_LARGEST_OF_STRANGERS = 1.0
"""Step [s] at which the scan of systems of foreign parts alone ends: these may be slow."""

Progress = Callable[[str], None]
"""Called after every matrix, with the name of the algorithm."""


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
        steps: how many were looked at, if only some go with parts that have clocks; else 0.
    """

    algorithm: str
    unstable_bands: tuple[tuple[float, float], ...]
    mesh_stiffness: Mapping[str, float]
    frequency: float = np.nan
    simulated_limit: float | None = None
    residual: float = 0.0
    largest: float = LARGEST_STEP
    steps: int = 0

    @property
    def promised(self) -> bool:
        """False if what stands for foreign parts is too far from them."""
        return self.residual <= PROMISED

    @property
    def limit(self) -> float:
        """Step [s] below which everything examined is stable, at all stiffnesses."""
        return min(self.mesh_stiffness.values())


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
    if clocks_of(strangers):
        return _limits_on_grid(algorithm, growth, amplification, strangers, largest)
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


def clocks_of(strangers: Strangers) -> list[SampledSurrogate]:
    """What stands for parts with clocks."""
    found = (stranger.surrogate for stranger in strangers.values())
    return [surrogate for surrogate in found if isinstance(surrogate, SampledSurrogate)]


def _limits_on_grid(
    algorithm: Algorithm,
    growth: GrowthOf,
    amplification: Amplification,
    strangers: Strangers,
    largest: float,
) -> StepLimits:
    """Unstable steps among those of which parts with clocks have maps, at mean stiffness."""
    clocks = clocks_of(strangers)
    grid = common_steps(clocks, largest)
    if not grid:
        periods = ", ".join(f"{clock.period:g} s" for clock in clocks)
        raise ParameterError(f"no step goes with the periods of parts with clocks: {periods}")
    unstable = {step: safe_growth(growth, step).radius > 1.0 + GROWTH for step in grid}
    bands: list[tuple[float, float]] = []
    for before, step in pairwise([0.0, *grid]):
        if unstable[step] and not unstable.get(before, False):
            bands.append((step, np.inf))
        elif not unstable[step] and unstable.get(before, False):
            bands[-1] = bands[-1][0], step
    first = bands[0][0] if bands else np.inf
    residual = _residual(amplification, strangers, first if bands else grid[-1])
    frequency = growth(first).frequency if bands else np.nan
    same = dict.fromkeys((stiffness.value for stiffness in MeshStiffness), first)
    return StepLimits(
        str(algorithm), tuple(bands), same, frequency, residual=residual, largest=grid[-1],
        steps=len(grid),
    )  # fmt: skip


def _residual(amplification: Amplification, strangers: Strangers, step: float) -> float:
    """Of what stands for foreign parts, at a macro step [s]; at that of its trials if infinite."""
    if not strangers:
        return 0.0
    if not np.isfinite(step):
        return max(s.surrogate.residual(s.surrogate.base) for s in strangers.values())
    amplification.growth(step)
    return amplification.residual
