"""Growth of a small perturbation, per macro step, measured on two runs of the real loop.

Both runs have the same algorithm and step; in one of them the bodies start with slightly other
velocities. In a stable coupling the difference of the forces dies out, whatever the runs themselves
do (mesh excitation, a transient); in an unstable one it grows exponentially. Its rate is the
largest Lyapunov exponent of the coupled run (G. Benettin et al., Meccanica 15, 1980, 9-20).

Slow motions, which every step resolves, are taken out by the second difference in time. What is
left of them: a kick turns shafts a little faster, so that meshing forces come earlier, by an angle
that grows linearly in time. Only what grows faster than that counts as growth. Harmonics of the
mesh that lie close together, some of them as communication points alias them, beat on top of that,
and forces change with the speed of a drivetrain whose torques do not balance: a growth that not all
of the end shows counts for nothing.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from herringbone.components.in_process import InProcessPart
from herringbone.core import HerringboneError, Instance
from herringbone.core.part import Part, closing_all
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.energy.pairs import power_pairs
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System

KICK = {"m/s": 1e-6, "rad/s": 1e-4}
"""Largest start velocities: they deflect the meshes by about 1e-4 of what the load does."""
GROWN = 30.0
"""Elastic energy is at most that of the kick: a stable difference rises by the start's share only;
what has risen by this factor was growing, even if separating teeth have since held it."""
_ROUNDING = 1e-4
"""Of what was there at first: the least that rounding of the shafts' angles does not cover."""
_WINDOWS, _FIRST = 10, 20
_AROUND, _ABOVE = 3, 1.05
"""Each of so many windows at the end is so many times above all of as many before the middle."""

MakeParts = Callable[[], Sequence[Instance | Part]]
"""Makes the parts of a run, at their start values: components as instances, foreign parts."""


def perturbation_growth(
    system: System,
    make: MakeParts,
    algorithm: Algorithm,
    step: float,
    *,
    steps: int,
    at_rest: bool = False,
) -> float:
    """Natural logarithm of the growth of a small perturbation per macro step.

    Args:
        system: structure; where bodies and elements meet, forces are compared.
        make: makes its parts; components among them are perturbed.
        algorithm: coupling algorithm.
        step: macro step [s].
        steps: macro steps of each run.
        at_rest: the parts are linear and start in equilibrium: without the perturbation their
            forces are constant, so that one run is enough.

    Returns:
        Positive in an unstable coupling, 0 at most in a stable one; infinite if a run ends early.
    """
    kicked = _forces(system, _kicked(make()), algorithm, step, steps)
    if not np.isfinite(kicked).all():
        return math.inf
    plain = kicked[:1] if at_rest else _forces(system, make(), algorithm, step, steps)
    if not np.isfinite(plain).all():
        return math.inf
    return _rate(np.diff(kicked - plain, n=2, axis=0), power=0 if at_rest else 1)


def _kicked(made: Sequence[Instance | Part]) -> Sequence[Instance | Part]:
    """The parts with other velocities of all bodies, the same ones in every call."""
    random = np.random.default_rng(0)
    for instance in made:
        if not isinstance(instance, Instance):
            continue
        for entry, v in enumerate(instance.component.declaration.states):
            instance.block[entry] += KICK.get(v.unit, 0.0) * random.uniform(-1.0, 1.0)
    return made


def _forces(
    system: System,
    made: Sequence[Instance | Part],
    algorithm: Algorithm,
    step: float,
    steps: int,
) -> np.ndarray:
    """Forces between the parts (steps + 1, m) in a run; one row of infinity if it ends early."""
    with closing_all([InProcessPart(p) if isinstance(p, Instance) else p for p in made]) as parts:
        pairs = [pair.force for pair in power_pairs(build_network(system, parts))]
        try:
            run = simulate(system, parts, algorithm, make_grid(steps * step, step, step))
        except HerringboneError:  # no Jacobian where the values overflow
            return np.full((1, len(pairs)), np.inf)
    if not run.outcome.reached_end:
        return np.full((1, len(pairs)), np.inf)
    columns = [run.names.index(f"{parts[c.source].name}.{c.output}") for c in pairs]
    return run.values[:, columns]


def _rate(difference: np.ndarray, power: int) -> float:
    """Growth per row of a difference (n, m), from its middle to its end, or up to its peak.

    Args:
        difference: of two runs.
        power: of time, with which a difference may grow that counts as constant.
    """
    length = len(difference) // _WINDOWS
    windows = difference[: length * _WINDOWS].reshape(_WINDOWS, length, -1)
    weights = np.hanning(length)[:, None] / np.hanning(length).mean()
    sizes = np.sqrt((weights * windows**2).mean(axis=(1, 2)))
    start = math.sqrt((difference[:_FIRST] ** 2).mean())
    last = int(np.argmin(np.append(sizes > _ROUNDING * start, False))) - 1
    if last < 1:
        return math.log(_ROUNDING) / length
    middle = (last + 1) // 2 if last > 1 else 0
    allowed = ((last + 0.5) / (middle + 0.5)) ** power
    rate = math.log(sizes[last] / (allowed * sizes[middle])) / ((last - middle) * length)
    if power and not _rises(sizes[: last + 1], middle, power):
        rate = min(rate, 0.0)
    peak = int(np.argmax(sizes))
    if rate <= 0.0 and sizes[peak] > GROWN * start:
        return math.log(sizes[peak] / start) / ((peak + 1) * length)
    return rate


def _rises(sizes: np.ndarray, middle: int, power: int) -> bool:
    """True if all windows at the end are above all before the middle, over a power of time."""
    over = sizes / (np.arange(len(sizes)) + 0.5) ** power
    before = over[max(middle + 1 - _AROUND, 0) : middle + 1]
    return bool(over[-_AROUND:].min() > _ABOVE * before.max())
