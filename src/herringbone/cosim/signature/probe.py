"""The trials that find a part's signature."""

from collections.abc import Mapping

import numpy as np

from herringbone.core.names import first_of
from herringbone.core.part import PartVariable
from herringbone.cosim.signature.amplitudes import RATIO, amplitude
from herringbone.cosim.signature.feedthrough.at_start import SAME, feedthrough_of, runs_on
from herringbone.cosim.signature.feedthrough.later import later_feedthrough
from herringbone.cosim.signature.feedthrough.noisy import noisy_feedthrough
from herringbone.cosim.signature.inner_speeds import inner_speeds
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.memory import Pulses, pulses
from herringbone.cosim.signature.rates import rates_of
from herringbone.cosim.signature.rotation import InputRule, pairs, rule_of
from herringbone.cosim.signature.signature import Answer, Findings, Kind, Signature
from herringbone.cosim.signature.ticks import inner_tick_of, tick_of
from herringbone.cosim.signature.trial import Refused

_MOVES = {
    InputRule.START: "runs on inside a step, with",
    InputRule.END: "runs up to its value inside a step, with",
}
_RESTING = 8
"""Steps in which outputs show whether they change with time alone."""
_SHORT = 1.001
_LOUDER = 5
"""How often a change that nothing answers is made 16 times larger."""
_SHOWN = 3
"""Inputs that nothing answers, by name in a line."""
_TINY = 1e-3
"""The first step that shows whether outputs are valid before it, over the step."""


def find_signature(lab: Laboratory, variables: Mapping[str, PartVariable]) -> Signature:
    """Signature of a part.

    Args:
        lab: entered; its step is the one that the part will be stepped with.
        variables: of the part.

    Returns:
        What was found; what trials leave open is unknown, with a line on why.
    """
    found = Findings()
    shape = len(lab.outputs), len(lab.inputs)
    unknown = np.full(shape, np.nan)
    if not lab.repeats:
        found.note(f"the same steps give other outputs: {lab.why}; its inputs are held")
        try:
            return _signature(lab, found, Kind.NOISY, noisy_feedthrough(lab, variables, found))
        except Refused as error:
            found.note(f"repeated trials are not possible: {error}")
            return _signature(lab, found, Kind.NOISY, unknown)
    if lab.restores is False:
        found.note(f"its saved state is not trusted: {lab.why}")
    if not np.isfinite(lab.start_outputs).all():
        found.note("its outputs are not finite at the start")
        return _signature(lab, found, Kind.UNKNOWN, unknown)
    try:
        changes = _amplitudes(lab, variables)
        tick = tick_of(lab, changes)
        if tick > _SHORT * lab.step:
            found.note(
                f"its outputs change every {tick:g} s only, in longer steps than those of "
                f"{lab.step:g} s; its inputs are held"
            )
            return _signature(lab, found, Kind.SAMPLED, unknown, tick=tick)
        return _by_trials(lab, variables, changes, tick, found)
    except Refused as error:
        found.note(f"trials are not possible: {error}")
        return _signature(lab, found, Kind.UNKNOWN, unknown)


def _by_trials(
    lab: Laboratory,
    variables: Mapping[str, PartVariable],
    changes: np.ndarray,
    tick: float,
    found: Findings,
) -> Signature:
    """Signature of a part that repeats and changes in every step; raises Refused."""
    pulse, changes = _heard(lab, changes)
    grain = tick or lab.grain
    feedthrough, slopes = feedthrough_of(lab, changes, grain, found)
    if lab.grain:
        _note_one_length(lab, feedthrough, found)
    _doubt(lab, feedthrough, pulse, found)
    _compare_later(lab, feedthrough, changes, found)
    inner = 0.0
    if grain == 0.0 and np.nan_to_num(feedthrough).any():
        inner = inner_tick_of(lab, changes, remembers=pulse.memory is Answer.YES)
        pulse = pulse._replace(memory=Answer.YES) if inner else pulse
    given, rate = _rules(lab, changes, feedthrough, runs_on(feedthrough, slopes), tick or inner)
    valid = _valid_at_start(lab, grain)
    rates = rates_of(lab, variables, changes, feedthrough)
    _note_answers(lab, variables, pulse, found)
    for number, rule in enumerate(given):
        if rule is not InputRule.MEAN:
            found.note(f"{lab.inputs[number]} {_MOVES[rule]} {lab.inputs[rate[number]]}")
    if not valid:
        found.note("its outputs are not valid before the first step")
    return _signature(
        lab,
        found,
        _kind(feedthrough, pulse),
        feedthrough,
        memory=pulse.memory,
        delay=pulse.delay,
        rates=rates,
        tick=tick,
        inner_tick=inner,
        given=given,
        rate_inputs=rate,
        speeds=() if inner or tick else inner_speeds(lab, feedthrough, given, rate),
    )


def _heard(lab: Laboratory, changes: np.ndarray) -> tuple[Pulses, np.ndarray]:
    """Answers to pulses, and the changes that made them: larger where nothing answered.

    What nothing answers at all is changed by little: the input of a controller at its limit.
    """
    pulse, small = pulses(lab, changes), changes
    for _ in range(_LOUDER):
        deaf = (pulse.delay < 0).all(axis=0)
        if not deaf.any():
            break
        changes = np.where(deaf, RATIO * changes, changes)
        pulse = pulses(lab, changes)
    return pulse, np.where((pulse.delay < 0).all(axis=0), small, changes)


def _signature(
    lab: Laboratory, found: Findings, kind: Kind, feedthrough: np.ndarray, **more: object
) -> Signature:
    empty = {
        "memory": Answer.UNKNOWN,
        "delay": np.zeros(feedthrough.shape, dtype=int),
    }
    values: dict = {**empty, **more}
    return Signature(
        lab.inputs,
        lab.outputs,
        lab.step,
        kind,
        feedthrough,
        restores=lab.restores,
        repeats=lab.repeats,
        notes=tuple(found.notes),
        **values,
    )


def _rules(
    lab: Laboratory,
    changes: np.ndarray,
    feedthrough: np.ndarray,
    together: tuple[int, ...],
    tick: float,
) -> tuple[tuple[InputRule, ...], tuple[int, ...]]:
    """Which value of each input the part is given for a step, and the number of its rate or -1."""
    given, rate = [InputRule.MEAN] * len(lab.inputs), [-1] * len(lab.inputs)
    if lab.grain:  # it takes shorter steps to tell, and only who gives several a step needs it
        return tuple(given), tuple(rate)
    known = np.nan_to_num(feedthrough)
    for number, other in pairs(lab.inputs, together):
        if known[:, number].any():
            rate[number] = other
            given[number] = rule_of(lab, (number, other), float(changes[other]), known, tick)
    return tuple(given), tuple(rate)


def _doubt(lab: Laboratory, feedthrough: np.ndarray, pulse: Pulses, found: Findings) -> None:
    """What is unknown after all: small answers of large outputs, and other inputs of bent ones."""
    for row in found.bent:
        feedthrough[row, pulse.delay[row] < 0] = np.nan
    seen = found.bent or np.nan_to_num(feedthrough).any()
    moves = (pulse.delay >= 0).any() or np.ptp(lab.resting(lab.step, _RESTING), axis=0).any()
    if pulse.memory is Answer.NO and feedthrough.size and moves and not seen:
        found.note("its outputs change, but too little against their size, or with time alone")


def _note_one_length(lab: Laboratory, feedthrough: np.ndarray, found: Findings) -> None:
    """Lines on what steps of one length tell."""
    found.note(
        f"it takes steps of one length only: D is that of steps of {lab.grain:g} s, from its "
        "answers after 1, 2, 4 and 8 of them"
    )
    for row, column in np.argwhere(np.isnan(feedthrough)):
        if row not in found.bent:
            found.note(
                f"d({lab.outputs[row]})/d({lab.inputs[column]}) is unknown: it answers with motion "
                "of its own that these steps do not resolve"
            )


def _compare_later(
    lab: Laboratory, feedthrough: np.ndarray, changes: np.ndarray, found: Findings
) -> None:
    """Feedthrough that is there later only is unknown; that which changes is told."""
    later = later_feedthrough(lab, changes)
    now = np.nan_to_num(feedthrough)
    apart = np.abs(later - now) > SAME * np.maximum(np.abs(later), np.abs(now))
    for row, column in np.argwhere(apart & (later != 0.0) & ~np.isnan(feedthrough)):
        name = f"d({lab.outputs[row]})/d({lab.inputs[column]})"
        if feedthrough[row, column] == 0.0:
            feedthrough[row, column] = np.nan
            found.note(f"{name} is 0 at the start and {later[row, column]:.3g} later: unknown")
        else:
            found.note(
                f"{name} is {now[row, column]:.4g} at the start and {later[row, column]:.4g} "
                "later; the first is used"
            )


def _note_answers(
    lab: Laboratory, variables: Mapping[str, PartVariable], pulse: Pulses, found: Findings
) -> None:
    """Lines on inputs that nothing answers, and on answers that come late."""
    if not lab.outputs:
        outputs = (v for v in variables.values() if v.causality == "output")
        if other := next(outputs, None):
            found.note(
                f"trials tell nothing of its outputs: none is of double precision ({other.name} is "
                f"a {other.type})"
            )
        return
    deaf = [name for name, d in zip(lab.inputs, pulse.delay.T, strict=True) if (d < 0).all()]
    if deaf:
        found.note(f"no output answers {first_of(deaf, _SHOWN)} at the start values of the others")
    for number, name in enumerate(lab.inputs):
        late = pulse.delay[:, number]
        if late.max(initial=-1) > 0:
            found.note(f"{lab.outputs[int(late.argmax())]} answers {name} {late.max()} steps late")


def _kind(feedthrough: np.ndarray, pulse: Pulses) -> Kind:
    if feedthrough.shape[1] == 0:
        return Kind.SOURCE
    reached = np.isnan(feedthrough) | (feedthrough != 0.0) | (pulse.delay >= 0)
    if not reached.any() or np.isnan(feedthrough).any() or pulse.memory is Answer.UNKNOWN:
        return Kind.UNKNOWN
    if not (feedthrough != 0.0).any():
        return Kind.BODY if pulse.memory is Answer.YES else Kind.UNKNOWN
    return Kind.ELEMENT if pulse.memory is Answer.NO else Kind.STATES_AND_FEEDTHROUGH


def _amplitudes(lab: Laboratory, variables: Mapping[str, PartVariable]) -> np.ndarray:
    """(n,) the larger change of each input."""
    starts = zip(lab.inputs, lab.start, strict=True)
    return np.array([amplitude(variables[name], float(value)) for name, value in starts])


def _valid_at_start(lab: Laboratory, grain: float) -> bool:
    """False if outputs jump in a tiny first step by more than in the one that follows it."""
    tiny = grain or _TINY * lab.step
    try:
        path = lab.run([lab.start, lab.start], tiny)
    except Refused:
        return True
    first, second = np.abs(np.diff(path, axis=0))
    size = np.abs(path).max(axis=0)
    return not bool(np.any(first > np.maximum(1e3 * second, 1e-6 * size)))
