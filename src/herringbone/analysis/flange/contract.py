"""What motors, loads and couplings must do, whoever wrote them: the contract of flanges.

A flange either takes `tau`, the torque on the part [N m], and gives the motion `phi` [rad], `w`
[rad/s] of its body; or it takes the motion of the neighbour and gives `tau`, the torque on that
neighbour. Motors and loads have one, couplings two. Behaviour is tested from the start values, on
throw-away instances; what is not possible is said.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

import numpy as np

from herringbone.analysis.finding import Finding, Verdict, judged, not_tested, remark
from herringbone.analysis.flange.answers import delay, feedthrough, sign
from herringbone.analysis.flange.bench import Bench, Diverged
from herringbone.analysis.flange.extent import longest_of, tell_cost
from herringbone.analysis.flange.guess import QUANTITIES
from herringbone.analysis.flange.rates import rate, turns
from herringbone.analysis.flange.reaction import reaction, relative
from herringbone.analysis.flange.rotation import rotation
from herringbone.analysis.flange.variables import Flange, asked, find_flanges
from herringbone.analysis.flange.work import passivity
from herringbone.core import FmuError
from herringbone.core.declaring.roles import Role
from herringbone.core.part import Part, reals
from herringbone.core.process.telling import Tell, untold
from herringbone.cosim.fmu.opening import has_further
from herringbone.cosim.signature import Kind, Laboratory, Signature, cost, find_signature
from herringbone.cosim.signature.trial import NOT_TRIED

FLANGES = {Role.DRIVE: 1, Role.LOAD: 1, Role.COUPLING: 2}
"""How many flanges a role has."""

_NUMBERS = "numbers at the start"
_OF_FLANGE: tuple[tuple[str, Callable[[Bench, Flange], Finding]], ...] = (
    ("no delay", delay),
    ("feedthrough", feedthrough),
    ("sign of the torque", sign),
    ("w = dphi/dt", rate),
    ("angle over turns", turns),
    ("H-term", rotation),
)
_OF_PART: tuple[tuple[str, Callable[[Bench], Finding]], ...] = (("passivity", passivity),)
_OF_COUPLING: tuple[tuple[str, Callable[[Bench], Finding]], ...] = (
    ("action = reaction", reaction),
    ("relative motion only", relative),
)


def check_flanges(
    make: Callable[[], Part],
    role: Role,
    *,
    step: float,
    flanges: Sequence[str] = (),
    longest: int | None = None,
    progress: Tell = untold,
    content: Sequence[str] = (),
) -> list[Finding]:
    """Test a part against the contract of a role.

    Args:
        make: makes a new instance, start values set.
        role: one of FLANGES.
        step: of the trials [s].
        flanges: which variables they are: `port`, or `tau=name,phi=name,w=name`; empty: guessed.
        longest: steps that a trial may have, see `extent`; as many as the tests want if None.
        progress: called with what begins.
        content: see `Laboratory`.

    Returns:
        One finding a test; if variables are wrong, nothing else is tested.

    Raises:
        HerringboneError: it does not start, or `flanges` cannot be read.
    """
    part = make()
    try:
        found, findings = find_flanges(part.variables, asked(flanges), FLANGES[role])
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()  # pythonfmu does not survive freeing what was not
        inputs, outputs = (reals(part, causality) for causality in ("input", "output"))
        start = np.array(part.get(inputs))
    finally:
        part.close()
    if not all(finding.holds for finding in findings):
        return findings
    if not has_further(part):
        why = "it can be instantiated once only, and runs in this process"
        return [*findings, *_nothing(why, role)]
    try:
        with Laboratory(make, inputs, outputs, start, step, content=content) as lab:
            progress("what it is")
            cost.tell_cost(lab, part.name)
            signature = find_signature(lab, part.variables)
            no_numbers = list(_not_finite(lab, found))
            findings += [_repeats(signature), *no_numbers]
            why = f"see '{_NUMBERS}'" if no_numbers else _impossible(signature, found)
            if why:
                return [*findings, *_nothing(why, role)]
            bench = Bench(
                lab, signature, found, longest or longest_of(), steps_vary=not part.one_step
            )
            tell_cost(bench, part.name)
            return [*findings, *_behaviour(bench, progress)]
    except NOT_TRIED as error:
        return [*findings, *_nothing(str(error), role)]
    except FmuError as error:
        return [*findings, judged("trial steps", False, str(error), "it starts and steps")]


def _nothing(why: str, role: Role) -> list[Finding]:
    tests = [*_OF_FLANGE, *_OF_PART, *(_OF_COUPLING if FLANGES[role] > 1 else ())]
    return [not_tested(name, why) for name, _ in tests]


def _impossible(signature: Signature, flanges: Sequence[Flange]) -> str:
    """Why no test of behaviour is possible, "" if some are: a body's need no feedthrough."""
    if not signature.repeats:
        return "the same steps give other outputs"
    if signature.kind is Kind.SAMPLED:
        return f"its outputs change every {signature.tick:g} s only: add --step {signature.tick:g}"
    known = np.isfinite(signature.feedthrough).any()
    if not known and not all(flange.takes_torque for flange in flanges):
        note = next(iter(signature.notes), "trial steps tell nothing of it")
        return f"{note}; give other start values by --set" if "not linear" in note else note
    return ""


def _repeats(signature: Signature) -> Finding:
    test, limit = "steps repeat", "equal bits"
    if not signature.repeats:
        note = next(iter(signature.notes), "")
        return Finding(test, Verdict.REMARK, note, limit)
    if signature.restores:
        return judged(test, True, "it saves and restores its state", limit)
    what = "it does not save its state" if signature.restores is None else signature.notes[0]
    return remark(test, f"{what}; the coupling steps it once", limit)


def _not_finite(lab: Laboratory, flanges: Sequence[Flange]) -> Iterator[Finding]:
    """A finding if a flange gives what is no number at the start: every run with it fails."""
    given = {flange.variable(q) for flange in flanges for q in QUANTITIES if not flange.moves(q)}
    named = dict(zip(lab.outputs, lab.start_outputs, strict=True))
    wrong = [name for name, value in named.items() if name in given and not np.isfinite(value)]
    if wrong:
        shown = f"{', '.join(wrong)}: not finite before the first step"
        yield judged(_NUMBERS, False, shown, "finite")


def _behaviour(bench: Bench, progress: Tell) -> Iterator[Finding]:
    many = len(bench.flanges) > 1
    for flange in bench.flanges:
        for name, test in _OF_FLANGE:
            progress(name)
            found = _tried(bench, name, partial(test, bench, flange))
            yield _named(found, flange.name) if many else found
    for name, of_part in (*_OF_PART, *(_OF_COUPLING if many else ())):
        progress(name)
        yield _tried(bench, name, partial(of_part, bench))


def _tried(bench: Bench, name: str, test: Callable[[], Finding]) -> Finding:
    """A finding; what fails on an instance of its own must fail again on others."""
    found = _once(name, test)
    if found.holds or bench.signature.restores:
        return found
    bench.forget()
    again = _once(name, test)
    if not again.holds:
        return found
    shown = f"{found.measured}, but not again: {again.measured}"
    return remark(found.test, shown, found.limit)


def _once(name: str, test: Callable[[], Finding]) -> Finding:
    try:
        return test()
    except Diverged as error:
        return judged(name, False, str(error), "finite")
    except NOT_TRIED as error:
        return not_tested(name, str(error))


def _named(finding: Finding, flange: str) -> Finding:
    return Finding(f"{flange}: {finding.test}", finding.verdict, finding.measured, finding.limit)
