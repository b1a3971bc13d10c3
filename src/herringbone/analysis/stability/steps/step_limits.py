"""Unstable macro steps of one algorithm.

The spectral radius of the amplification matrix is scanned over the step, at minimum, mean and
maximum mesh stiffness. Not covered: teeth that separate, and parametric excitation by the mesh.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import Growth
from herringbone.analysis.stability.linear_parts import (
    NO_STRANGERS,
    MeshStiffness,
    Strangers,
    linear_network,
    stiffest_mesh,
)
from herringbone.analysis.stability.steps.clock_grid import (
    bands_on_grid,
    clocks_of,
    stability_on_grid,
)
from herringbone.analysis.stability.steps.step_scan import (
    COARSE,
    LARGEST_STEP,
    GrowthOf,
    first_unstable_near,
    unstable_bands,
)
from herringbone.analysis.stability.surrogates.surrogate import PROMISED
from herringbone.components.registry import component
from herringbone.core import ParameterError
from herringbone.core.process.telling import Tell
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.structure.system import System

_BEYOND = 1.01
_SCAN_OF_STRANGERS = 1.1
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
        frequency: of the motion that grows at the mean's limit [Hz]; where the mean has none, at
            an extreme's.
        simulated_limit: first step [s] at which runs of the non-linear system are unstable; None
            if none was looked for, or if none is from half to twice the predicted limit.
        residual: largest deviation of what stands for foreign parts from trials that were not
            fitted, at the limit; 0 without foreign parts.
        largest: step [s] at which the scan ends.
        steps: how many were looked at, if only some go with parts that have clocks; else 0.
        below: then the last of them below the limit [s], 0 if there is none; nothing is known of
            steps between the two.
        own: growth in time of a slow motion [1/s] at the limit that is there whatever the step.
    """

    algorithm: str
    unstable_bands: tuple[tuple[float, float], ...]
    mesh_stiffness: Mapping[str, float]
    frequency: float = np.nan
    simulated_limit: float | None = None
    residual: float = 0.0
    largest: float = LARGEST_STEP
    steps: int = 0
    below: float = 0.0
    own: float = 0.0

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
    progress: Tell | None = None,
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
    coarse = _SCAN_OF_STRANGERS if alone else COARSE
    bands = unstable_bands(growth, largest=largest, coarse=coarse)
    first = bands[0][0] if bands else np.inf
    found = {MeshStiffness.MINIMUM.value: first, "mean": first, MeshStiffness.MAXIMUM.value: first}
    inside = min(_BEYOND * first, np.sqrt(np.prod(bands[0]))) if bands else np.nan
    frequency = growth(float(inside)).frequency if bands else np.nan
    own = max(growth(float(step)).own for step in ((first, inside) if bands else (largest,)))
    if any(component(str(part.component)).freeze for part in system.parts if not part.foreign):
        # Where the mesh decides, the limit goes with the root of its stiffness.
        lower = stiffest_mesh(system, strangers) ** -0.5 if bands else 1.0
        for extreme in (MeshStiffness.MINIMUM, MeshStiffness.MAXIMUM):
            at_extreme = growth_of(amplification_at(extreme))
            if bands:
                found[extreme.value] = first_unstable_near(at_extreme, first, lower)
            elif own_bands := unstable_bands(at_extreme, largest=largest, coarse=coarse):
                found[extreme.value] = own_bands[0][0]
                frequency = at_extreme(_BEYOND * own_bands[0][0]).frequency
    residual = _residual(amplification, strangers, min(found.values()))
    if residual > PROMISED and again and np.isfinite(first):
        for stranger in strangers.values():
            stranger.surrogate.look_at(first)
        return step_limits(system, algorithm, progress, strangers, again=False)
    return StepLimits(
        str(algorithm), bands, found, frequency, residual=residual, largest=largest, own=own
    )


def _limits_on_grid(
    algorithm: Algorithm,
    growth: GrowthOf,
    amplification: Amplification,
    strangers: Strangers,
    largest: float,
) -> StepLimits:
    """Unstable steps among those of which parts with clocks have maps, at mean stiffness."""
    clocks = clocks_of(strangers)
    stable = stability_on_grid(growth, clocks, largest)
    if not stable:
        periods = ", ".join(f"{clock.period:g} s" for clock in clocks)
        raise ParameterError(f"no step goes with the periods of parts with clocks: {periods}")
    bands, last = bands_on_grid(stable), max(stable)
    first = bands[0][0] if bands else np.inf
    residual = _residual(amplification, strangers, first if bands else last)
    frequency = growth(first).frequency if bands else np.nan
    same = dict.fromkeys((stiffness.value for stiffness in MeshStiffness), first)
    return StepLimits(
        str(algorithm), bands, same, frequency, residual=residual, largest=last,
        steps=len(stable), below=max((step for step in stable if step < first), default=0.0),
    )  # fmt: skip


def _residual(amplification: Amplification, strangers: Strangers, step: float) -> float:
    """Of what stands for foreign parts, at a macro step [s]; at that of its trials if infinite."""
    if not strangers:
        return 0.0
    if not np.isfinite(step):
        return max(s.surrogate.residual(s.surrogate.base) for s in strangers.values())
    amplification.growth(step)
    return amplification.residual
