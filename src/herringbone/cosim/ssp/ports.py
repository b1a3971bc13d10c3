"""Ports of a system from the connectors that an .ssp file gives it.

A port has several signals, `port.quantity`. A file knows connectors of single signals: those that
have all in front of the last dot in common are a port if they lead to the signals of one port of a
part. Other connectors belong to no port; what they lead to is as if it were open.
"""

from collections.abc import Iterable
from typing import NamedTuple

from herringbone.core.names import is_identifier


class Outside(NamedTuple):
    """A connection of the system's own connector.

    Attributes:
        connector: of the system.
        inside: `part.variable`.
    """

    connector: str
    inside: str


def ports_of(connections: Iterable[Outside]) -> tuple[dict[str, str], tuple[str, ...]]:
    """Ports, as paths of inner ports, and the connectors that belong to none."""
    leads: dict[str, set[str]] = {}
    connectors: dict[str, list[str]] = {}
    for connector, inside in connections:
        port, _, quantity = connector.rpartition(".")
        inner, _, same = inside.rpartition(".")
        fits = is_identifier(port) and quantity == same and inner.count(".") > 0
        leads.setdefault(port, set()).add(inner if fits else "")
        connectors.setdefault(port, []).append(connector)
    ports = {
        port: min(inner) for port, inner in leads.items() if len(inner) == 1 and "" not in inner
    }
    others = (c for port, names in connectors.items() if port not in ports for c in names)
    return ports, tuple(sorted(set(others)))
