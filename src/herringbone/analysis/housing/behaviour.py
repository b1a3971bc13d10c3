"""How a housing behaves from rest: the tests of the contract, and the force records they use.

The work over a step with held forces is the force times the change of the positions, exactly.

Source: J. C. Willems, Arch. Rational Mech. Anal. 45 (1972) 321-351 (passivity).
"""

from collections.abc import Callable

import numpy as np

from herringbone.analysis.finding import Finding, judged, remark
from herringbone.analysis.housing.runs import FORCES, POSITIONS, VELOCITIES, Runs
from herringbone.analysis.housing.statics import judge_statics, mean_response
from herringbone.core.wording import percent

RECORDS = 20
"""Random force records of the test of passivity."""
_FORCE = 1000.0
_SETTLING, _RECORD = 2500, 400
"""Steps of a step response and of a random record."""
SHORT = 2 * _RECORD
"""Steps of the longest run besides those that wait for a housing to settle."""
_BAND_HZ = (50.0, 2000.0)
_SINES = 6

RECIPROCITY_ERROR = 0.01
SUPERPOSITION_ERROR = 1e-3
NEGATIVE_WORK = 1e-3
HALVING_CHANGE = 0.01
VELOCITY_ERROR = 0.1
"""Semi-implicit Euler in steps of 20 us has 5 % at 800 Hz."""
LEAST_PROMPTNESS = 0.1
"""Share of the velocity after two steps that is there after one; 0 if the answer comes late."""
_UNDAMPED, _GROWN = 0.9, 1.1
"""Vibration at the end over that at the start: next to no damping above, negative damping above."""
OTHER_SIZE = 100.0
"""Factor between the compliances of two housings of gearboxes that asks for a look at the units."""
FEEDTHROUGH_RATIO = 0.75
"""Largest share of a step's deflection that half the step may give; a mass alone gives 1/4."""


class Behaviour:
    """The tests; responses to single forces are computed once. All raise Refused.

    Args:
        runs: of the housing.
    """

    def __init__(self, runs: Runs) -> None:
        self._runs, self._step = runs, runs.step
        self._responses: np.ndarray | None = None

    @property
    def _unit_responses(self) -> np.ndarray:
        """(12, n + 1, 12): positions after a step of 1 N at each force."""
        if self._responses is None:
            eye = _FORCE * np.eye(len(FORCES))
            runs = [self._runs.positions(np.tile(force, (_SETTLING, 1))) for force in eye]
            self._responses = np.array(runs) / _FORCE
        return self._responses

    def feedthrough(self) -> Finding:
        """The deflection after one step vanishes with the step; a feedthrough would stay."""
        force = np.full((1, len(FORCES)), _FORCE)
        steps = self._step, self._step / 2.0
        whole, half = (np.abs(self._runs.positions(force, h)[1]) for h in steps)
        ratio = float((half / np.where(whole > 0.0, whole, np.inf)).max())
        holds = ratio <= FEEDTHROUGH_RATIO
        return judged(
            "no feedthrough", holds, f"s(h/2) / s(h) = {ratio:.2f}", f"{FEEDTHROUGH_RATIO:g}"
        )

    def delay(self) -> Finding:
        """Velocities after one step under a force are those after two, over 2 for a mass."""
        forces = np.full((2, len(FORCES)), _FORCE)
        one, two = np.abs(self._runs.outputs(forces, VELOCITIES)[1:])
        ratio = float(one.max() / two.max()) if two.any() else 0.0
        holds = ratio >= LEAST_PROMPTNESS
        return judged("no delay", holds, f"v(h) / v(2h) = {ratio:.2f}", f"{LEAST_PROMPTNESS:g}")

    def velocities(self) -> Finding:
        """The integral of the velocities is the change of the positions: by Simpson's rule."""
        names = (*POSITIONS, *VELOCITIES)
        found = self._runs.outputs(random_forces(1, self._step), names)
        s, v = np.split(found, 2, axis=1)
        pieces = (v[:-2:2] + 4.0 * v[1:-1:2] + v[2::2]) * self._step / 3.0
        integral, change = np.cumsum(pieces, axis=0), s[2::2] - s[0]
        error = float(np.abs(integral - change).max()) / float(np.abs(s).max())
        holds = error <= VELOCITY_ERROR
        shown = f"off by {percent(error)}"
        if not holds and change.any():
            shown += f"; v is {float((integral * change).sum() / (change**2).sum()):.4g} of it"
        return judged("v = ds/dt", holds, shown, f"{100 * VELOCITY_ERROR:g} %")

    def damping(self) -> Finding:
        """Whether vibration after a push dies out; it may stay, but must not grow."""
        forces = np.zeros((2 * _SETTLING, len(FORCES)))
        forces[0] = _FORCE
        speed = np.abs(self._runs.outputs(forces, VELOCITIES)[1:])
        part = len(speed) // 4
        left = float(np.sqrt((speed[-part:] ** 2).mean() / (speed[:part] ** 2).mean()))
        shown = f"{percent(left)} left after {1e3 * 2 * _SETTLING * self._step:.3g} ms"
        limit = f"{100 * _GROWN:g} %; none is legal"
        if left > _GROWN:
            return judged("damping", False, f"{shown}: negative damping", limit)
        if left > _UNDAMPED:
            return remark("damping", f"{shown}: next to no damping", limit)
        return judged("damping", True, shown, limit)

    def zero(self) -> Finding:
        """Nothing moves without force."""
        found = self._runs.outputs(np.zeros((_RECORD, len(FORCES))), (*POSITIONS, *VELOCITIES))
        largest = float(np.abs(found).max())
        return judged("zero stays zero", largest == 0.0, f"{largest:g}", "0")

    def statics(self, static: np.ndarray | None) -> Finding:
        """See `judge_statics`; what does not settle at once is asked for longer."""
        return judge_statics(self._runs, self._unit_responses, _FORCE, static)

    @property
    def compliance(self) -> float:
        """Largest static compliance of a seat, along the force [m/N]."""
        return float(np.abs(mean_response(self._unit_responses).diagonal()).max())

    def size(self, usual: float | None) -> Finding:
        """How far seats give way, against another housing [m/N]; wrong units show here."""
        found = self.compliance
        shown = f"at most {found:.3g} m/N"
        if usual is None:
            return judged("compliance", True, shown, "")
        limit = f"{1 / OTHER_SIZE:g} to {OTHER_SIZE:g} times {usual:.3g} m/N, that of the usual one"
        if usual / OTHER_SIZE <= found <= usual * OTHER_SIZE:
            return judged("compliance", True, shown, limit)
        times = f"{found / usual:.3g} times {usual:.3g} m/N"
        return remark("compliance", f"{shown}, {times}: check units (m, m/s, N)", limit)

    def reciprocity(self) -> Finding:
        """A force at i moves j as the same force at j moves i."""
        responses = self._unit_responses
        error = float(np.abs(responses - responses.transpose(2, 1, 0)).max())
        error /= float(np.abs(responses).max())
        holds = error <= RECIPROCITY_ERROR
        return judged(
            "reciprocity", holds, f"off by {percent(error)}", f"{100 * RECIPROCITY_ERROR:g} %"
        )

    def superposition(self) -> Finding:
        """The response to all forces at once is the sum of the single ones."""
        forces = _FORCE * np.random.default_rng(1).standard_normal(len(FORCES))
        together = self._runs.positions(np.tile(forces, (_SETTLING, 1)))
        expected = np.tensordot(forces, self._unit_responses, axes=1)
        error = float(np.abs(together - expected).max() / np.abs(expected).max())
        holds = error <= SUPERPOSITION_ERROR
        limit = f"{100 * SUPERPOSITION_ERROR:g} %"
        return judged("superposition", holds, f"off by {percent(error)}", limit)

    def passivity(self) -> Finding:
        """Work from rest is never negative."""
        lowest = min(least_work(self._runs.positions, seed, self._step) for seed in range(RECORDS))
        holds = lowest >= -NEGATIVE_WORK
        shown = f"{lowest:.1g} of the highest work" if lowest < 0.0 else "no negative work"
        return judged("passivity", holds, shown, f"-{NEGATIVE_WORK:g}, {RECORDS} records")

    def halving(self) -> Finding:
        """The rms of the positions at half the step, under the same forces."""
        forces = random_forces(0, self._step)
        whole = self._runs.positions(forces)[1:]
        half = self._runs.positions(np.repeat(forces, 2, axis=0), self._step / 2.0)[2::2]
        change = float(abs(_rms(half) / _rms(whole) - 1.0))
        holds = change <= HALVING_CHANGE
        return judged(
            "step halving", holds, f"rms changes by {percent(change)}",
            f"{100 * HALVING_CHANGE:g} %",
        )  # fmt: skip


def steps_of_tests() -> int:
    """Steps that all tests take but for a few: to settle, and in records."""
    settling = len(FORCES) + 1 + 2  # single forces, all of them, and vibration
    return settling * _SETTLING + (RECORDS + 5) * _RECORD


def random_forces(seed: int, step: float, steps: int = _RECORD) -> np.ndarray:
    """Smooth random forces (steps, 12) [N] that begin at zero."""
    random = np.random.default_rng(seed)
    low, high = np.log(_BAND_HZ)
    w = 2.0 * np.pi * np.exp(random.uniform(low, high, (_SINES, len(FORCES))))
    amplitude = _FORCE * random.standard_normal((_SINES, len(FORCES)))
    phase = random.uniform(0.0, 2.0 * np.pi, (_SINES, len(FORCES)))
    t = step * np.arange(steps)[:, None, None]
    return (amplitude * (np.sin(w * t + phase) - np.sin(phase))).sum(axis=1)


def least_work(run: Callable[[np.ndarray], np.ndarray], seed: int, step: float) -> float:
    """Lowest work of a random record since rest, over the highest.

    Args:
        run: positions (n + 1, 12) [m] under held forces (n, 12) [N].
        seed: of the record.
        step: communication step size [s].
    """
    forces = random_forces(seed, step)
    work = np.cumsum((forces * np.diff(run(forces), axis=0)).sum(axis=1))
    return float(work.min() / np.abs(work).max())


def _rms(values: np.ndarray) -> float:
    return float(np.sqrt((values**2).mean()))
