"""Passivity of flanges: what a small oscillation gets out of a part, over its own motion.

Two runs are compared, with and without the oscillation, so that what a source gives anyway drops
out. From the same state the work of the differences is never negative if the part is passive. The
loss angle is that work per cycle over pi times both amplitudes; a part of stiffness k and damping c
has c w / k, an inertia J with friction d has d / (J w), and what answers late by T has -w T.

Sources: J. C. Willems, Arch. Rational Mech. Anal. 45 (1972) 321-351 (passivity); C. A. Desoer and
M. Vidyasagar, Feedback Systems (1975), section VI (incremental passivity).
"""

from collections.abc import Mapping

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested
from herringbone.analysis.flange.answers import TORQUE
from herringbone.analysis.flange.bench import Bench, Record, Signal
from herringbone.analysis.flange.motions import burst
from herringbone.analysis.flange.variables import Flange
from herringbone.cosim.signature.trial import check_length

PERIODS = (40, 64, 100, 160, 250, 400, 640, 1000, 1600, 2560)
"""Of the oscillations, in steps; close together, as a late control is active in a band only."""
CYCLES = 4
_WINDOW = 0.375
"""Mean square of a Hann window."""
ANGLE = 1e-3
"""Amplitude of motions [rad]."""
LOSS = 2e-3
"""Negative loss angle [rad] that is allowed at any frequency."""
LAG = 0.6
"""Lag, in steps, that is allowed besides: Euler's rule is half a step late."""
EULER = 0.05
"""Negative damping over stiffness times step that is allowed, too: Euler's rule in fine steps."""


def kept(longest: int) -> tuple[int, ...]:
    """Those periods whose oscillations fit into runs of so many steps."""
    return tuple(period for period in PERIODS if CYCLES * period <= longest)


def periods(bench: Bench) -> tuple[int, ...]:
    """Those periods that the bench allows; raises Refused if it allows none."""
    check_length(CYCLES * PERIODS[0], bench.longest)
    return kept(bench.longest)


def records(flanges: int) -> int:
    """Oscillations of each period: of each flange, and two of each pair of flanges."""
    return flanges + 2 * (flanges - 1)


def _band(bench: Bench) -> str:
    """Frequencies of the test."""
    low, high = (1.0 / (n * bench.step) for n in (periods(bench)[-1], periods(bench)[0]))
    return f"{low:.3g} to {high:.3g} Hz"


def passivity(bench: Bench) -> Finding:
    """No oscillation gets work out of any flange, nor of two that move a quarter period apart.

    Raises Refused.
    """
    test = "passivity"
    if not _known(bench):
        return not_tested(test, "its feedthrough is not known")
    lowest: tuple[float, float, float] | None = None
    for period in reversed(periods(bench)):
        limit = LOSS + LAG * 2.0 * np.pi / period
        for signals in _oscillations(bench, period * bench.step):
            loss = loss_angle(bench, signals, CYCLES * period)
            if loss is not None and (lowest is None or loss / limit < lowest[0]):
                lowest = loss / limit, loss, 1.0 / (period * bench.step)
    if lowest is None:
        return not_tested(test, "no torque moves it, and no motion changes its torque")
    relative, loss, frequency = lowest
    shown = (
        "no negative work" if loss >= 0.0 else f"loss angle {loss:.2g} rad at {frequency:.3g} Hz"
    )
    if len(periods(bench)) < len(PERIODS):
        shown += f"; nothing is known below {1.0 / (periods(bench)[-1] * bench.step):.3g} Hz"
    allowed = f"-{LOSS:g} rad - {LAG:g} step - {EULER:g} k H, {_band(bench)}"
    return judged(test, relative >= -1.0, shown, allowed)


def _known(bench: Bench) -> bool:
    """True if what passes directly to the torques is known."""
    passed = (
        bench.passes(of, flange.tau, q)
        for flange in bench.flanges
        if not flange.takes_torque
        for of in bench.flanges
        for q in (("tau",) if of.takes_torque else ("phi", "w"))
    )
    return not np.isnan(list(passed)).any()


def _oscillations(bench: Bench, period: float) -> list[Mapping[str, Signal]]:
    def at(flange: Flange, phase: float = 0.0) -> Signal:
        return burst(TORQUE if flange.takes_torque else ANGLE, period, CYCLES, phase)

    single: list[Mapping[str, Signal]] = [{flange.name: at(flange)} for flange in bench.flanges]
    pairs = zip(bench.flanges, bench.flanges[1:], strict=False)
    both = [
        {one.name: at(one), other.name: at(other, sign * 0.5 * np.pi)}
        for one, other in pairs
        for sign in (1.0, -1.0)
    ]
    return single + both


def loss_angle(bench: Bench, signals: Mapping[str, Signal], steps: int) -> float | None:
    """Lowest work since the start as loss angle; None if nothing answers."""
    apart = bench.change(signals, steps)
    work, scale = np.zeros(steps), 0.0
    for flange in bench.flanges:
        if flange.name in signals:
            torque, angle = _ends(flange, signals[flange.name], apart)
            work += 0.5 * (torque[1:] + torque[:-1]) * np.diff(angle)
            scale += float(np.abs(torque).max() * np.ptp(angle)) / 2.0
            if not flange.takes_torque:
                stiffness = abs(bench.passes(flange, flange.tau, "phi"))
                work += EULER * stiffness * np.diff(angle) ** 2
    if scale == 0.0:
        return None
    return min(0.0, float(np.cumsum(work).min())) / (np.pi * _WINDOW * CYCLES * scale)


def _ends(flange: Flange, signal: Signal, apart: Record) -> tuple[np.ndarray, np.ndarray]:
    """Torque on the part and angle of a flange, each (n + 1,), at the ends of steps."""
    values = signal(apart.h * np.arange(len(apart.outputs)))
    if flange.takes_torque:
        return values, apart.of(flange.phi)
    return -apart.of(flange.tau), values
