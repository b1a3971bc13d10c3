"""Connections of other types than double precision, for what is predicted before a run."""

from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network

_ROUNDED = "Float32"


def rounded(network: Network) -> dict[str, str]:
    """Parts that exchange motions or forces in single precision, and why nothing stands for them.

    They couple as any others, but once in a step; trials, which read doubles, do not see it.
    """
    return {
        network.parts[c.source].name: (
            f"{c.output} is a {_ROUNDED}, held over a step, of which trials tell nothing"
        )
        for c in reversed(network.others)
        if _type(network, c) == _ROUNDED
    }


def held(network: Network) -> tuple[str, ...]:
    """A line on whole numbers, truth values and texts, which a linear system does not change."""
    others = [c for c in network.others if _type(network, c) != _ROUNDED]
    if not others:
        return ()
    c, more = others[0], f" and {len(others) - 1} more" if len(others) > 1 else ""
    source, target = network.parts[c.source].name, network.parts[c.target].name
    return (
        f"connection '{source}.{c.output}' -> '{target}.{c.input}'{more}, of type "
        f"{_type(network, c)}: the value stays that of the start in what is predicted",
    )


def _type(network: Network, c: Connection) -> str:
    return network.parts[c.source].variables[c.output].type
