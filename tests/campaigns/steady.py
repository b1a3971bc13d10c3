"""Steady states of drawn pairs with real teeth against marches until they have settled.

    python -m campaigns.steady [COUNT [SEED [TOLERANCE]]]

in tests/; the seed is the last commit's. Each draw is a pair of `TEETH` of a class from 5 to 8 in
the test rig at a drawn speed and torque, a third of them so small that teeth may separate. A line
for each: what was found, by which solver, in how much CPU time; and by how much a march of finer
steps differs from it, over the alternating part of the worst group of channels: one that goes on
from the state for two periods ("stays"), and one from equilibrium that has settled for as long as
the state says or 0.5 s, over its last period ("comes"). The first has to stay within the tolerance.
The second tells whether there is another motion; where none was found it must not repeat, either.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from fuzz.campaign import last_commit

import herringbone as hb
from campaigns.plans import tell
from herringbone.analysis.steady.guess import beginnings, standing
from herringbone.analysis.steady.harmonic_balance.fourier import in_time
from herringbone.analysis.steady.marching.marched import Held, start_of
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.fused.core import Steps
from herringbone.core import HerringboneError
from herringbone.core.one_thread import one_blas_thread

TEETH = ((19, 67), (19, 30), (20, 85), (23, 71))
GROUPS = ("bearing_force", "seat_velocity")
PER_MESH, STEP, SETTLING = 128, 5e-6, 0.5
_ALIGNED = 8
"""Steps of the search for the place in a period at which theta is; its swings are small."""
RATTLES = 10.0
"""Change from one period to the next, over the tolerance, from which on nothing repeats."""
PAIR = """[gear_pair]
number_of_teeth = [{0}, {1}]
normal_module = "4 mm"
helix_angle = "{2} deg"
face_width = "45 mm"
gap_width = "40 mm"
stub_length = "60 mm"
shaft_diameter = ["45 mm", "60 mm"]
[mesh]
backlash = "120 um"
damping_ratio = {3}
[table]
torque = "200 N m"
method = "coupled-slices"
phases = 16
[deviations]
grade = {4}
seed = {5}
"""


class Marched:
    """A march of short steps under what is given of a state.

    Args:
        state: at whose operating point it is.
        begin: coordinates and theta to begin from.
        ramp: turns of the first pinion over which deviations come in.
    """

    def __init__(self, state: hb.SteadyState, begin: np.ndarray, ramp: float = 0.0) -> None:
        core, steps = state.structure.core, Steps(STEP, 4, 1e-9, lean=False)
        signals = state.motion.given[:-1, 0].real.copy()
        known = core.condensed
        held = Held(core.twin, known.equations, known.modes, signals, ramp)
        self._run = Solution(held, steps.degree, steps.close)
        self._run.state.q[: begin.size] = begin
        self._columns = [c for group in GROUPS for c in state.chosen(group)]
        self._outputs = core.outputs(self._columns, steps, inside=False)
        self._places = PER_MESH * state.meshes
        self._gap, self._gone = state.period / self._places, 0

    def on(self, periods: float) -> np.ndarray:
        """Go on; columns (columns, places) of the last period."""
        end = self._gone + round(periods * self._places)
        times = (end - self._places + np.arange(self._places)) * self._gap
        step = self._gap / np.ceil(self._gap / STEP)
        begin, self._gone = self._gone * self._gap, end
        with one_blas_thread():
            parts = [
                self._outputs.values(self._run, part)
                for part in self._run.piece(begin, end * self._gap, step, times)
            ]
        return np.concatenate(parts).T


def differs(state: hb.SteadyState, values: np.ndarray, expected: np.ndarray) -> float:
    """Of the worst group, over its alternating part."""
    first, worst = 0, 0.0
    for group in GROUPS:
        own = slice(first, first + len(state.chosen(group)))
        first = own.stop
        off = values[own] - expected[own]
        whole = expected[own] - expected[own].mean(axis=1, keepdims=True)
        worst = max(worst, float(np.linalg.norm(off) / np.linalg.norm(whole)))
    return worst


def expected_of(state: hb.SteadyState) -> np.ndarray:
    """Columns (columns, places) of a state over its period."""
    found = state.harmonics([c for group in GROUPS for c in state.chosen(group)])
    places = PER_MESH * state.meshes
    told = found.orders < places // 2  # lines beyond would be taken for lower ones
    return in_time(found.coefficients[:, told], found.orders[told], places)


def turned_to(state: hb.SteadyState, run: Marched, values: np.ndarray) -> np.ndarray:
    """Values (columns, places) of a period from when theta is that of the state's start."""
    own = run._run.state.q  # theta at the end of the last period, which begins it
    theta = float(own[2 * state.structure.core.condensed.modes.rates.size])
    angle, orders, late = state.orbit.angle, state.orbit.response.orders, 0.0
    for _ in range(_ALIGNED):
        swing = angle[0] + 2.0 * (angle[1:] * np.exp(2j * np.pi * late * orders[1:])).sum()
        late = (theta - float(swing.real)) / state.motion.turn % 1.0
    places = values.shape[1]
    turning = np.exp(-2j * np.pi * late * np.arange(places // 2 + 1))
    return np.fft.irfft(np.fft.rfft(values, axis=1) * turning, places, axis=1)


def comes(state: hb.SteadyState) -> tuple[float, float]:
    """By how much what a march from equilibrium comes to differs, and changes in a period.

    Raises:
        HerringboneError: no march from equilibrium goes on.
    """
    structure = state.structure
    with one_blas_thread():
        still = standing(structure, state.motion)
        starts = list(beginnings(structure, state.motion, still))
    failed = HerringboneError("no march from equilibrium")
    for begin, ramp in starts:
        run = Marched(state, start_of(begin), ramp)
        settling = max(SETTLING, state.settled.time if state.settled else 0.0) / state.period
        try:
            before = run.on(np.ceil(settling) + ramp / abs(structure.turns_of_pinion))
            after = run.on(1.0)
        except HerringboneError as error:
            failed = error
            continue
        changes = differs(state, after, before)
        if not state.converged:
            return np.nan, changes
        return differs(state, turned_to(state, run, after), expected_of(state)), changes
    raise failed


def draw(random: np.random.Generator, folder: Path, tolerance: float) -> tuple[str, bool]:
    """A line on a drawn case, and whether it is as it should be."""
    teeth = TEETH[random.integers(len(TEETH))]
    grade, seed = int(random.integers(5, 9)), int(random.integers(1000))
    helix, damping = float(random.uniform(15.0, 30.0)), float(random.uniform(0.05, 0.1))
    speed = float(random.uniform(400.0, 3000.0))
    light = random.uniform() < 1.0 / 3.0
    torque = float(np.exp(random.uniform(*np.log((5.0, 40.0) if light else (40.0, 300.0)))))
    gear = folder / "pair.toml"
    gear.write_text(PAIR.format(*teeth, helix, damping, grade, seed))
    said = (
        f"{teeth[0]}/{teeth[1]} {helix:.1f} deg class {grade} seed {seed} zeta {damping:.3f} "
        f"{speed:.1f} r/min {torque:.1f} N m:"
    )
    begin = time.process_time()
    try:
        state = hb.steady(
            "test_rig", gear=gear, speed=speed * np.pi / 30.0, torque=torque, tolerance=tolerance
        )
    except HerringboneError as error:
        return f"{said} {error}", False
    took = time.process_time() - begin
    off, changes = comes(state)
    if not state.converged:
        rattles = changes > RATTLES * tolerance
        known = f"; from equilibrium it changes by {changes:.1e} per period"
        said += f" {'RATTLES' if rattles else 'NOT FOUND'}, {took:.1f} s, {state.notes[0]}{known}"
        return said, rattles
    begun = Marched(state, start_of(state.orbit)).on(2.0)
    stays = differs(state, begun, expected_of(state))
    bends = "bends" if state.bends else "loaded"
    return (
        f"{said} {state.solver}, {state.meshes} meshes, {bends}, {took:.1f} s, "
        f"error {state.error:.1e}, stays {stays:.1e}, comes {off:.1e} "
        f"(changes by {changes:.1e} per period)"
    ), stays <= tolerance


def main(count: int, seed: str, tolerance: float) -> int:
    """Print a line for each draw; the number of those that are not as they should be."""
    tell(f"seed {seed}, tolerance {tolerance:g}")
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for k in range(count):
            random = np.random.default_rng([int(seed[:12], 16), k])
            line, good = draw(random, Path(folder), tolerance)
            bad += not good
            tell(f"{k + 1}: {line}")
    tell(f"{count - bad} of {count}")
    return bad


if __name__ == "__main__":
    given = sys.argv[1:]
    wanted = int(given[0]) if given else 20
    name = given[1] if len(given) > 1 else last_commit()
    sys.exit(bool(main(wanted, name, float(given[2]) if len(given) > 2 else 1e-4)))
