"""Values that are not finite, or beyond all bounds: where, and whether the coupling made them."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from herringbone.core import HerringboneError
from herringbone.core.declaring.declaration import signal_of
from herringbone.core.part import is_signal_node
from herringbone.cosim.loops.common import BOUND
from herringbone.cosim.structure.network import Network

AS_BEFORE, _FEWEST = 10.0, 8
"""What grows by the coupling passes this multiple of what it was in the first half of the rows."""


def diverged(network: Network, culprit: int) -> tuple[str, float]:
    """The first input or output of a part that has diverged, or the output that feeds it.

    Args:
        network: parts and connections.
        culprit: number of the part.

    Returns:
        Its name, "" if there is none, and its value.
    """
    parts = network.parts
    part = parts[culprit]
    names = [
        n for n, v in part.variables.items() if v.causality in {"output", "input"} and v.is_real
    ]
    try:
        found = zip(names, part.get(names), strict=True)
        bad, value = next(((n, x) for n, x in found if not abs(x) < BOUND), ("", 0.0))
        fed = signal_of(bad) if is_signal_node(part.variables, bad) else bad
        for c in network.inputs(culprit):
            if c.input == fed and not abs(parts[c.source].get([c.output])[0]) < BOUND:
                return f"{parts[c.source].name}.{c.output}", value
    except HerringboneError:
        return "", 0.0
    return (f"{part.name}.{bad}", value) if bad else ("", 0.0)


def broken_output(network: Network) -> str | None:
    """The output `instance.variable` that is not finite where what its part was given is.

    Parts that refuse such values, or pass them on, are not where it began; in a circle elements
    pass on at once what bodies give. None if there is none.
    """
    bad: dict[int, str] = {}
    for c in network.connections:
        source = network.parts[c.source]
        try:
            (value,) = source.get([c.output])
        except HerringboneError:
            continue
        if not np.isfinite(value):
            bad.setdefault(c.source, f"{source.name}.{c.output}")
    fed = {c.target for c in network.connections if c.source in bad}
    first = sorted(bad, key=lambda p: (p in fed, p not in network.bodies))
    return bad[first[0]] if first else None


def first_nan(times: np.ndarray, *values: np.ndarray) -> dict[int, float]:
    """When columns are no number for the first time [s], by the number of the column.

    Args:
        times: of rows (n,) [s].
        values: columns (up to n, m) of one kind after the other.
    """
    found: dict[int, float] = {}
    first = 0
    for columns in values:
        nan = np.isnan(columns)
        bad = np.flatnonzero(nan.any(axis=0))
        found |= {first + int(k): float(times[nan[:, k].argmax()]) for k in bad}
        first += columns.shape[1]
    return found


def growth(read: Callable[[], Iterable[np.ndarray]]) -> float | None:
    """Largest value at the end of records over that of their first half; None of too few rows.

    By it a part that ends a run is told from the coupling: see `AS_BEFORE`.

    Args:
        read: gives the records of all outputs, piece by piece (n, m), from the start each time.
            Rows that are not finite do not count.
    """
    number, last = -1, np.empty(0)
    for first, rows in _numbered(read()):
        finite = np.flatnonzero(np.isfinite(rows).all(axis=1))
        if finite.size:
            number, last = first + int(finite[-1]), np.abs(rows[finite[-1]])
    if number + 1 < _FEWEST:
        return None
    before = np.zeros_like(last)
    for first, rows in _numbered(read()):
        half = rows[: max(number // 2 + 1 - first, 0)]
        finite = half[np.isfinite(half).all(axis=1)]
        before = np.maximum(before, np.abs(finite).max(axis=0, initial=0.0))
    grown = last > 0.0
    with np.errstate(divide="ignore"):
        return float((last[grown] / before[grown]).max(initial=0.0))


def _numbered(pieces: Iterable[np.ndarray]) -> Iterator[tuple[int, np.ndarray]]:
    """Pieces, each with the number of its first row."""
    first = 0
    for rows in pieces:
        yield first, rows
        first += len(rows)
