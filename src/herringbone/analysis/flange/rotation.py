"""The rotation test: what of a flange's answer at a fixed time depends on the step.

The flange turns evenly, at the part's own speed or 1 rad/s faster if that is slow: at once, when
the part has not followed yet, and for longer, all flanges alike, when it has. Torques at fixed
times are found in steps of H, H/2 and H/4. With y(H) = y + a H + b H^2 the three give a H. Of a
part of stiffness k it may be 2 % of k w H: an angle that is held wrongly gives half of k w H.
A body is given a rising torque; its angle may depend on H by 10 % of what it gains in speed, times
H: Euler's rule in one step of H gives half of it.

Several H are tried and the least share counts, as a wrong angle is wrong by the same share in all:
terms of higher order are large in long steps, and inner steps that do not fit in short ones.
"""

from collections.abc import Callable, Sequence

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested
from herringbone.analysis.flange.answers import TORQUE
from herringbone.analysis.flange.bench import Bench, Signal
from herringbone.analysis.flange.motions import run_up, steady
from herringbone.analysis.flange.rates import hint
from herringbone.analysis.flange.variables import Flange
from herringbone.core.wording import percent
from herringbone.cosim.signature import Kind
from herringbone.cosim.signature.rotation import InputRule
from herringbone.cosim.signature.trial import NOT_TRIED

STEPS = 8
HELD = 0.02
BODY = 0.1
SLOW = 1.0
"""Own speeds [rad/s] below which a flange is turned by as much more."""
_RAW = {
    InputRule.MEAN: "holds the angle during a step",
    InputRule.START: "runs on with w from the angle given",
    InputRule.END: "runs up to the angle given",
}
_FIRST = (4.0, 1.0, 0.25, 0.0625)
"""H over the step of the bench."""
_FEW = 3
_LONG = 200
LONGEST = round(4 * _LONG / min(_FIRST[:_FEW]))
"""Steps of the longest of the longer turns; they are left out where runs must be shorter."""
STEPS_AT_ONCE, STEPS_OF_BODY = 7 * STEPS * len(_FIRST), (2 + 2 * 7) * STEPS * len(_FIRST)
STEPS_LATER = sum(7 * round(_LONG / first) for first in _FIRST[:_FEW])
_TICKS = 4.0
_NOTHING = 0.05
"""Part of a turn in a step that is none."""


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
    own = bench.own_speed[flange.name]
    more = 0.0 if abs(own) > SLOW else float(np.copysign(SLOW, own))
    speed = own + more
    turning = {flange.name: steady(more)}
    firsts = _first_steps(bench)
    at_once = _least(firsts, lambda first: _h_term(bench, turning, flange.tau, first) / first)
    long = bench.longest >= LONGEST
    later = 0.0
    if long:
        later = _least(firsts[:_FEW], lambda first: _settled(bench, flange, more, first) / first)
    share = max(at_once, later) / abs(stiffness * speed)
    shown = f"{percent(share)} at {speed:.4g} rad/s; "
    shown += f"it {_raw(bench, flange)}" if share <= HELD else _turned(bench, flange, more, speed)
    shown += "" if long else "; longer turns are not tested"
    return judged(test, share <= HELD, shown, limit)


def _settled(bench: Bench, flange: Flange, more: float, first: float) -> float:
    """a H of the torque after a smooth run-up, over so many steps of the bench that it follows."""
    steps = round(_LONG * bench.step / first)
    signal = run_up(more, 0.8 * _LONG * bench.step)
    signals = {f.name: signal for f in bench.flanges if not f.takes_torque}
    return _h_term(bench, signals, flange.tau, first, steps)


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
    running = bench.with_rule(flange, InputRule.START)
    term = _h_term(running, {flange.name: steady(more)}, flange.tau, first)
    stiffness = bench.passes(flange, flange.tau, "phi")
    r = 1.0 + term / (stiffness * speed * first)
    if abs(r) < _NOTHING or abs(r - 1.0) < _NOTHING:
        return "the torque shown is not that at the end of the step"
    return f"inside a step the angle turns on by {r:.3g} w{hint(r)}"


def _of_body(bench: Bench, flange: Flange, test: str) -> Finding:
    limit = f"{100 * BODY:g} % of w H"

    def share(first: float) -> float:
        signals = {flange.name: steady(TORQUE / first)}
        pushed, free = (bench.run(some, STEPS, first).of(flange.w)[-1] for some in (signals, {}))
        term = _h_term(bench, signals, flange.phi, first) - _h_term(bench, {}, flange.phi, first)
        return term / ((pushed - free) * first) if pushed != free else np.inf

    least = _least(_first_steps(bench), share)
    if not np.isfinite(least):
        return not_tested(test, f"{TORQUE:g} N m does not move it")
    return judged(test, least <= BODY, percent(least), limit)


def _least(firsts: Sequence[float], share: Callable[[float], float]) -> float:
    """The least of several H that the part takes; raises Refused if it takes none."""
    found, refused = [], None
    for first in firsts:
        try:
            found.append(abs(share(first)))
        except NOT_TRIED as error:
            refused = error
    if refused and not found:
        raise refused
    return min(found)


def _first_steps(bench: Bench) -> list[float]:
    if tick := bench.signature.tick or bench.signature.inner_tick:
        return [_TICKS * tick]
    return [share * bench.step for share in _FIRST]


def _h_term(
    bench: Bench, signals: dict[str, Signal], output: str, first: float, steps: int = STEPS
) -> float:
    """a H of an output after so many steps of H = `first` [s]."""
    ends = [bench.run(signals, steps * 2**k, first / 2.0**k).of(output)[-1] for k in range(3)]
    return float(8.0 * (ends[1] - ends[2]) - 2.0 * (ends[0] - ends[1]))
