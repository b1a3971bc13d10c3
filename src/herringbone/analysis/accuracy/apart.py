"""How far two runs of the same system with different steps are apart, without a twin."""

from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.error import relative_error
from herringbone.cosim.divergence import AS_BEFORE
from herringbone.result.result import TIME, Result

_FEWEST = 2
"""Records of which anything can be said."""
_CONSTANT = 1e-9
"""Alternating part over the size of a channel below which it is rounding."""
_BEYOND = 100.0
"""Multiple of the better run's largest value, beyond which a run has outgrown it. What the model
itself makes grow differs as the start of the growth does: by 2^p, if that errs with the power p."""
_ROWS = 8
"""Rows of which anything can be said about growth."""


class Outgrown(NamedTuple):
    """An output that has grown far beyond a better run.

    Attributes:
        output: its name.
        value: the largest in the last quarter of the run, in its unit.
        times: rms of its group there, over the largest value of the group in the better run.
    """

    output: str
    value: float
    times: float


class Apart(NamedTuple):
    """Differences of two runs, over the alternating parts of the second.

    Attributes:
        groups: by group of channels; groups that do not vary are left out.
        worst: the output that differs most over its own alternating part; "" if none varies.
        worst_difference: of that one.
    """

    groups: Mapping[str, float]
    worst: str
    worst_difference: float


def apart(first: Result, second: Result, exchanged: Collection[str] = ()) -> Apart:
    """Compare two runs at the times that both have.

    Args:
        first, second: runs of the same system; the second is the better one.
        exchanged: outputs that make groups beside the system's channels, see `groups_of`.
    """
    ours, theirs = _common(first, second)
    if len(ours) < _FEWEST:
        return Apart({}, "", 0.0)
    return differences(ours, theirs, second.signals, groups_of(second, exchanged))


def outgrown(first: Result, second: Result, exchanged: Collection[str] = ()) -> Outgrown | None:
    """What of a run has grown without bound where a better one has not; None: nothing.

    In the last quarter a group is far beyond all that the better run has, and beyond ten times what
    it was in the first half itself: what drifts by a power of time is not, up to the third. A
    motion that truly grows does so in both runs.

    Args:
        first, second, exchanged: as of `apart`.
    """
    ours, theirs = (np.abs(values) for values in _common(first, second))
    rows = len(ours)
    if rows < _ROWS:
        return None
    names, found = second.signals, []
    for columns in groups_of(second, exchanged).values():
        own = [names.index(column) for column in columns]
        begun, ended = ours[: rows // 2 + 1, own].max(), ours[3 * rows // 4 :, own]
        size, most = float(np.sqrt(np.mean(ended**2, axis=0).max())), float(theirs[:, own].max())
        if most > 0.0 and size > max(_BEYOND * most, AS_BEFORE * begun):
            output = columns[int(ended.max(axis=0).argmax())]
            found.append(Outgrown(output, float(ended.max()), size / most))
    return max(found, key=lambda one: one.times, default=None)


def differences(
    ours: np.ndarray,
    theirs: np.ndarray,
    names: Sequence[str],
    groups: Mapping[str, Sequence[str]],
    least: float = 0.0,
) -> Apart:
    """Compare signals at the same times.

    Args:
        ours, theirs: (times, names); the second are the better ones.
        names: of the columns.
        groups: names by group.
        least: alternating part of a group, in its unit, that is none.
    """
    place = {name: number for number, name in enumerate(names)}
    spread = np.std(theirs, axis=0)
    moves = spread > _CONSTANT * np.abs(theirs).max(axis=0, initial=0.0)
    found = {}
    for name, columns in groups.items():
        own = [place[column] for column in columns]
        if varies(theirs[:, own], least):
            found[name] = relative_error(ours[:, own], theirs[:, own])
    off = np.sqrt(np.mean((ours - theirs) ** 2, axis=0))
    single = np.where(moves, off / np.where(moves, spread, 1.0), 0.0)
    if not single.any():
        return Apart(found, "", 0.0)
    worst = int(single.argmax())
    return Apart(found, names[worst], float(single[worst]))


def varies(values: np.ndarray, least: float = 0.0) -> bool:
    """True if a group alternates by more than rounding.

    Args:
        values: (times, channels), the same unit in all channels.
        least: alternating part, in its unit, that is none.
    """
    size, spread = np.abs(values).max(initial=0.0), np.std(values, axis=0).max(initial=0.0)
    return bool(spread > max(least, _CONSTANT * size))


def groups_of(result: Result, exchanged: Collection[str] = ()) -> dict[str, list[str]]:
    """Columns of real numbers by group: the system's channels, and other outputs by unit.

    Args:
        result: of a run.
        exchanged: outputs that count even if no channel has them; without channels and these, all.
    """
    groups = {name: result.channel(name) for name in result.channels}
    taken = {column for columns in groups.values() for column in columns}
    every = not groups and not exchanged
    for column in result.signals:
        wanted = column in exchanged or every
        if wanted and column not in taken:
            groups.setdefault(outputs_in(result.units[column]), []).append(column)
    return {name: columns for name, columns in groups.items() if columns}


def outputs_in(unit: str) -> str:
    """What a group of outputs of a unit is called."""
    return f"outputs in {unit}" if unit not in {"", "1"} else "outputs without unit"


def _common(first: Result, second: Result) -> tuple[np.ndarray, np.ndarray]:
    """Signals of both (n, m) at the times that both have, in the second one's order."""
    names = second.signals
    ours, theirs = first.data[TIME].to_numpy(), second.data[TIME].to_numpy()
    near = np.clip(np.searchsorted(theirs, ours), 1, max(1, theirs.size - 1))
    near = np.where(np.abs(theirs[near - 1] - ours) < np.abs(theirs[near] - ours), near - 1, near)
    same = np.abs(theirs[near] - ours) <= 1e-9 * max(1.0, float(ours[-1]))
    return first.data[names].to_numpy(float)[same], second.data[names].to_numpy(float)[near[same]]
