"""What a coupling does besides: its torques balance, and only its twist matters.

Both are told from means over a long time after a smooth change, in which vibration drops out, so
that they hold for couplings with masses inside too: the momentum inside is the same before and
after. A coupling without memory must also balance at every instant.
"""

from collections.abc import Mapping

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested
from herringbone.analysis.flange.answers import TORQUE
from herringbone.analysis.flange.bench import Bench, Record
from herringbone.analysis.flange.motions import burst, hann_mean, turn
from herringbone.analysis.flange.work import ANGLE, CYCLES
from herringbone.core.wording import percent
from herringbone.cosim.signature import Kind

SHARE = 0.02
AT_ONCE = 1e-6
TURN, HOLD = 100, 2000
"""Steps in which a flange is turned, and then held."""
_PERIOD = 160
RUNS = 3
"""Held runs of both tests of a coupling with a mass inside, the one at rest counted."""


def reaction(bench: Bench) -> Finding:
    """The torque at one flange is that at the other, backwards; raises Refused."""
    test, limit = "action = reaction", f"{100 * SHARE:g} %"
    one, other = bench.flanges
    if one.takes_torque and other.takes_torque:
        return _of_bodies(bench, test, limit)
    if one.takes_torque or other.takes_torque:
        return _handed_on(bench, test, limit)
    if bench.signature.kind is Kind.ELEMENT:
        apart = bench.change(
            {one.name: burst(ANGLE, _PERIOD * bench.step, CYCLES)}, CYCLES * _PERIOD
        )
        a, b = apart.of(one.tau), apart.of(other.tau)
        scale, limit = float(np.abs([a, b]).max()), f"{100 * AT_ONCE:g} % at every instant"
        if scale == 0.0:
            return not_tested(test, "no motion changes its torques at the start")
        share = float(np.abs(a + b).max()) / scale
        return judged(test, share <= AT_ONCE, f"off by {percent(share)}", limit)
    twisted = _held(bench, {one.name: ANGLE})
    means = [hann_mean(twisted.of(flange.tau)[TURN:]) for flange in (one, other)]
    scale = max(map(abs, means))
    if scale == 0.0:
        return not_tested(test, "a twist leaves no torque")
    share = abs(sum(means)) / scale
    return judged(test, share <= SHARE, f"off by {percent(share)} in the mean", limit)


def relative(bench: Bench) -> Finding:
    """A rigid turn of both flanges changes nothing; raises Refused."""
    test = "relative motion only"
    one, other = bench.flanges
    if one.takes_torque and other.takes_torque:
        return not_tested(test, "it takes torques; see action = reaction")
    if one.takes_torque or other.takes_torque:
        return _follows(bench, test)
    twist, rigid = (
        _held(bench, {one.name: ANGLE}),
        _held(bench, {one.name: ANGLE, other.name: ANGLE}),
    )
    scale = abs(hann_mean(twist.of(one.tau)[TURN:]))
    if scale == 0.0:
        return not_tested(test, "a twist leaves no torque")
    left = max(abs(hann_mean(rigid.of(flange.tau)[TURN:])) for flange in (one, other))
    shown = f"{percent(left / scale)} of the torque of such a twist"
    return judged(test, left <= SHARE * scale, shown, f"{100 * SHARE:g} %")


def _held(bench: Bench, sizes: Mapping[str, float]) -> Record:
    """What angles or torques at flanges change that come smoothly and stay."""
    length = TURN * bench.step
    return bench.change({name: turn(size, length) for name, size in sizes.items()}, TURN + HOLD)


def _of_bodies(bench: Bench, test: str, limit: str) -> Finding:
    """Opposite torques at both ends leave the momentum as it is."""
    one, other = bench.flanges
    alone = _held(bench, {one.name: TORQUE})
    both = _held(bench, {one.name: TORQUE, other.name: -TORQUE})
    ends = [
        max(abs(hann_mean(found.of(flange.w)[TURN:])) for flange in (one, other))
        for found in (alone, both)
    ]
    if ends[0] == 0.0:
        return not_tested(test, f"{TORQUE:g} N m does not move it")
    share = ends[1] / ends[0]
    shown = f"opposite torques leave {percent(share)} of the speed of one"
    return judged(test, share <= SHARE, shown, limit)


def _handed_on(bench: Bench, test: str, limit: str) -> Finding:
    """A torque at the one end is handed on to the neighbour at the other, which is held."""
    one, other = sorted(bench.flanges, key=lambda flange: not flange.takes_torque)
    found = _held(bench, {one.name: TORQUE})
    share = abs(hann_mean(found.of(other.tau)[TURN:]) / TORQUE - 1.0)
    return judged(test, share <= SHARE, f"off by {percent(share)} in the mean", limit)


def _follows(bench: Bench, test: str) -> Finding:
    """The free end follows a turn of the other one."""
    one, other = sorted(bench.flanges, key=lambda flange: not flange.takes_torque)
    found = _held(bench, {other.name: ANGLE})
    share = abs(hann_mean(found.of(one.phi)[TURN:]) / ANGLE - 1.0)
    shown = f"the other end is {percent(share)} off in the mean"
    return judged(test, share <= SHARE, shown, f"{100 * SHARE:g} %")
