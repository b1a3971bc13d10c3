"""Whether the speed of a flange is the rate of its angle.

Of a body: changes of the angle under oscillating torques are fitted by phi = r I + lag w, with I
the integral of the speed by the trapezoidal rule. r is 1 if the speed is the rate; lag is by how
much it comes later: a speed behind a filter of first order lags by its time constant, exactly.
A part that takes angle and speed shows it only if it turns on by itself inside a step.
"""

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested
from herringbone.analysis.flange.answers import TORQUE
from herringbone.analysis.flange.bench import Bench
from herringbone.analysis.flange.motions import burst, constant, turn
from herringbone.analysis.flange.variables import Flange
from herringbone.analysis.flange.work import CYCLES, periods
from herringbone.core.declaring.units import R_MIN
from herringbone.core.wording import percent
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import NOT_TRIED

TEST = "w = dphi/dt"
RATIO = 0.01
ADDED = 0.05
"""The feedthrough that is taken off is known to a few percent."""
LAG = 0.6
"""Steps; a part that takes one step of Euler's rule in each is off by half of one."""
RESIDUAL = 0.02
HINT = 0.05
EVERY = 3
"""Of the periods of the test of passivity one in so many is taken."""
_TURNS = 1.5
SPIN = 1000
"""Steps in which a body is turned by that many turns."""
_MOST = 1e6
"""Torque [N m] beyond which it is not tried."""
_FULL = 2.0 * np.pi
_JUMP = 0.5
_ALONE = 8.0
"""Change of a torque in a step over those beside it that is a jump."""


def rate(bench: Bench, flange: Flange) -> Finding:
    """The speed of a flange is the rate of its angle; raises Refused."""
    if flange.takes_torque:
        return _of_body(bench, flange)
    if not flange.phi or not flange.w:
        return not_tested(TEST, "it does not take both")
    return _of_element(bench, flange)


def _of_body(bench: Bench, flange: Flange) -> Finding:
    limit = f"r = 1 +- {RATIO:g}, lag {LAG:g} step"
    phi, integral, speed = [], [], []
    for period in reversed(periods(bench)[::EVERY]):  # the longest run at rest is kept
        size = TORQUE if period < 100 else 0.1 * TORQUE
        signal = burst(size, period * bench.step, CYCLES)
        apart = bench.change({flange.name: signal}, CYCLES * period)
        angle, w = apart.of(flange.phi), apart.of(flange.w)
        scale = float(np.abs(angle).max())
        if scale == 0.0 and not w.any():
            continue
        scale = scale or 1.0
        phi.append((angle - angle[0]) / scale)
        integral.append(_integral(w, bench.step) / scale)
        speed.append((w - w[0]) / scale)
    if not phi:
        return not_tested(TEST, f"{TORQUE:g} N m does not move it")
    r, lag, rest = _fit(np.concatenate(phi), np.concatenate(integral), np.concatenate(speed))
    holds = abs(r - 1.0) <= RATIO and abs(lag) <= LAG * bench.step and rest <= RESIDUAL
    return judged(TEST, holds, _shown(r, lag, rest), limit)


def _integral(values: np.ndarray, h: float) -> np.ndarray:
    steps = 0.5 * h * (values[1:] + values[:-1])
    return np.concatenate([[0.0], np.cumsum(steps)])


def _fit(phi: np.ndarray, integral: np.ndarray, speed: np.ndarray) -> tuple[float, float, float]:
    """r, lag [s], and what is left over what is fitted."""
    columns = np.column_stack([integral, speed])
    if not columns.any():
        return 0.0, 0.0, 1.0
    (r, lag), *_ = np.linalg.lstsq(columns, phi, rcond=None)
    rest = np.linalg.norm(phi - columns @ [r, lag]) / max(float(np.linalg.norm(phi)), 1e-300)
    return float(r), float(lag / r) if r else 0.0, float(rest)


def _shown(r: float, lag: float, rest: float) -> str:
    if rest > RESIDUAL:
        return f"w is not the rate: {percent(rest)} of phi is something else"
    if r == 0.0:
        return "phi does not move with w"
    shown = f"w is {1.0 / r:.5g} of it"
    shown += hint(1.0 / r)
    return f"{shown}, {1e6 * abs(lag):.3g} us {'late' if lag >= 0.0 else 'early'}"


def hint(factor: float) -> str:
    """Which units a factor of a speed tells of."""
    known = {R_MIN: "r/min?", 0.5 / np.pi: "turns?", np.pi / 180.0: "degrees?"}
    close = (unit for size, unit in known.items() if abs(abs(factor) / size - 1.0) < HINT)
    return next((f" ({unit})" for unit in close), "")


def _of_element(bench: Bench, flange: Flange) -> Finding:
    """What a part that turns on by itself adds to its angle, over w times the step."""
    limit = f"1 +- {ADDED:g}"
    stiffness = bench.passes(flange, flange.tau, "phi")
    given = bench.given(flange)
    if given is InputRule.MEAN or not stiffness or not np.isfinite(stiffness):
        return not_tested(TEST, "its torque does not tell: it holds the angle during a step")
    column = bench.signature.inputs.index(flange.w)
    factor = flange.factors["w"]
    found = []
    for h in (bench.step, 0.5 * bench.step):
        changed = bench.lab.start.copy()
        changed[column] += 1.0 / factor
        apart = bench.lab.run([changed], h)[-1] - bench.lab.at_rest(h)
        row = bench.signature.outputs.index(flange.tau)
        found.append(float(apart[row]) * flange.factors["tau"])
    damping = bench.passes(flange, flange.tau, "w")
    if given is InputRule.END:  # it goes back from the end value; only its states see w
        return not_tested(TEST, "its torque hardly tells: it runs up to the angle given")
    whole, half = (found[0] - damping) / bench.step, 2.0 * (found[1] - damping) / bench.step
    r = (2.0 * half - whole) / stiffness
    shown = f"inside a step it turns by {r:.4g} w"
    return judged(TEST, abs(r - 1.0) <= ADDED, shown, limit)


def turns(bench: Bench, flange: Flange) -> Finding:
    """The angle counts turns: it is not wrapped, and does not drift from the integral of w."""
    test, limit = "angle over turns", f"follows r w within {100 * RESIDUAL:g} %"
    if not flange.takes_torque:
        return _turned(bench, flange, test)
    torque = _torque_for_turns(bench, flange)
    if not 0.0 < torque < _MOST:
        return not_tested(test, f"{TORQUE:g} N m hardly turns it")
    try:
        found = bench.run({flange.name: constant(torque)}, SPIN)
    except NOT_TRIED as error:
        return not_tested(test, str(error))
    angle, w = found.of(flange.phi), found.of(flange.w)
    integral = _integral(w, bench.step)
    if (np.abs(np.diff(angle) - np.diff(integral)) > 0.5 * _FULL).any():
        return judged(test, False, "it jumps by a turn: it is wrapped", limit)
    reached = float(np.abs(integral).max())
    if reached < _FULL:
        return not_tested(test, f"{torque:.3g} N m turn it by {reached:.3g} rad only")
    rest = _fit(angle - angle[0], integral, w - w[0])[2]
    shown = f"off by {percent(rest)} over {reached / _FULL:.2g} turns"
    return judged(test, rest <= RESIDUAL, shown, limit)


def _turned(bench: Bench, flange: Flange, test: str) -> Finding:
    """The torque of a part that is turned, both ends alike, by more than a turn does not jump."""
    stiffness = abs(bench.passes(flange, flange.tau, "phi"))
    if not stiffness or not np.isfinite(stiffness):
        return not_tested(test, "its torque does not follow the angle directly")
    signal = turn(_FULL * _TURNS, SPIN * bench.step)
    signals = {f.name: signal for f in bench.flanges if not f.takes_torque}
    steps = np.abs(np.diff(bench.change(signals, SPIN).of(flange.tau)))
    beside = np.maximum(steps[:-2], steps[2:])
    alone = np.where(steps[1:-1] > _ALONE * beside, steps[1:-1], 0.0)
    share = float(alone.max()) / (stiffness * _FULL)
    shown = f"jumps of the torque up to {percent(share)} of k 2 pi"
    return judged(test, share <= _JUMP, shown, f"{100 * _JUMP:g} %")


def _torque_for_turns(bench: Bench, flange: Flange) -> float:
    """Torque [N m] that turns a free body by the turns of the test."""
    few = 4
    speed = bench.change({flange.name: constant(TORQUE)}, few).of(flange.w)[-1]
    seconds = SPIN * bench.step
    needed = 2.0 * _FULL * _TURNS / seconds**2
    return float(TORQUE * needed * few * bench.step / abs(speed)) if speed else 0.0
