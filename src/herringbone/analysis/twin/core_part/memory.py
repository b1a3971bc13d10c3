"""Arrays of a march at addresses, so that compiled functions find them behind one pointer.

The memory is a vector of int64: of each array its address and its lengths, tuple after tuple.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.march_arrays import Calls, Fixed, Samples, State, Work
from herringbone.analysis.twin.condensed.recorded.observing import Shown
from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.core.caching.generated import load_generated
from herringbone.kernels.condensed.collocation import Nodes, Sharp, Table
from herringbone.kernels.condensed.correction import Room


class Signals(NamedTuple):
    """What the part exchanges, and where it stands.

    Attributes:
        given: (inputs x STRIDE,) at nodes.
        coefficients: (STRIDE,) room for one polynomial.
        direct: (arguments, inputs) of laws, directly.
        last: (inputs,) at the end of the last step.
        values: (sent outputs x STRIDE,) at nodes; node 0 is the end of a step.
        rest: (other outputs,) at the end of a step.
        inner: (nodes inside, rungs, held, rows) of sent outputs inside of a step.
        made: (nodes inside, rungs) 1 where there are such rows.
        end: (q + channels, rows) of sent outputs at the end of a step.
        rest_end: the same of the others.
        rows: room for rows.
        ends: (channels,) room.
        found: (sent outputs,) room.
        clock: times, see `stepping`.
        flags: integers, see `stepping`.
    """

    given: np.ndarray
    coefficients: np.ndarray
    direct: np.ndarray
    last: np.ndarray
    values: np.ndarray
    rest: np.ndarray
    inner: np.ndarray
    made: np.ndarray
    end: np.ndarray
    rest_end: np.ndarray
    rows: np.ndarray
    ends: np.ndarray
    found: np.ndarray
    clock: np.ndarray
    flags: np.ndarray


_KINDS: dict[type, str] = {
    Sharp: "f1 i1 i1 f1 f2",
    Calls: "f1 i1 i1 i1 i1 i1 i1 i1 i1 i1 i1",
    Fixed: "f1 f3 f1 real real flag Sharp f2",
    Table: "i1 i1 f1 i1 f1 i1 f1 f1",
    Nodes: "f2 f2 f2 f2 f1",
    Room: "f2 f1 f1 f1 f1",
    State: "f1 f1 f2 i1 i1",
    Samples: "f1 f2 f1 f1",
    Work: "f1 f1 f1 f1 i1",
    Rungs: "i1 f3 f3 f3 f3 f3 f1 s3 s3 s3 f2",
    Shown: "f1 i1 i1 i1 i1 f1 i1 i1",
    Signals: "f1 f1 f2 f1 f1 f1 f4 i2 f2 f2 f1 f1 f1 f1 i1",
}
"""Of each field: reals, integers or short reals and its dimensions, a number, or a tuple."""
_TYPES = {"f": np.dtype(np.float64), "i": np.dtype(np.int64), "s": np.dtype(np.float32)}
_WRITTEN = {letter: f"np.{kind}" for letter, kind in _TYPES.items()}
_SIMPLE = {"real": "f0", "flag": "f0"}


def _size(kind: type) -> int:
    return sum(
        _size(Sharp) if word == Sharp.__name__ else 1 + int(_SIMPLE.get(word, word)[1:])
        for word in _KINDS[kind].split()
    )


def _reader(kind: type) -> str:
    """Source of a function that makes a tuple from its place k in the memory m."""
    fields, at = [], 0
    for word in _KINDS[kind].split():
        if word == Sharp.__name__:
            fields.append(f"sharp_at(m, k + {at})")
            at += _size(Sharp)
            continue
        name, dimensions = _SIMPLE.get(word, word)[0], int(_SIMPLE.get(word, word)[1:])
        lengths = "".join(f"m[k + {at + 1 + d}], " for d in range(dimensions)) or "1, "
        array = f"carray(at_address(m[k + {at}]), ({lengths}), {_WRITTEN[name]})"
        shown = {"real": f"{array}[0]", "flag": f"{array}[0] != 0.0"}
        fields.append(shown.get(word, array))
        at += 1 + dimensions
    lines = "".join(f"        {field},\n" for field in fields)
    return (
        f"\n\n@finding\ndef {kind.__name__.lower()}_at(m, k):\n"
        f"    return {kind.__name__}(\n{lines}    )\n"
    )


def _source() -> str:
    imports = "".join(f"from {k.__module__} import {k.__name__}\n" for k in _KINDS)
    return (
        '"""Tuples of arrays behind a memory; generated, not to be edited."""\n\n'
        "import numpy as np\nfrom numba import carray\n\n"
        f"{imports}from herringbone.cosim.loops.calls import at_address\n"
        "from herringbone.kernels.compiling.jit import finding\n" + "".join(map(_reader, _KINDS))
    )


readers = load_generated("memory", _source())
"""Module with a compiled function (memory, place) for each tuple: calls_at, fixed_at ..."""

_ORDER = {
    "calls": Calls, "fixed": Fixed, "table": Table, "nodes": Nodes, "room": Room, "state": State,
    "samples": Samples, "work": Work, "rungs": Rungs, "sent": Shown, "others": Shown,
    "signals": Signals,
}  # fmt: skip
PLACES: dict[str, int] = {}
"""Where each tuple begins in the memory."""
SIZE = 0
for _name, _kind in _ORDER.items():
    PLACES[_name] = SIZE
    SIZE += _size(_kind)


def write(memory: np.ndarray, name: str, held: NamedTuple, kept: dict[str, object]) -> None:
    """Write the addresses of a tuple's arrays.

    Args:
        memory: (SIZE,).
        name: of the tuple.
        held: the tuple.
        kept: takes what must live as long as its addresses.
    """
    words = list(_words(_ORDER[name], held, kept.setdefault(name, [])))  # type: ignore[arg-type]
    memory[PLACES[name] : PLACES[name] + len(words)] = words


def _words(kind: type, held: NamedTuple, kept: list) -> Iterator[int]:
    for word, value in zip(_KINDS[kind].split(), held, strict=True):
        if isinstance(value, Sharp):
            yield from _words(Sharp, value, kept)
            continue
        array = value if isinstance(value, np.ndarray) else np.array([float(value)])
        fits = array.dtype == _TYPES[_SIMPLE.get(word, word)[0]] and array.flags.c_contiguous
        assert fits and (word in _SIMPLE or array.ndim == int(word[1:])), (kind, word)
        kept.append(array)
        yield array.ctypes.data
        if word not in _SIMPLE:
            yield from array.shape
