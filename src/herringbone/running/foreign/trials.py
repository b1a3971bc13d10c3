"""Trials of a foreign part: its signature, which tells what it is in a coupling."""

from collections.abc import Callable, Collection, Sequence
from contextlib import AbstractContextManager

import numpy as np

from herringbone.core import FmuError
from herringbone.core.part import Part, reals
from herringbone.core.process.activity import activity
from herringbone.core.wording import option
from herringbone.cosim.fmu.opening import has_further
from herringbone.cosim.signature import Answer, Kind, Laboratory, Signature, cost, find_signature
from herringbone.cosim.structure.system import PartSpec
from herringbone.running.content import contents_of_trials
from herringbone.running.foreign.known_signatures import known_signature
from herringbone.running.foreign.start_inputs import known_start_inputs

_HERE = ", and runs in this process: no trials; in a child process (on Linux, without %s) there are"
_LEFT = "it can be instantiated once only, and one after another in a process is not as new"

Instances = Callable[[PartSpec], AbstractContextManager[Callable[[], Part]]]
"""Of a part's description, what makes further instances of it."""


def found_signature(spec: PartSpec, part: Part, instances: Instances, step: float) -> Signature:
    """Signature of a foreign part, by trials if it is not known from before.

    Args:
        spec: of the part.
        part: whose variables count.
        instances: see `Instances`.
        step: macro step [s].
    """

    def tried() -> Signature:
        with activity(f"finding out what {part.name} is"), instances(spec) as make:
            return signature_of(part, make, step, contents_of_trials(spec))

    return known_signature(spec, step, tried)


def clearest_signature(
    part: Part, make: Callable[[], Part], steps: Sequence[float], content: Sequence[str]
) -> Signature:
    """The signature by the first step [s] whose trials leave nothing open, or least.

    A vibration that trials are too long to resolve looks like an output that is no rate of another.
    """

    def left_open(found: Signature) -> tuple[bool, int]:
        return found.kind is Kind.UNKNOWN, sum(r.holds is not Answer.YES for r in found.rates)

    tried: list[Signature] = []
    for step in steps:
        if not tried or step < tried[0].step:
            tried.append(signature_of(part, make, step, content))
        if left_open(tried[-1]) == (False, 0):
            break
    return min(tried, key=left_open)


def signature_of(
    part: Part, make: Callable[[], Part], step: float, content: Sequence[str] = ()
) -> Signature:
    """Signature of a part, found on further instances; what they refuse leaves it unknown.

    Args:
        part: whose variables count.
        make: makes a further instance, start values set.
        step: of the trials [s].
        content: see `Laboratory`.
    """
    inputs, outputs = (reals(part, causality) for causality in ("input", "output"))
    if not has_further(part):
        return _unknown(
            inputs, outputs, step, f"it can be instantiated once only{_HERE % option('in_process')}"
        )
    if not inputs and any(v.causality == "input" for v in part.variables.values()):
        return _unknown(inputs, outputs, step, "its inputs are no reals: no trials")
    return _tried(part, make, inputs, outputs, step, content)


def _tried(
    part: Part,
    make: Callable[[], Part],
    inputs: list[str],
    outputs: list[str],
    step: float,
    content: Sequence[str],
) -> Signature:
    """See `signature_of`; outputs that are not finite in trials are left out of them."""
    try:
        start = known_start_inputs(make, inputs, content)
        with _laboratory(part, make, inputs, outputs, start, step, content) as lab:
            silent = lab.not_finite
            if part.once and not lab.repeats:
                return _unknown(inputs, outputs, step, f"{_LEFT}: {lab.why}: no trials")
            cost.tell_cost(lab, part.name)
            if not silent:
                return find_signature(lab, part.variables)
        shown = _others(outputs, silent)
        with _laboratory(part, make, inputs, shown, start, step, content) as lab:
            found = find_signature(lab, part.variables)
    except FmuError as error:
        return _unknown(inputs, outputs, step, f"no trials: {error}")
    why = f"{', '.join(silent)}: not finite in trials, and taken to depend on nothing"
    return found.with_silent(silent, why)


def _laboratory(
    part: Part,
    make: Callable[[], Part],
    inputs: list[str],
    outputs: list[str],
    start: np.ndarray,
    step: float,
    content: Sequence[str],
) -> Laboratory:
    """Of a part's trials, in steps that it declares to take."""
    kept = (*content, "steps of one length") if content and part.one_step else content
    return Laboratory(make, inputs, outputs, start, step, content=kept, one_length=part.one_step)


def _others(outputs: Sequence[str], silent: Collection[str]) -> list[str]:
    """Outputs that trials show; raises FmuError if there are none."""
    found = [name for name in outputs if name not in silent]
    if not found:
        raise FmuError(f"{', '.join(silent)}: not finite")
    return found


def _unknown(inputs: list[str], outputs: list[str], step: float, why: str) -> Signature:
    nothing = np.full((len(outputs), len(inputs)), np.nan)
    return Signature(
        tuple(inputs),
        tuple(outputs),
        step,
        Kind.UNKNOWN,
        nothing,
        Answer.UNKNOWN,
        np.zeros(nothing.shape, dtype=int),
        notes=(why,),
    )
