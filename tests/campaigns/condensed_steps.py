"""What systems as one component err over their tolerance, by the steps of the condensed core.

    python -m campaigns.condensed_steps [COUNT [SEED]]

in tests/; the seed is the last commit's. COUNT speeds and torques (40 if not given) of the test rig
are drawn for each of three pairs, over 10 ms in communication steps of 0.1 and 1 ms; then teeth
meet and part in three scenes, in communication steps of many lengths, some of them drawn. Errors
are those of the worse group of channels, against Dormand and Prince on the plain equations. They
must be at most twice the tolerance. With COUNT 0 there are the scenes alone.
"""

import random
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from fuzz.campaign import last_commit
from support.gearing.own_pair import write_pair
from support.rig.as_one import instance_of

from campaigns.plans import tell
from herringbone.analysis.accuracy.apart import differences
from herringbone.analysis.twin.block_core.steps import TOLERANCE
from herringbone.analysis.twin.composite import make_composite
from herringbone.analysis.twin.fused.core import Core
from herringbone.analysis.twin.monolithic import Twin
from herringbone.cosim.structure.system import System
from herringbone.running.prepared import Wishes, prepared

SPEED, TORQUE = "bench_controller.speed_factor", "bench_controller.torque_factor"
SPEEDS, TORQUES = (0.5, 3.0), (0.3, 3.0)
"""Times 1000 r/min and 200 N m."""
TOLERANCES, MOST = (1e-3, 1e-4, 1e-5, 1e-7, 1e-8), 2.0
EXACT = 1e-13
"""Tolerance of the equations' solution; on `on_ground` it errs 1e-9."""
WINDOW, STEPS = 0.01, (100, 1000)
PARTING = (
    ("on_ground", "gradual", 0.04),
    ("test_rig", "separation", 0.01),
    ("boosted_axle", "engaging", 0.01),
)
"""Systems, scenes, and the time [s] over which they are looked at."""
USUAL, DRAWN, SHORTEST, LONGEST = (5, 8, 10, 15, 20, 30, 50, 100, 1000), 4, 4.0, 150.0
"""Communication steps [us]: those that are looked at, how many are drawn besides, and between which
limits."""
SHIP = Path(__file__).parents[2] / "system_models" / "ship" / "ship_pair.toml"


class Box:
    """A system as one component.

    Args:
        system: its parts.
        folder: for the resource files.
        like: of another operating point; its kernel is taken.
    """

    def __init__(self, system: System, folder: Path, like: "Box | None" = None) -> None:
        composite = make_composite(system)
        self.instance = instance_of(composite, folder, "box")
        self.instance.initialise()
        self.kernel = like.kernel if like else composite.component.kernels.step
        self.index = composite.component.declaration.index
        self.groups = Core(system).groups()
        self.names = list(dict.fromkeys(n for names in self.groups.values() for n in names))
        self.twin, self.start = Twin(system), self.instance.block.copy()

    def run(self, times: np.ndarray, tolerance: float) -> np.ndarray:
        """Values (times, names) in equal steps [s] from the start on."""
        block, places = self.instance.block, [self.index[name] for name in self.names]
        block[:], self.instance.work[:] = self.start, 0.0
        block[self.index[TOLERANCE]] = tolerance
        rows = [block[places]]
        for t in times[:-1]:
            if self.kernel(block, self.instance.work, t, times[1] - times[0]) != 0:
                return np.full((times.size, len(places)), np.nan)
            rows.append(block[places])
        return np.array(rows)

    def exact(self, times: np.ndarray) -> np.ndarray:
        """Values (times, names) by Dormand and Prince."""
        return self.twin.solve(times, self.names, EXACT)

    def errors(self, end: float, steps: Sequence[float]) -> Iterator[tuple[float, float, float]]:
        """Steps [us], tolerance, and what is erred over it."""
        for step in steps:
            times = 1e-6 * step * np.arange(round(end / (1e-6 * step)) + 1)
            exact = self.exact(times)
            for tolerance in TOLERANCES:
                found = differences(self.run(times, tolerance), exact, self.names, self.groups)
                yield step, tolerance, max(found.groups.values()) / tolerance


def _pairs(folder: Path) -> dict[str, Path | None]:
    return {"27/81": None, "23/57": write_pair(folder / "own.toml"), "31/77": SHIP}


def _drawn(count: int, seed: str, folder: Path) -> int:
    missed = 0
    for pair, gear in _pairs(folder).items():
        chance, first = random.Random(f"{seed} {pair}"), None
        errors: dict[tuple[float, float], list[float]] = {}
        for _ in range(count):
            values = {SPEED: chance.uniform(*SPEEDS), TORQUE: chance.uniform(*TORQUES)}
            system = prepared("test_rig", "loaded", Wishes(values=values, gear=gear)).system
            first = first or Box(system, folder)
            for step, tolerance, error in Box(system, folder, first).errors(WINDOW, STEPS):
                errors.setdefault((step, tolerance), []).append(error)
                if not error <= MOST:
                    missed += 1
                    tell(f"  {pair} {values}, {step} us, {tolerance:g}: {error:.3g}: missed")
        for (step, tolerance), of in errors.items():
            low, middle, high = np.quantile(of, (0.0, 0.5, 1.0))
            tell(f"{pair}, {step} us, {tolerance:g}: {low:.2g}, {middle:.2g}, {high:.2g}")
    return missed


def _parting(seed: str, folder: Path) -> int:
    missed = 0
    for name, scene, end in PARTING:
        chance = random.Random(f"{seed} {name} {scene}")
        drawn = [SHORTEST * (LONGEST / SHORTEST) ** chance.random() for _ in range(DRAWN)]
        box = Box(prepared(name, scene, Wishes()).system, folder)
        for step, tolerance, error in box.errors(end, (*USUAL, *drawn)):
            bad = not error <= MOST
            missed += bad
            line = f"{name} {scene}, {step:.6g} us, {tolerance:g}: {error:.2g}"
            tell(line + (": missed" if bad else ""))
    return missed


def main(count: int, seed: str) -> int:
    """Run the campaign; how many errors are too large."""
    tell(f"seed {seed}, {count} points: least, middle and largest error over the tolerance")
    with tempfile.TemporaryDirectory() as name:
        missed = _drawn(count, seed, Path(name)) + _parting(seed, Path(name))
    tell(f"{missed} missed")
    return missed


if __name__ == "__main__":
    given = sys.argv[1:]
    sys.exit(min(1, main(int(given[0]) if given else 40, given[1] if given[1:] else last_commit())))
