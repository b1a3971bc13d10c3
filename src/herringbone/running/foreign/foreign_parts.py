"""Foreign FMUs of a system: what the coupling makes of what trials tell of them.

Parts with known feedthrough are given polynomial signals (`cosim.nodal`). Of others the declared
structure is used, and a line says why.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import Part, PartVariable
from herringbone.cosim.adapter import PartAdapter, WithoutStates
from herringbone.cosim.cell.part import CellPart
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature import Answer, Kind, Signature
from herringbone.cosim.structure.rates import motion_of_force
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.trials import Instances, found_signature

_CLEAR = {Kind.BODY, Kind.ELEMENT, Kind.STATES_AND_FEEDTHROUGH}


def understood(
    system: System, parts: Sequence[Part], instances: Instances, step: float
) -> tuple[list[Part], list[str]]:
    """The parts, foreign ones with what trials tell of them; and lines that the user should read.

    Args:
        system: of the parts, in the same order.
        parts: instantiated, start values set.
        instances: see `trials.Instances`.
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


def alike(part: Part, made: Part) -> Part:
    """A new part, as the coupling takes another one of the same FMU."""
    if isinstance(part, NodalPart):
        return part.in_front_of(made)
    if isinstance(part, WithoutStates):
        made = WithoutStates(made)
    made.has_states, made.variables = part.has_states, part.variables
    return made


def _with_signature(part: Part, signature: Signature) -> tuple[Part, list[str]]:
    """The part as the coupling takes it, and lines on it."""
    lines = list(signature.notes)
    if can_be_watched(part, signature):
        lines.append(
            "trials do not tell what passes directly for all of its motions: it is measured anew "
            "as the part moves"
        )
        return NodalPart(part, as_it_moves(signature)), lines
    if signature.kind not in _CLEAR:
        lines.append(f"taken by what it declares, because it is {signature.kind} to trials")
        if signature.kind is Kind.NOISY:
            lines += _contradictions(part.variables, signature)
            part.variables = _measured(part.variables, signature)
        repeats = signature.repeats and signature.restores is not False
        return (part if repeats else WithoutStates(part)), lines
    lines += _contradictions(part.variables, signature)
    held = part.addresses.set_derivatives or signature.tick or part.one_step
    if held or _loops_without_end(part, signature):
        part = part if signature.restores is not False else WithoutStates(part)
        part.has_states = signature.kind is not Kind.ELEMENT
        part.variables = _measured(part.variables, signature)
        if isinstance(part, FmuPart | CellPart | PartAdapter):
            part.signature = signature
        return part, lines
    nodal = NodalPart(part, signature)
    lines.append(_coupled_as(signature, repeats=not nodal.answers_again))
    return nodal, lines


def can_be_watched(part: Part, signature: Signature) -> bool:
    """True if only the feedthrough of a part is unknown, and its steps can be repeated."""
    return (
        signature.kind is Kind.UNKNOWN
        and signature.memory is not Answer.UNKNOWN
        and bool(np.isnan(signature.feedthrough).any())
        and signature.restores is True
        and signature.tick == 0.0
        and not part.one_step
        and not part.addresses.set_derivatives
    )


def has_memory(signature: Signature) -> bool:
    """True if only the feedthrough of a part with states is unknown, and it answers alike."""
    return signature.kind is Kind.UNKNOWN and signature.memory is Answer.YES and signature.repeats


def as_it_moves(signature: Signature) -> Signature:
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
