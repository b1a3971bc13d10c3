"""Data of the stability atlas: limits over bearing stiffness, damping and mass ratio.

Bearing stiffness is varied on the given system itself; damping and mass ratio on two free rotors
and a coupling, the two-mass problem of co-simulation (M. Busch, ZAMM 96, 2016, 1061-1081). Steps
are made dimensionless with the highest frequency of all bonds together. On the two rotors the limit
is also found by running the real loop, independently of the amplification matrix.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from herringbone.analysis.amplification import Amplification
from herringbone.analysis.bonds import highest_frequency
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.linear_parts import linear_network
from herringbone.analysis.step_scan import unstable_bands
from herringbone.components.bearing_supports import BEARING_SUPPORTS
from herringbone.components.in_process import InProcessPart
from herringbone.core import HerringboneError
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.system import PartSpec, System

ALGORITHMS = (Jacobi(0), Jacobi(1), Jacobi(2), LI(3))
STIFFNESS_FACTORS = (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)
DAMPING_RATIOS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2)
MASS_RATIOS = (1.0, 3.0, 10.0, 30.0, 100.0)
_FREQUENCY, _INERTIA, _DAMPING = 3000.0, 0.01, 0.02
_STEPS = 4000
_LARGE, _ROUNDING = 1e6, 1e-8

Progress = Callable[[str], None]


@dataclass(frozen=True)
class Panel:
    """Limits over one quantity.

    Attributes:
        title, quantity: what is varied.
        values: of the quantity.
        predicted: step times frequency at the limit, by algorithm.
        simulated: the same from runs; empty if there were none.
    """

    title: str
    quantity: str
    values: tuple[float, ...]
    predicted: dict[str, tuple[float, ...]]
    simulated: dict[str, tuple[float, ...]]


def atlas(
    system: System,
    algorithms: Sequence[Algorithm] = ALGORITHMS,
    progress: Progress = lambda _: None,
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
    panels = (
        ("Bearing stiffness", "bearing stiffness, times nominal", STIFFNESS_FACTORS, stiff, False),
        ("Two rotors: damping", "damping ratio", DAMPING_RATIOS, damping, True),
        ("Two rotors: mass ratio", "inertia ratio", MASS_RATIOS, ratio, True),
    )
    return tuple(_panel(*panel, algorithms, progress) for panel in panels)


def scaled_bearings(system: System, factor: float) -> System:
    """The system with stiffness of all bearings times a factor, in its new equilibrium.

    Bearing damping grows with the root of the factor, so that damping ratios stay.
    """
    changed = {}
    declaration = BEARING_SUPPORTS.declaration
    for part in system.parts:
        for v in declaration.parameters if part.component == BEARING_SUPPORTS.name else ():
            power = {"stiffness": 1.0, "damping": 0.5}.get(v.name.rpartition("_")[2])
            if power:
                value = float(part.values.get(v.name, v.start))
                changed[f"{part.name}.{v.name}"] = value * factor**power
    scaled = system.with_values(changed)
    return scaled.with_values(equilibrium(scaled).values)


def two_rotors(damping_ratio: float, ratio: float) -> System:
    """Two free rotors of an inertia ratio, and a coupling of a damping ratio."""
    reduced = _INERTIA * ratio / (1.0 + ratio)
    values = {
        "stiffness": reduced * _FREQUENCY**2,
        "damping": 2.0 * damping_ratio * reduced * _FREQUENCY,
    }
    parts = (
        PartSpec("left", component="load_motor", values={"inertia": _INERTIA}),
        PartSpec("right", component="load_motor", values={"inertia": ratio * _INERTIA}),
        PartSpec("coupling", component="shaft_coupling", values=values),
    )
    wires = (("left.flange", "coupling.flange_a"), ("right.flange", "coupling.flange_b"))
    return System("two_rotors", "", parts, wires)


def _panel(
    title: str,
    quantity: str,
    values: Sequence[float],
    systems: Sequence[System],
    run: bool,
    algorithms: Sequence[Algorithm],
    progress: Progress,
) -> Panel:
    predicted, simulated = {}, {}
    for algorithm in algorithms:
        name, found, seen = str(algorithm), [], []
        for system in systems:
            progress(name)
            network, instances = linear_network(system)
            frequency = highest_frequency(network, instances)
            amplification = Amplification(network, instances, algorithm)
            smallest, largest = 1e-2 / frequency, 20.0 / frequency
            bands = unstable_bands(amplification.growth, smallest, largest)
            limit = bands[0][0] if bands else np.inf
            found.append(limit * frequency)
            if run:
                seen.append(simulated_limit(system, algorithm, limit) * frequency)
        predicted[name] = tuple(found)
        if run:
            simulated[name] = tuple(seen)
    return Panel(title, quantity, tuple(values), predicted, simulated)


def simulated_limit(system: System, algorithm: Algorithm, near: float) -> float:
    """First step [s] at which a run of two rotors grows, to 1 %; NaN if it is not near."""
    low, high = 0.8 * near, 1.25 * near
    if not np.isfinite(near) or _grows(system, algorithm, low):
        return np.nan
    if not _grows(system, algorithm, high):
        return np.nan
    while high > 1.01 * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if _grows(system, algorithm, middle) else (middle, high)
    return float(np.sqrt(low * high))


def _grows(system: System, algorithm: Algorithm, step: float) -> bool:
    """True if the twist of the coupling grows in a run from a small kick."""
    kicked = replace(
        system,
        parts=tuple(
            replace(p, values={**p.values, "speed": 1e-3}) if p.name == "left" else p
            for p in system.parts
        ),
    )
    _, instances = linear_network(kicked)
    parts = [InProcessPart(i) for i in instances]
    try:
        run = simulate(system, parts, algorithm, make_grid(_STEPS * step, step, step))
    except HerringboneError:  # no Jacobian where the values overflow
        return True
    if not run.outcome.completed or np.abs(run.values).max() > _LARGE:
        return True
    twist = np.diff(run.values[:, run.names.index("coupling.phi_rel")])
    window = _STEPS // 10
    first, middle, last = (
        np.linalg.norm(twist[at : at + window]) for at in (0, _STEPS // 2, _STEPS - 1 - window)
    )
    return bool(last > middle and last > _ROUNDING * first)
