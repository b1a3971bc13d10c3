"""Choice of the algorithm by what the parts can do."""

from collections.abc import Sequence

from herringbone.core.part import Part
from herringbone.cosim.algorithms.base import Algorithm
from herringbone.cosim.algorithms.jacobi import Jacobi
from herringbone.cosim.algorithms.li import LI
from herringbone.cosim.structure.repeating import answers_again

AUTO = "auto"


def choose_algorithm(parts: Sequence[Part], step: float | None = None) -> tuple[Algorithm, str]:
    """The most accurate algorithm that the parts allow, and a line that says why.

    li repeats steps. Parts that cannot take theirs once, on predicted inputs, which jacobi does
    with all parts at half the cost: it is the choice then, up to the step that is its default.

    Args:
        parts: participants.
        step: that was asked for [s].
    """
    unable = [
        part.name
        for part in parts
        if not part.addresses.can_restore
        and any(v.causality == "input" for v in part.variables.values())
    ]
    unable = [name for name in unable if name not in _answering(parts)]
    long = step is not None and step > Jacobi.default_step
    able = any(part.addresses.can_restore for part in parts) or bool(_answering(parts))
    if unable and not (long and able):
        chosen: Algorithm = Jacobi()
        why = f"{', '.join(unable)} cannot save and restore its state"
    elif unable:
        chosen = LI()
        why = (
            f"the step is longer than jacobi's; {', '.join(unable)} cannot repeat a step, the "
            "others can"
        )
    else:
        chosen = LI()
        why = _why_all(_answering(parts))
    return chosen, f"{AUTO}: {chosen}, because {why}"


def start_step(algorithm: Algorithm, parts: Sequence[Part]) -> float:
    """Macro step [s] if none is given: jacobi's at the most where parts cannot repeat a step.

    What they missed acts a step late, so that they are coupled about as explicitly as by jacobi.
    """
    step = algorithm.start_step
    return min(step, Jacobi.default_step) if _answering(parts) else step


def _answering(parts: Sequence[Part]) -> list[str]:
    """Names of the parts that step once, and answer corrections by a surrogate."""
    return [part.name for part in parts if answers_again(part)]


def _why_all(answering: Sequence[str]) -> str:
    """Why li suits all parts."""
    if not answering:
        return "all parts save and restore their state"
    names = ", ".join(answering)
    whose = "its state, but its" if len(answering) == 1 else "their states, but their"
    return (
        f"{names} cannot save and restore {whose} direct feedthrough tells what corrections change"
    )
