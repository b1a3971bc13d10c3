"""Which parts can take a macro step again, as iterated algorithms and adaptive steps ask for."""

from herringbone.core import ParameterError
from herringbone.core.part import Part
from herringbone.cosim.structure.network import Network


def answers_again(part: Part) -> bool:
    """True if a part takes a step once, and answers corrections of it by a surrogate."""
    return bool(getattr(part, "answers_again", False))


def explicit_parts(network: Network) -> tuple[int, ...]:
    """Parts with inputs that cannot repeat a step: they step once, first, on predicted inputs."""
    return tuple(
        p
        for p, part in enumerate(network.parts)
        if network.inputs(p)
        and p not in network.slow
        and not (part.addresses.can_restore or answers_again(part))
    )


def explicit_note(network: Network, part: int) -> str:
    """What it costs that a part cannot repeat a step: a line for the user."""
    return (
        f"{network.parts[part].name} cannot repeat a step: it takes each one once, on predicted "
        "inputs, which makes the coupling there explicit, of third order in the step at most"
    )


def check_rollback(name: str, network: Network, *, of_all: bool = False) -> None:
    """Check that parts with inputs can restore their state: one of them, or all.

    Args:
        name: of the algorithm, for the message.
        network: parts and connections.
        of_all: all must, as where whole steps are taken back.

    Raises:
        ParameterError: they cannot.
    """
    unable = explicit_parts(network)
    if of_all:
        unable += tuple(p for p, part in enumerate(network.parts) if answers_again(part))
    able = any(network.inputs(p) and p not in unable for p in range(len(network.parts)))
    if unable and (of_all or not able):
        names = ", ".join(network.parts[p].name for p in unable)
        raise ParameterError(
            f"{name} repeats steps, but {names} cannot save and restore its state; "
            "use jacobi, gauss_seidel or predict"
        )


def check_sources(name: str, network: Network) -> None:
    """Check that a step can be taken back with its sources, too.

    Args:
        name: of the algorithm, for the message.
        network: parts and connections.

    Raises:
        ParameterError: one cannot be restored.
    """
    unable = [
        network.parts[p].name for p in network.sources if not network.parts[p].addresses.can_restore
    ]
    if unable:
        raise ParameterError(
            f"{name} takes whole steps back, but {', '.join(unable)} cannot save and restore its "
            "state; leave the tolerance out"
        )
