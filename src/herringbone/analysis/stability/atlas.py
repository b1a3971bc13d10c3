"""Data of the stability atlas: limits over bearing stiffness, damping and mass ratio.

Bearing stiffness is varied on the given system itself; damping and mass ratio on two free rotors
and a coupling, the two-mass problem of co-simulation (M. Busch, ZAMM 96, 2016, 1061-1081). Steps
are made dimensionless with the highest frequency of all bonds together.

The limits are also found by runs, which know no amplification matrix: the real loop steps the parts
themselves, thousands of times. In the given system the mesh stiffness is frozen at its mean, as in
the prediction, so that a point off its line is an error of one of the two; two rotors are linear.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.bonds import highest_frequency
from herringbone.analysis.stability.linear_parts import linear_instances, linear_network
from herringbone.analysis.stability.steps.perturbed_run import perturbation_growth
from herringbone.analysis.stability.steps.simulated_limit import Bands, first_unstable, run_steps
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.components.registry import component, component_for
from herringbone.core.declaring.roles import PortKind, Quantity, Role
from herringbone.core.places.part_path import PartPath
from herringbone.core.process.telling import Tell, untold
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi
from herringbone.cosim.structure.system import PartSpec, System

ALGORITHMS = (Jacobi(0), Jacobi(1), Jacobi(2), LI(3))
STIFFNESS_FACTORS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
DAMPING_RATIOS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
MASS_RATIOS = (1.0, 3.0, 10.0, 30.0, 100.0)
_RUN_FACTORS = (0.1, 1.0, 10.0, 100.0)
"""Bearing stiffnesses at which the given system is also run."""
_POWERS = {Quantity.STIFFNESS: 1.0, Quantity.DAMPING: 0.5}
"""Powers of the factor by which the bearings' parameters are multiplied."""
_FREQUENCY, _INERTIA, _DAMPING = 3000.0, 0.01, 0.02
_HIGHEST = 1.25
"""Highest step that is run, over the predicted limit."""


@dataclass(frozen=True)
class Panel:
    """Limits over one quantity.

    Attributes:
        title, quantity: what is varied.
        values: of the quantity.
        predicted: step times frequency at the limit, by algorithm.
        simulated: the same from runs; NaN where none was looked for, or found.
    """

    title: str
    quantity: str
    values: tuple[float, ...]
    predicted: dict[str, tuple[float, ...]]
    simulated: dict[str, tuple[float, ...]]


def atlas(
    system: System,
    algorithms: Sequence[Algorithm] = ALGORITHMS,
    progress: Tell = untold,
) -> tuple[Panel, ...]:
    """Limits over bearing stiffness of a system, and over damping and mass ratio of two rotors.

    Args:
        system: with bearing supports, at the start values of an equilibrium under load.
        algorithms: to compare.
        progress: called before every limit.
    """
    damping = [two_rotors(zeta, 3.0) for zeta in DAMPING_RATIOS]
    ratio = [two_rotors(_DAMPING, ratio) for ratio in MASS_RATIOS]
    stiff = [scaled_bearings(system, factor) for factor in STIFFNESS_FACTORS]
    panels: tuple[
        tuple[str, str, Sequence[float], Sequence[System], Sequence[float]], ...
    ] = (
        (f"{system.name}: bearing stiffness", "bearing stiffness / nominal [1]", STIFFNESS_FACTORS,
         stiff, _RUN_FACTORS),
        ("two rotors: damping", "damping ratio of the coupling [1]", DAMPING_RATIOS,
         damping, DAMPING_RATIOS),
        ("two rotors: mass ratio", "ratio of the inertias [1]", MASS_RATIOS,
         ratio, MASS_RATIOS),
    )  # fmt: skip
    return tuple(_panel(*panel, algorithms, progress) for panel in panels)


def scaled_bearings(system: System, factor: float) -> System:
    """The system with stiffness of all bearings times a factor, in its new equilibrium.

    Bearing damping grows with the root of the factor, so that damping ratios stay.
    """
    changed = {}
    for part in _bearings(system):
        declaration = component(str(part.component)).declaration
        for quantity, power in _POWERS.items():
            for v in declaration.offered(quantity):
                value = float(part.values.get(v.name, v.start))
                changed[f"{part.name}.{v.name}"] = value * factor**power
    scaled = system.with_values(changed)
    return scaled.with_values(equilibrium(scaled).values)


def _bearings(system: System) -> list[PartSpec]:
    """The bearings whose parameters are known."""
    return [
        part
        for part in system.parts
        if part.component and Role.BEARING in component(part.component).declaration.roles
    ]


def unscaled(system: System) -> tuple[str, ...]:
    """What `scaled_bearings` cannot scale, one line each."""
    bearings = _bearings(system)
    if not bearings:
        return ("no part is a bearing whose parameters are known: its stiffness is not varied",)
    return tuple(
        f"{part.name}: {part.component} has no parameter for {quantity}; it is not scaled"
        for part in bearings
        for quantity in _POWERS
        if not component(str(part.component)).declaration.offered(quantity)
    )


def two_rotors(damping_ratio: float, ratio: float) -> System:
    """Two free rotors of an inertia ratio, and a coupling of a damping ratio."""
    reduced = _INERTIA * ratio / (1.0 + ratio)
    values = {
        Quantity.STIFFNESS: reduced * _FREQUENCY**2,
        Quantity.DAMPING: 2.0 * damping_ratio * reduced * _FREQUENCY,
    }
    parts = (
        _part("left", Role.LOAD, {Quantity.INERTIA: _INERTIA}),
        _part("right", Role.LOAD, {Quantity.INERTIA: ratio * _INERTIA}),
        _part("coupling", Role.COUPLING, values),
    )
    (left,), (right,), ends = map(_flanges, parts)
    wires = tuple(zip((left, right), ends, strict=True))
    return System("two_rotors", "", parts, wires)


def _part(name: str, role: Role, values: Mapping[Quantity, float]) -> PartSpec:
    """A part of the component that is taken for a role."""
    declaration = component_for(role).declaration
    own = {v.name: value for q, value in values.items() for v in declaration.offered(q)}
    return PartSpec(PartPath(name), component=declaration.name, values=own)


def _flanges(part: PartSpec) -> list[str]:
    declaration = component(str(part.component)).declaration
    return [f"{part.name}.{p.name}" for p in declaration.ports if p.kind is PortKind.FLANGE]


def _panel(
    title: str,
    quantity: str,
    values: Sequence[float],
    systems: Sequence[System],
    run_at: Sequence[float],
    algorithms: Sequence[Algorithm],
    progress: Tell,
) -> Panel:
    predicted, simulated = {}, {}
    for algorithm in algorithms:
        name, found, seen = str(algorithm), [], []
        for value, system in zip(values, systems, strict=True):
            progress(name)
            network, instances = linear_network(system)
            frequency = highest_frequency(network, instances)
            amplification = Amplification(network, instances, algorithm)
            bands = unstable_bands(amplification.growth, 1e-2 / frequency, 20.0 / frequency)
            found.append((bands[0][0] if bands else np.inf) * frequency)
            limit = simulated_limit(system, algorithm, bands) if value in run_at else np.nan
            seen.append(limit * frequency)
        predicted[name], simulated[name] = tuple(found), tuple(seen)
    return Panel(title, quantity, tuple(values), predicted, simulated)


def simulated_limit(system: System, algorithm: Algorithm, bands: Bands) -> float:
    """First step [s] at which a perturbation grows in runs of the linear parts, to 1 %.

    Args:
        system: at the start values of an equilibrium.
        algorithm: coupling algorithm.
        bands: predicted unstable steps (from, to) [s]; the first one tells where to look.

    Returns:
        NaN if runs change sides nowhere near the predicted limit.
    """
    if not bands:
        return np.nan
    limit = bands[0][0]
    steps = run_steps(limit)

    def unstable(step: float) -> bool:
        growth = perturbation_growth(
            system, lambda: linear_instances(system), algorithm, step, steps=steps, at_rest=True
        )
        return growth > 0.0

    found = first_unstable(unstable, limit, bands, _HIGHEST)
    return np.nan if found is None else found
