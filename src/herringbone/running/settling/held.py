"""How a run steps foreign parts that take steps of one length only, as that is known before it.

Their inputs are held over a step: at its start, its mean or its end, as the algorithm has it. In a
run whose shafts turn, such a part lags or leads by that, and gives a torque that goes with the
step: what it settles to is that of the run only where it is stepped alike.
"""

from collections.abc import Sequence
from typing import NamedTuple

from herringbone.core.part import Part
from herringbone.cosim.algorithms import Algorithm, choose_algorithm, start_step
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System
from herringbone.running.foreign.foreign_parts import understood
from herringbone.running.loading import instances


class Wanted(NamedTuple):
    """What is asked of the coupling of a run; None: it is chosen by what the parts are.

    Attributes:
        algorithm: of the coupling.
        step: macro step [s].
    """

    algorithm: Algorithm | None = None
    step: float | None = None


NOT_WANTED = Wanted()
"""Nothing is asked."""


class Held(NamedTuple):
    """Steps of a part that takes those of one length only.

    Attributes:
        step: of the run [s].
        share: of a step at which the run takes the inputs that it holds.
    """

    step: float
    share: float


def held_in_run(
    system: System, parts: Sequence[Part], wanted: Wanted, step: float
) -> dict[str, Held]:
    """Steps of the parts that take those of one length only, by name.

    Args:
        system: of the parts, in the same order.
        parts: instantiated.
        wanted: of the run.
        step: of the trials that tell what foreign parts are [s].

    Raises:
        HerringboneError: a part cannot be used, or not with that algorithm.
    """
    if not any(part.one_step for part in parts):
        return {}
    found, _ = understood(system, parts, instances, step)
    algorithm = wanted.algorithm or choose_algorithm(found, wanted.step)[0]
    taken = wanted.step or start_step(algorithm, found)
    prepared = algorithm.prepare(build_network(system, found))
    return {
        part.name: Held(taken, prepared.held_at(p)) for p, part in enumerate(found) if part.one_step
    }
