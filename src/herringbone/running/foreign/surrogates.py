"""Linear surrogates of a system's foreign parts, for what is predicted before a run."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from herringbone.analysis.stability.surrogates.sampled import SampledSurrogate, round_period
from herringbone.analysis.stability.surrogates.stand_in import Stranger
from herringbone.analysis.stability.surrogates.surrogate import Surrogate
from herringbone.analysis.stability.surrogates.trials import tell_cost
from herringbone.core import FmuError
from herringbone.core.part import Part, closing_all
from herringbone.core.process.activity import activity
from herringbone.core.wording import option
from herringbone.cosim.adapter import WithoutStates
from herringbone.cosim.fmu.opening import has_further
from herringbone.cosim.nodal import NodalPart
from herringbone.cosim.signature import Kind, Laboratory, Signature
from herringbone.cosim.signature.amplitudes import amplitude
from herringbone.cosim.signature.trial import Refused
from herringbone.cosim.starting.approached_part import approached
from herringbone.cosim.structure.approach import Onward
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.rates import rates
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.content import contents_of_trials
from herringbone.running.foreign.foreign_parts import alike, understood
from herringbone.running.foreign.other_types import held, rounded
from herringbone.running.foreign.start_inputs import known_start_inputs
from herringbone.running.foreign.started import USUAL_STEPS, own_step
from herringbone.running.foreign.trials import found_signature
from herringbone.running.known_parts import without_parts
from herringbone.running.loading import instances, open_parts


def _instead() -> str:
    """What tells of steps that nothing is predicted of."""
    return (
        f"this holds for all algorithms, with {option('simulate', True)}, too; a run with "
        f"{option('step')} tells of a step by its outcome and by its error by steps, at half and "
        "twice the step"
    )


@dataclass
class Surrogates:
    """What stands for the foreign parts of a system.

    Attributes:
        strangers: by name.
        missing: why nothing stands for a part, by name.
        held: lines on connections whose values stay those of the start.
    """

    strangers: dict[str, Stranger] = field(default_factory=dict)
    missing: dict[str, str] = field(default_factory=dict)
    held: tuple[str, ...] = ()

    @property
    def why(self) -> str:
        """Why nothing stands for some parts, in one line."""
        return "; ".join(f"{name}: {why}" for name, why in self.missing.items())

    @property
    def lines(self) -> list[str]:
        """Why nothing is promised, for each part for which nothing stands; then what helps."""
        found = [f"nothing is promised: {name}: {why}" for name, why in self.missing.items()]
        return [*found, _instead()] if found else []


@contextmanager
def surrogates_of(system: System, parts: Sequence[Part], step: float) -> Iterator[Surrogates]:
    """Surrogates of a system's foreign parts, as long as the context lasts.

    Args:
        system: of the parts, in the same order.
        parts: as the coupling takes them, see `understood`; they are left as they are.
        step: of the first trials [s].
    """
    found = Surrogates()
    with ExitStack() as stack:
        if system.foreign_parts:
            network = build_network(system, parts)
            found.missing, found.held = rounded(network), held(network)
            for number, (spec, part) in enumerate(zip(system.parts, parts, strict=True)):
                if spec.foreign and part.name not in found.missing:
                    with activity(f"identifying {part.name}"):
                        _add(found, spec, part, _connected(network, number), step, stack)
        yield found


@contextmanager
def opened_surrogates(system: System, step: float) -> Iterator[Surrogates]:
    """As `surrogates_of`, of parts that are opened for it and closed in the end."""
    if not system.foreign_parts:
        yield Surrogates()
        return
    with closing_all(open_parts(system, "in-process")) as opened:
        parts, _ = understood(system, opened, instances, step)
        with surrogates_of(system, parts, step) as found:
            yield found


def without_missing(system: System, found: Surrogates) -> tuple[System, tuple[str, ...]]:
    """The system without parts for which nothing stands, and lines on these.

    Raises:
        FmuError: nothing is coupled without them.
    """
    if not found.missing:
        return system, found.held
    rest = without_parts(system, found.missing)
    if not rest.connections:
        raise FmuError("; ".join(found.lines))
    names = ", ".join(found.missing)
    told = f"what is told is of the system without {names}"
    return rest, (*found.lines, told, *found.held)


def _add(
    found: Surrogates,
    spec: PartSpec,
    part: Part,
    ports: tuple[list[str], list[str]],
    step: float,
    stack: ExitStack,
) -> None:
    try:
        signature = (
            part.signature
            if isinstance(part, NodalPart)
            else found_signature(spec, part, instances, step)
        )
        make = stack.enter_context(instances(spec))
        made = _surrogate(spec, make, part, signature, ports, step, stack)
    except FmuError as error:
        found.missing[part.name] = str(error)
        return
    if isinstance(made, str):
        found.missing[part.name] = made
    elif made.model is None:
        found.missing[part.name] = made.why
    else:
        found.strangers[part.name] = Stranger(
            part,
            made,
            lambda: alike(part, approached(make(), spec.approach)),
            at_start=spec.approach is not None,
        )


def _surrogate(
    spec: PartSpec,
    make: Callable[[], Part],
    part: Part,
    signature: Signature,
    ports: tuple[list[str], list[str]],
    step: float,
    stack: ExitStack,
) -> Surrogate | SampledSurrogate | str:
    """A part's surrogate, or why there is none; raises FmuError."""
    why = _refusal(part, signature)
    if why:
        return why
    inputs, outputs = ports
    begin = partial(_beginning, spec, make, inputs)
    if part.one_step or signature.tick:
        proposed = [own_step(spec.fmu)] if spec.fmu else []
        steps = list(dict.fromkeys((step, *proposed, *USUAL_STEPS)))
        return _with_clock(begin, part, signature, ports, steps, stack)
    lab = stack.enter_context(begin(step).laboratory(inputs, outputs, step))
    at = part.addresses  # an adapter that holds inputs has none of derivatives
    takes, gives = at.set_derivatives != 0, at.get_derivatives != 0
    tell_cost(lab, part.name)
    found = Surrogate(lab, signature, part.variables, takes_derivatives=takes, gives_rates=gives)
    if takes and not found.orders:
        return "it declares input derivatives, and refuses them"
    return found


class _Beginning(NamedTuple):
    """Where trials of a part begin: with the run, if it starts in steady motion.

    Attributes:
        make: makes an instance that is there.
        start: (n,) inputs there; 0 for angles that turn.
        onward: how these move on; None: they stay.
        content: see `Laboratory`.
    """

    make: Callable[[], Part]
    start: np.ndarray
    onward: Onward | None
    content: tuple[str, ...]

    def laboratory(self, inputs: list[str], outputs: list[str], step: float) -> Laboratory:
        """Of trials from here, with steps of a length [s] at first."""
        return Laboratory(
            self.make, inputs, outputs, self.start, step, onward=self.onward, content=self.content
        )

    def of_one_length(self) -> "_Beginning":
        """The same of a part that takes no others: what was restored may have taken such."""
        make = self.make
        return self._replace(
            make=lambda: WithoutStates(make()), content=(*self.content, "one length")
        )


def _beginning(
    spec: PartSpec, make: Callable[[], Part], inputs: list[str], step: float
) -> _Beginning:
    """Where trials with a step [s] begin; a part that takes no others is brought there by it."""
    content = contents_of_trials(spec)
    if spec.approach and spec.approach.even:
        spec = replace(spec, approach=replace(spec.approach, step=step))
    if spec.approach is None:
        start = known_start_inputs(make, inputs, content) if inputs else np.empty(0)
        return _Beginning(make, start, None, content)
    given = {u.name: u for u in spec.approach.inputs}
    onward = replace(spec.approach, inputs=tuple(given[name] for name in inputs)).onward
    brought = (*content, repr(spec.approach))
    return _Beginning(
        lambda: approached(make(), spec.approach, in_trial=True), onward.still, onward, brought
    )


def _with_clock(
    begin: Callable[[float], _Beginning],
    part: Part,
    signature: Signature,
    ports: tuple[list[str], list[str]],
    steps: Sequence[float],
    stack: ExitStack,
) -> SampledSurrogate | str:
    """The map of a part with a clock of its own, or with steps of one length only."""
    inputs, outputs = ports

    wanted = steps if part.one_step else (round_period(signature.tick),)
    for period in wanted:
        at = begin(period).of_one_length() if part.one_step else begin(period)
        lab = at.laboratory(inputs, outputs, period)
        try:
            stack.enter_context(lab)
        except Refused:
            continue
        pairs = zip(inputs, at.start, strict=True)
        changes = np.array([amplitude(part.variables[name], float(x)) for name, x in pairs])
        divides = signature.kind is Kind.SAMPLED
        return SampledSurrogate(part.name, lab, changes, divides=divides)
    tried = ", ".join(f"{period:g}" for period in wanted)
    return f"it refuses steps of {tried} s, the only ones that were tried"


def _refusal(part: Part, signature: Signature) -> str:
    """Why no trials tell of the part's steps; "" if they do."""
    if not has_further(part):
        return "it can be instantiated once only, and runs in this process"
    no_trials = part.once and signature.kind is Kind.UNKNOWN
    return signature.notes[0] if no_trials or signature.kind is Kind.NOISY else ""


def _connected(network: Network, number: int) -> tuple[list[str], list[str]]:
    """Connected inputs and outputs of a part, with the rates of these."""
    inputs = [c.input for c in network.inputs(number)]
    outputs = network.outputs(number)
    more = rates(network.parts[number], outputs)
    return inputs, list(dict.fromkeys([*outputs, *more]))
