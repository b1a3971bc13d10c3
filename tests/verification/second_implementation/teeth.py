"""What presses the flanks of a side against each other: ideal teeth, or teeth that deviate.

"Deviations of single teeth" and "Files of teeth" in the README of `gear_mesh`.
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from second_implementation.pair_law import PairLaw

SIDES = "left", "right"
FLANKS = {"drive": 1, "coast": -1}


class Load(NamedTuple):
    """What teeth do at a phase and a depth; the ramp's slope is dU/dR at constant depth [J]."""

    force: float
    tangent: float
    phase_slope: float
    ramp_slope: float
    depth: float


_NONE = Load(0.0, 0.0, 0.0, 0.0, 0.0)


class IdealTeeth:
    """Teeth of the stiffness table.

    Args:
        table: `StiffnessLaw` of the side.
    """

    def __init__(self, table):
        self.table = table

    def load(self, phase, depth, ramp):
        """What they do."""
        if depth <= 0.0:
            return _NONE
        force, tangent, phase_slope = self.table.at(phase, depth)
        return Load(force, tangent, phase_slope, 0.0, depth)


class DeviatingTeeth:
    """Teeth of one flank of a side, each with its deviations.

    Args:
        law: `PairLaw` of the side.
        pinion, wheel: (z, 3) position, profile and helix of the teeth [m].
    """

    def __init__(self, law, pinion, wheel):
        self.law, self.pinion, self.wheel = law, pinion, wheel

    def load(self, phase, depth, ramp):
        """What they do, with R of their deviations."""
        total, moments = np.zeros(4), 0.0
        newest, oldest = phase - self.law.first, phase - self.law.last
        for n in range(math.ceil(oldest), math.floor(newest) + 1):
            found, moment = self._pair(n, phase - n, depth, ramp)
            total += found
            moments += moment
        force, tangent, phase_slope, ramp_slope = total.tolist()
        mean = moments / force if force > 0.0 else 0.0
        return Load(force, tangent, phase_slope, ramp_slope, mean)

    def _pair(self, n, q, depth, ramp):
        """Force, tangent and slopes of the pair n, and its x dU/dx + y dU/dy."""
        law = self.law
        (p1, a1, h1), (p2, a2, h2) = (
            self.pinion[n % len(self.pinion)],
            self.wheel[n % len(self.wheel)],
        )
        mean, half, mean_q, half_q = law.line(q)
        profile, helix = (a1 - a2) / law.eps_a, h1 + h2
        lift = p1 + p2 + profile * (q - law.eps_b * (1.0 - mean)) - (a1 - a2) / 2.0
        lift += helix * (mean - 0.5)
        tilt = profile * law.eps_b + helix
        x, y = depth + ramp * lift, ramp * half * tilt
        u = law.energy(q, x, y)
        x_q = ramp * (profile * (1.0 + law.eps_b * mean_q) + helix * mean_q)
        y_q = ramp * half_q * tilt
        over_q = u.over_q + u.over_x * x_q + u.over_y * y_q
        over_ramp = u.over_x * lift + u.over_y * half * tilt
        return (u.over_x, u.over_xx, over_q, over_ramp), x * u.over_x + y * u.over_y


def read_teeth(deviations, pair_law, tables, counts):
    """Teeth by side (0, 1) and flank (1, -1).

    Args:
        deviations, pair_law: resource files.
        tables: `StiffnessLaw` of both sides.
        counts: numbers of teeth of pinion and wheel.
    """
    given = {}
    for line in Path(deviations).read_text(encoding="utf-8").splitlines():
        if line.startswith(("#", "side")):
            continue
        side, flank, gear, tooth, *values = line.split(",")
        gears = given.setdefault((side, flank), [np.zeros((int(z), 3)) for z in counts])
        gears[gear == "wheel"][int(tooth) - 1] = [float(x) for x in values]
    teeth = {}
    for side, (name, table) in enumerate(zip(SIDES, tables, strict=True)):
        for flank, sign in FLANKS.items():
            gears = given.get((name, flank), ())
            teeth[side, sign] = IdealTeeth(table)
            if any(gear.any() for gear in gears):
                teeth[side, sign] = DeviatingTeeth(PairLaw(pair_law, table), *gears)
    return teeth
