"""Foreign FMUs of a system: what each is, found by trials, and what the coupling makes of it.

Parts with known feedthrough are given polynomial signals (`cosim.nodal`). Of others the declared
structure is used, and a line says why.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace

import numpy as np

from herringbone.core import FmuError
from herringbone.core.activity import activity
from herringbone.core.declaring.declaration import INTERFACE_DEGREE, is_node
from herringbone.core.part import Part, PartVariable
from herringbone.cosim.adapter import PartAdapter, WithoutStates
from herringbone.cosim.cell.part import CellPart
from herringbone.cosim.fmu.opening import has_further
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature import Answer, Kind, Laboratory, Signature, find_signature
from herringbone.cosim.structure.rates import motion_of_force
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.foreign.known_signatures import known_signature

_CLEAR = {Kind.BODY, Kind.ELEMENT, Kind.STATES_AND_FEEDTHROUGH}

_HERE = (
    ", and runs in this process: no trials; in a child process (on Linux, without --in-process) "
    "there are"
)
_LEFT = "it can be instantiated once only, and one after another in a process is not as new"

Instances = Callable[[PartSpec], AbstractContextManager[Callable[[], Part]]]


def understood(
    system: System, parts: Sequence[Part], instances: Instances, step: float
) -> tuple[list[Part], list[str]]:
    """The parts, foreign ones with what trials tell of them; and lines that the user should read.

    Args:
        system: of the parts, in the same order.
        parts: instantiated, start values set.
        instances: of a part's description, what makes further instances of it.
        step: macro step [s].
    """
    found: list[Part] = []
    notes: list[str] = []
    for spec, part in zip(system.parts, parts, strict=True):
        if not spec.foreign or INTERFACE_DEGREE in part.variables:
            found.append(part)
            continue
        signature = found_signature(spec, part, instances, step)
        changed, lines = _with_signature(part, signature)
        found.append(changed)
        notes += [f"{part.name}: {line}" for line in lines]
    return found, notes


def found_signature(spec: PartSpec, part: Part, instances: Instances, step: float) -> Signature:
    """Signature of a foreign part, by trials if it is not known from before.

    Args:
        spec: of the part.
        part: whose variables count.
        instances, step: see `understood`.
    """

    def tried() -> Signature:
        with activity(f"finding out what {part.name} is"), instances(spec) as make:
            return signature_of(part, make, step)

    return known_signature(spec, step, tried)


def alike(part: Part, made: Part) -> Part:
    """A new part, as the coupling takes another one of the same FMU."""
    if isinstance(part, NodalPart):
        return part.in_front_of(made)
    made.has_states, made.variables = part.has_states, part.variables
    return made


def clearest_signature(part: Part, make: Callable[[], Part], steps: Sequence[float]) -> Signature:
    """The signature by the first step [s] whose trials leave nothing open, or least.

    A vibration that trials are too long to resolve looks like an output that is no rate of another.
    """

    def left_open(found: Signature) -> tuple[bool, int]:
        return found.kind is Kind.UNKNOWN, sum(r.holds is not Answer.YES for r in found.rates)

    tried: list[Signature] = []
    for step in steps:
        if not tried or step < tried[0].step:
            tried.append(signature_of(part, make, step))
        if left_open(tried[-1]) == (False, 0):
            break
    return min(tried, key=left_open)


def signature_of(part: Part, make: Callable[[], Part], step: float) -> Signature:
    """Signature of a part, found on further instances; what they refuse leaves it unknown.

    Args:
        part: whose variables count.
        make: makes a further instance, start values set.
        step: of the trials [s].
    """
    inputs, outputs = (_reals(part, causality) for causality in ("input", "output"))
    if not has_further(part):
        return _unknown(inputs, outputs, step, f"it can be instantiated once only{_HERE}")
    if part.one_step:
        return _unknown(inputs, outputs, step, "it declares that its steps cannot vary: no trials")
    if not inputs and any(v.causality == "input" for v in part.variables.values()):
        return _unknown(inputs, outputs, step, "its inputs are no reals: no trials")
    return _tried(part, make, inputs, outputs, step)


def _tried(
    part: Part, make: Callable[[], Part], inputs: list[str], outputs: list[str], step: float
) -> Signature:
    """See `signature_of`; outputs that are not finite in trials are left out of them."""
    try:
        start = start_inputs(make(), inputs)
        with Laboratory(make, inputs, outputs, start, step) as lab:
            silent = lab.not_finite
            if part.once and not lab.repeats:
                return _unknown(inputs, outputs, step, f"{_LEFT}: {lab.why}: no trials")
            if not silent:
                return find_signature(lab, part.variables)
        with Laboratory(make, inputs, _others(outputs, silent), start, step) as lab:
            found = find_signature(lab, part.variables)
    except FmuError as error:
        return _unknown(inputs, outputs, step, f"no trials: {error}")
    why = f"{', '.join(silent)}: not finite in trials, and taken to depend on nothing"
    return found.with_silent(silent, why)


def _others(outputs: Sequence[str], silent: Collection[str]) -> list[str]:
    """Outputs that trials show; raises FmuError if there are none."""
    found = [name for name in outputs if name not in silent]
    if not found:
        raise FmuError(f"{', '.join(silent)}: not finite")
    return found


def _reals(part: Part, causality: str) -> list[str]:
    return [
        name
        for name, v in part.variables.items()
        if v.causality == causality and v.is_real and not is_node(name)
    ]


def start_inputs(part: Part, inputs: list[str]) -> np.ndarray:
    """Start values of the inputs, as an instance has them when it is initialised."""
    try:
        part.enter_initialization(0.0, 1.0)
        return np.array(part.get(inputs))
    finally:
        part.close()


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


def _with_signature(part: Part, signature: Signature) -> tuple[Part, list[str]]:
    """The part as the coupling takes it, and lines on it."""
    lines = list(signature.notes)
    if _can_be_watched(part, signature):
        lines.append(
            "trials do not tell what passes directly for all of its motions: it is measured anew "
            "as the part moves"
        )
        return NodalPart(part, _as_it_moves(signature)), lines
    if signature.kind not in _CLEAR:
        lines.append(f"taken by what it declares, because it is {signature.kind} to trials")
        if signature.kind is Kind.NOISY:
            lines += _contradictions(part.variables, signature)
            part.variables = _measured(part.variables, signature)
        repeats = signature.repeats and signature.restores is not False
        return (part if repeats else WithoutStates(part)), lines
    lines += _contradictions(part.variables, signature)
    if part.addresses.set_derivatives or signature.tick or _loops_without_end(part, signature):
        part.has_states = signature.kind is not Kind.ELEMENT
        part.variables = _measured(part.variables, signature)
        if isinstance(part, FmuPart | CellPart | PartAdapter):
            part.signature = signature
        return part, lines
    nodal = NodalPart(part, signature)
    lines.append(_coupled_as(signature, repeats=not nodal.answers_again))
    return nodal, lines


def _can_be_watched(part: Part, signature: Signature) -> bool:
    """True if only the feedthrough of a part is unknown, and its steps can be repeated."""
    return (
        signature.kind is Kind.UNKNOWN
        and signature.memory is not Answer.UNKNOWN
        and bool(np.isnan(signature.feedthrough).any())
        and signature.restores is True
        and signature.tick == 0.0
        and not part.addresses.set_derivatives
    )


def _as_it_moves(signature: Signature) -> Signature:
    """What is known of the signature, for a start."""
    kind = Kind.ELEMENT if signature.memory is Answer.NO else Kind.STATES_AND_FEEDTHROUGH
    return replace(signature, kind=kind)


def _coupled_as(signature: Signature, *, repeats: bool) -> str:
    if signature.kind is Kind.ELEMENT:
        return "an element by trial steps; its outputs follow its inputs at every signal node"
    if not repeats:
        return (
            f"{signature.kind} by trial steps; it cannot repeat a step: li steps it once, on "
            "predicted inputs, and its feedthrough answers corrections, which makes the coupling "
            "third order in the step; with other algorithms it is that of their extrapolation"
        )
    changes = "; its feedthrough is measured anew where it changes"
    return (
        f"{signature.kind} by trial steps; from node to node it takes two steps on values that "
        "keep mean and slope of its inputs, which makes the coupling fourth order in the step at "
        f"most{changes if signature.kind is Kind.STATES_AND_FEEDTHROUGH else ''}"
    )


def _loops_without_end(part: Part, signature: Signature) -> bool:
    """True if forces move the part directly, and its steps cannot be repeated.

    Then extrapolated forces would come back around the algebraic loop enlarged; held ones do not.
    """
    moved = any(
        motion_of_force(name)
        for passed in signature.dependencies().values()
        for name in passed or ()
    )
    return moved and not (part.addresses.can_restore and signature.restores)


def _measured(
    variables: Mapping[str, PartVariable], signature: Signature
) -> dict[str, PartVariable]:
    passed = signature.dependencies()
    return {
        name: v if passed.get(name) is None else replace(v, dependencies=passed[name])
        for name, v in variables.items()
    }


def _contradictions(variables: Mapping[str, PartVariable], signature: Signature) -> list[str]:
    """Lines on outputs whose declared dependencies are not those found."""
    lines = []
    for row, output in enumerate(signature.outputs):
        declared = variables[output].dependencies
        if declared is None:
            continue
        for column, name in enumerate(signature.inputs):
            value = signature.feedthrough[row, column]
            if abs(value) > 0.0 and name not in declared:
                lines.append(
                    f"{output} is declared not to depend directly on {name}; found "
                    f"d({output})/d({name}) = {value:.4g}, which is used"
                )
    return lines
