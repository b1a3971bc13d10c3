"""How a flange answers at once: whether, when, directly or not, and in which direction."""

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested, remark
from herringbone.analysis.flange.bench import Bench
from herringbone.analysis.flange.motions import constant
from herringbone.analysis.flange.variables import Flange
from herringbone.cosim.signature import Answer, Kind

_STEPS = 4
TORQUE = 1.0
"""Of trials [N m]."""


def answered(flange: Flange) -> list[tuple[str, str]]:
    """Outputs and quantities of the inputs that they must answer."""
    if flange.takes_torque:
        return [(flange.phi, "tau"), (flange.w, "tau")]
    return [(flange.tau, q) for q in ("phi", "w") if flange.variable(q)]


def delay(bench: Bench, flange: Flange) -> Finding:
    """Every output answers within the step of the change; of a body at least its speed does."""
    test = "no delay"
    if bench.signature.kind is Kind.UNKNOWN and bench.signature.memory is Answer.UNKNOWN:
        return not_tested(test, _why(bench))
    late = {q: bench.delay(flange, output, q) for output, q in answered(flange)}
    if flange.takes_torque:
        late = {"tau": bench.delay(flange, flange.w, "tau")}
    heard = {q: steps for q, steps in late.items() if steps >= 0}
    if not heard:
        names = " and ".join(flange.variable(q) for q in late)
        return not_tested(test, f"nothing answers {names} at the start values")
    worst = max(heard, key=lambda q: heard[q])
    shown = f"{heard[worst]} steps" if heard[worst] else "0 steps"
    if heard[worst]:
        shown += f" from {flange.variable(worst)}"
    return judged(test, heard[worst] == 0, shown, "0 steps")


def feedthrough(bench: Bench, flange: Flange) -> Finding:
    """A body's motion never follows its torque directly; a torque may follow the motion."""
    if not flange.takes_torque:
        passed = {q: bench.passes(flange, flange.tau, q) for q in ("phi", "w")}
        shown = ", ".join(
            f"d(tau)/d({q}) = {'unknown' if np.isnan(d) else f'{d:.5g} {unit}'}"
            for (q, d), unit in zip(passed.items(), ("N.m/rad", "N.m.s/rad"), strict=True)
            if flange.variable(q)
        )
        if any(np.isnan(d) for d in passed.values()):
            return remark("feedthrough", f"{shown}; {_why(bench)}", "known")
        return judged("feedthrough", True, shown, "known")
    passed = {name: bench.passes(flange, name, "tau") for name in (flange.phi, flange.w)}
    direct = {name: d for name, d in passed.items() if d and not np.isnan(d)}
    if direct:
        shown = ", ".join(f"d({name})/d({flange.tau}) = {d:.4g}" for name, d in direct.items())
        return judged("no feedthrough", False, shown, "0")
    if any(np.isnan(d) for d in passed.values()):
        return remark("no feedthrough", f"not clear; {_why(bench)}", "0")
    return judged("no feedthrough", True, "0", "0")


def _why(bench: Bench) -> str:
    return "; ".join(bench.signature.notes[:2]) or "trials leave it open"


def sign(bench: Bench, flange: Flange) -> Finding:
    """A torque turns a body its way; the torque of an element acts on the neighbour, against it."""
    return _of_body(bench, flange) if flange.takes_torque else _of_element(bench, flange)


def _of_body(bench: Bench, flange: Flange) -> Finding:
    test, limit = "sign of the torque", "forward"
    apart = bench.change({flange.name: constant(TORQUE)}, _STEPS)
    turned, speed = (float(apart.of(name)[-1]) for name in (flange.phi, flange.w))
    if speed == 0.0 and turned == 0.0:
        return not_tested(test, f"{TORQUE:g} N m does not move it in {_STEPS} steps")
    seconds = _STEPS * bench.step
    shown = f"{TORQUE:g} N m gives {speed / seconds:.4g} rad/s2"
    return judged(test, turned > 0.0 or speed > 0.0, shown, limit)


def _of_element(bench: Bench, flange: Flange) -> Finding:
    test, limit = "sign of the torque", "not positive"
    stiffness, damping = (bench.passes(flange, flange.tau, q) for q in ("phi", "w"))
    if np.isnan(stiffness) or np.isnan(damping):
        return not_tested(test, "its feedthrough is not known")
    if stiffness == 0.0 and damping == 0.0:
        return not_tested(test, "nothing passes directly to its torque; see passivity")
    known = (("phi", stiffness, "N.m/rad"), ("w", damping, "N.m.s/rad"))
    shown = ", ".join(f"d(tau)/d({q}) = {d:.4g} {unit}" for q, d, unit in known if d)
    if damping > 0.0 > stiffness:
        shown += ": negative damping, or w backwards"
    return judged(test, stiffness <= 0.0 and damping <= 0.0, shown, limit)
