"""Growth of the free rotation of shafts in runs, however slow: by what two runs differ in speed.

Both runs have the same algorithm and step; in one of them all shafts of own parts turn a little
faster at the start. The steady motion, the mesh and the load cancel in the difference; means of its
windows leave out what oscillates, and the rest goes with exp(r t), of which a growth of e^0.1 in
the whole run shows to a few per cent.
"""

import math

import numpy as np

from herringbone.analysis.stability.linear_parts import real_parts
from herringbone.components.in_process import InProcessPart
from herringbone.core import Instance
from herringbone.core.part import closing_all
from herringbone.cosim.simulation import make_grid, simulate

DURATION, RECORD = 0.5, 1e-3
"""Of the runs, and between their records, in s."""
FASTER = 1e-4
"""Speeds of the second run over those of the first in rad/s: so little leaves forces linear."""
WINDOWS, SETTLED = 10, 3
"""Windows of a run, and how many of them go by until other motions have died out."""


def rotation_growth(system, strangers, algorithm, step):
    """Growth of the rotation per macro step in s, as a power of e; infinite if a run ends."""
    plain, faster = (_speeds(system, strangers, algorithm, step, add) for add in (0.0, FASTER))
    if plain is None or faster is None:
        return math.inf
    difference = (faster - plain)[:, np.any(faster != plain, axis=0)]  # without set points
    length = len(difference) // WINDOWS
    weights = np.hanning(length)[:, None] / np.hanning(length).sum()
    windows = difference[: WINDOWS * length].reshape(WINDOWS, length, -1)
    sizes = np.log(np.abs((weights * windows).sum(axis=1)[SETTLED:]))
    steps = length * max(1, round(RECORD / step)) * np.arange(len(sizes))
    return float(np.median(np.polyfit(steps, sizes, 1)[0]))


def _speeds(system, strangers, algorithm, step, faster):
    """Speeds of shafts (records, m) in rad/s of a run; None if it ends early."""
    made = real_parts(system, strangers)
    for part in made:
        if isinstance(part, Instance):
            for entry, v in enumerate(part.component.declaration.states):
                part.block[entry] += faster if v.unit == "rad/s" else 0.0
    with closing_all([InProcessPart(p) if isinstance(p, Instance) else p for p in made]) as parts:
        record = max(1, round(RECORD / step)) * step
        run = simulate(
            system, parts, algorithm, make_grid(DURATION // record * record, step, record)
        )
        shafts = {
            f"{part.name}.{name}"
            for part in parts
            for name, v in part.variables.items()
            if v.causality == "output" and v.unit == "rad/s"
        }
    if not run.outcome.reached_end:
        return None
    return run.values[:, [k for k, name in enumerate(run.names) if name in shafts]]
