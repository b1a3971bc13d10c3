"""The rotation test: what of a flange's answer at a fixed time depends on the step.

The flange turns evenly, at the part's own speed or 1 rad/s faster if that is slow; torques at fixed
times are found in steps of H, H/2 and H/4. With y(H) = y + a H + b H^2 the three give a H. Of a
part of stiffness k it may be 2 % of k w H: an angle that is held wrongly gives half of k w H.
A body is given a rising torque; its angle may depend on H by 10 % of what it gains in speed, times
H: Euler's rule in one step of H gives half of it.
"""

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested
from herringbone.analysis.flange.answers import TORQUE
from herringbone.analysis.flange.bench import Bench, Signal
from herringbone.analysis.flange.motions import steady
from herringbone.analysis.flange.rates import hint
from herringbone.analysis.flange.variables import Flange
from herringbone.cosim.signature import Kind
from herringbone.cosim.signature.rotation import Given

STEPS = 8
HELD = 0.02
BODY = 0.1
SLOW = 1.0
"""Own speeds [rad/s] below which a flange is turned by as much more."""
_RAW = {
    Given.MEAN: "holds the angle during a step",
    Given.START: "runs on with w from the angle given",
    Given.END: "runs up to the angle given",
}
_SHORTER = (1.0, 0.25, 0.0625)
"""First steps over that of the bench: terms of higher order must not pass for the first."""
_TICKS = 4.0


def rotation(bench: Bench, flange: Flange) -> Finding:
    """The dependence on H of the torque, or of a body's angle; raises Refused."""
    test = "rotation, H-term" if not flange.takes_torque else "angle, H-term"
    if not bench.steps_vary:
        return not_tested(test, "its steps cannot vary")
    if flange.takes_torque:
        return _of_body(bench, flange, test)
    stiffness = bench.passes(flange, flange.tau, "phi")
    limit = f"{100 * HELD:g} % of k w H"
    if np.isnan(stiffness):
        return not_tested(test, "its stiffness at the flange is not known")
    if stiffness == 0.0:
        return not_tested(test, f"{flange.tau} does not follow the angle directly")
    more = 0.0 if abs(bench.own_speed[flange.name]) > SLOW else SLOW
    speed = bench.own_speed[flange.name] + more
    found = []
    for first in _first_steps(bench):
        term = _h_term(bench, {flange.name: steady(more)}, flange.tau, first)
        found.append(abs(term / (stiffness * speed * first)))
    share = min(found)
    shown = f"{100 * share:.2g} % at {speed:.4g} rad/s; "
    shown += f"it {_raw(bench, flange)}" if share <= HELD else _turned(bench, flange, more, speed)
    return judged(test, share <= HELD, shown, limit)


def _raw(bench: Bench, flange: Flange) -> str:
    late = bench.delay(flange, flange.tau, "phi")
    if bench.signature.kind is Kind.ELEMENT:
        return "follows the angle at once"
    return f"answers {late} steps late" if late > 0 else _RAW[bench.given(flange)]


def _turned(bench: Bench, flange: Flange, more: float, speed: float) -> str:
    """What an angle does inside a step by none of the rules: it turns on by r w."""
    late = bench.delay(flange, flange.tau, "phi")
    if late > 0:
        return f"it answers {late} steps late"
    first = _first_steps(bench)[-1]
    running = bench.with_rule(flange, Given.START)
    term = _h_term(running, {flange.name: steady(more)}, flange.tau, first)
    stiffness = bench.passes(flange, flange.tau, "phi")
    r = 1.0 + term / (stiffness * speed * first)
    return f"inside a step the angle turns on by {r:.3g} w{hint(r)}"


def _of_body(bench: Bench, flange: Flange, test: str) -> Finding:
    limit = f"{100 * BODY:g} % of w H"
    found = []
    for first in _first_steps(bench):
        signals = {flange.name: steady(TORQUE / first)}
        gained = (
            bench.run(signals, STEPS, first).of(flange.w) - bench.run({}, STEPS, first).of(flange.w)
        )[-1]
        if gained == 0.0:
            return not_tested(test, f"{TORQUE:g} N m does not move it")
        term = _h_term(bench, signals, flange.phi, first) - _h_term(bench, {}, flange.phi, first)
        found.append(abs(term / (gained * first)))
    return judged(test, min(found) <= BODY, f"{100 * min(found):.2g} %", limit)


def _first_steps(bench: Bench) -> list[float]:
    if bench.signature.tick:
        return [_TICKS * bench.signature.tick]
    return [share * bench.step for share in _SHORTER]


def _h_term(bench: Bench, signals: dict[str, Signal], output: str, first: float) -> float:
    """a H of an output after STEPS steps of H = `first` [s]."""
    ends = [bench.run(signals, STEPS * 2**k, first / 2.0**k).of(output)[-1] for k in range(3)]
    return float(8.0 * (ends[1] - ends[2]) - 2.0 * (ends[0] - ends[1]))
