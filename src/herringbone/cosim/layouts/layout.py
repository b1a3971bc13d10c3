"""The network as flat arrays, for the compiled loop."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from herringbone.core.declaring.declaration import node_name
from herringbone.core.part import Part, is_signal_node
from herringbone.cosim.energy.monitor import NOTHING_WATCHED, EnergyMonitor
from herringbone.cosim.layouts.derivatives import Derivatives
from herringbone.cosim.layouts.offsets import offsets
from herringbone.cosim.layouts.slow import Slow, lay_out_slow
from herringbone.cosim.structure.connection import Connection
from herringbone.cosim.structure.network import Network
from herringbone.cosim.structure.rates import rates

HISTORY = 4
"""Rows of the signal history: the newest values, and the three communication points before."""


class Layout(NamedTuple):
    """Parts, signals and stages as arrays; all offsets are CSR (first[i] ... first[i + 1]).

    Inputs of a part are set in one call: all inputs at node 0, then all at node 1, ...

    Attributes:
        component, set_real, get_real, do_step: addresses of each part's instance and functions.
        degree: nodes of each part's inputs in a macro step; 0 holds.
        at_end: 1 for pure elements: their inputs are taken at the end of the macro step.
        input_first: offsets of each part's connected inputs in the next two.
        input_source: the output that feeds an input.
        input_fresh: 1 if that output's part is stepped before the input's part in a macro step, or
            the input's part is slow.
        set_first: offsets of each part's values in the next two.
        set_reference: value references of the inputs, node by node.
        set_value: room for the values that are set there.
        output_first: offsets of each part's connected outputs in the next two, and in the history.
        output_reference: their value references.
        output_record: column of the records in which each stands.
        record_first, record_reference: offsets, and value references, of each part's recorded
            outputs.
        stage_first, stage_part: parts that step together, stage by stage.
        slow: bodies that step once in several macro steps; None if there are none.
        derivatives: parts that take and give FMI derivatives; None if there are none.
    """

    component: np.ndarray
    set_real: np.ndarray
    get_real: np.ndarray
    do_step: np.ndarray
    degree: np.ndarray
    at_end: np.ndarray
    input_first: np.ndarray
    input_source: np.ndarray
    input_fresh: np.ndarray
    set_first: np.ndarray
    set_reference: np.ndarray
    set_value: np.ndarray
    output_first: np.ndarray
    output_reference: np.ndarray
    output_record: np.ndarray
    record_first: np.ndarray
    record_reference: np.ndarray
    stage_first: np.ndarray
    stage_part: np.ndarray
    slow: Slow | None
    derivatives: Derivatives | None


class Chunk(NamedTuple):
    """Macro steps that a compiled loop runs in one go.

    Time is t0 + n h with integer n, so that it does not drift.

    Attributes:
        t0, h: start of the run and macro step [s].
        start, count: first macro step and how many.
        records: one row per `every` macro steps of the run.
        every: macro steps per record.
        energy: watches what the coupling adds.
        first_row: row of the run with which `records` begins; row 0 is at t0.
    """

    t0: float
    h: float
    start: int
    count: int  # type: ignore[assignment]  # hides tuple.count, which nobody calls
    records: np.ndarray
    every: int
    energy: EnergyMonitor = NOTHING_WATCHED
    first_row: int = 0


def record_names(network: Network) -> list[list[str]]:
    """Outputs of each part that are recorded: all real ones, without nodes."""
    return [
        [
            name
            for name, v in part.variables.items()
            if v.causality == "output" and v.is_real and not is_signal_node(part.variables, name)
        ]
        for part in network.parts
    ]


def _references(rows: Sequence[Sequence[int]]) -> np.ndarray:
    return np.array([r for row in rows for r in row], dtype=np.uint32)


def _named_references(parts: Sequence[Part], names: Sequence[Sequence[str]]) -> np.ndarray:
    return _references(
        [[part.variables[n].reference for n in row] for part, row in zip(parts, names, strict=True)]
    )


def _set_references(part: Part, inputs: Sequence[str], degree: int) -> list[int]:
    """References of a part's inputs, node by node."""
    return [
        part.variables[name if node == 0 else node_name(name, node)].reference
        for node in range(degree + 1)
        for name in inputs
    ]


def node_references(
    parts: Sequence[Part], outputs: Sequence[Sequence[str]], degrees: Sequence[int]
) -> tuple[np.ndarray, np.ndarray]:
    """Outputs at node 1 ... degree of each part, node by node: offsets and value references."""
    rows = [
        [
            part.variables[node_name(name, node)].reference
            for node in range(1, degree + 1)
            for name in names
        ]
        for part, names, degree in zip(parts, outputs, degrees, strict=True)
    ]
    return offsets([len(row) for row in rows]), _references(rows)


def connected_outputs(
    network: Network, extra: Sequence[Sequence[str]] | None = None
) -> list[list[str]]:
    """Outputs of each part that the loop reads: connected ones, rates of slow ones, extra ones.

    Each is there once: loops have arrays for as many as there are names.
    """
    outputs: list[list[str]] = [[] for _ in network.parts]
    for c in network.connections:
        if c.output not in outputs[c.source]:
            outputs[c.source].append(c.output)
    of_slow = [(p, rates(network.parts[p], outputs[p])) for p in network.slow]
    for p, names in (*of_slow, *enumerate(extra or ())):
        outputs[p] += [name for name in names if name not in outputs[p]]
    return outputs


def _at_end(network: Network, parallel: bool) -> np.ndarray:
    """Which parts are pure elements that see the end of the macro step."""
    return np.array(
        [
            p in network.elements and p not in network.mixed and not parallel
            for p in range(len(network.parts))
        ],
        np.int64,
    )


def _fresh(
    network: Network, inputs: Sequence[Sequence[Connection]], stages: Sequence[Sequence[int]]
) -> np.ndarray:
    """Which inputs see outputs of the same macro step."""
    position = dict.fromkeys(network.slow, -1)
    position |= {p: s for s, stage in enumerate(stages) for p in stage}
    return np.array(
        [
            p in network.slow or position[c.source] < position[p]
            for p, row in enumerate(inputs)
            for c in row
        ],
        np.int64,
    )


def _places(
    wanted: Iterable[tuple[int, str]], names: Sequence[Sequence[str]], first: np.ndarray
) -> np.ndarray:
    """Places of (part, name) among the names of all parts."""
    return np.array([first[p] + names[p].index(name) for p, name in wanted], dtype=np.int64)


def build_layout(
    network: Network,
    stages: Sequence[Sequence[int]],
    degree: Sequence[int],
    parallel: bool,
    extra: Sequence[Sequence[str]] | None = None,
    per: int = 1,
    derivatives: Derivatives | None = None,
) -> Layout:
    """Lay a network out for stages that are stepped one after another.

    Args:
        network: parts and connections.
        stages: parts by stage; parts of one stage do not see each other's new outputs.
        degree: nodes of each part's inputs.
        parallel: elements take their inputs at the start of the macro step, as in masters that
            step all parts in parallel.
        extra: further outputs of each part that the loop needs, such as accelerations.
        per: values of the signals that the loop knows in a macro step, for slow parts.
        derivatives: parts that take and give FMI derivatives, if there are any.
    """
    parts = network.parts
    inputs = [network.inputs(p) for p in range(len(parts))]
    outputs = connected_outputs(network, extra)
    records = record_names(network)
    set_references = [
        _set_references(part, [c.input for c in row], nodes)
        for part, row, nodes in zip(parts, inputs, degree, strict=True)
    ]
    set_first, output_first, record_first = (
        offsets([len(row) for row in rows]) for rows in (set_references, outputs, records)
    )
    sources = [(c.source, c.output) for row in inputs for c in row]
    read = [(p, name) for p, row in enumerate(outputs) for name in row]
    addresses = np.array([part.addresses[:4] for part in parts], dtype=np.int64)
    return Layout(
        component=addresses[:, 0].copy(),
        set_real=addresses[:, 1].copy(),
        get_real=addresses[:, 2].copy(),
        do_step=addresses[:, 3].copy(),
        degree=np.array(degree, dtype=np.int64),
        at_end=_at_end(network, parallel),
        input_first=offsets([len(row) for row in inputs]),
        input_source=_places(sources, outputs, output_first),
        input_fresh=_fresh(network, inputs, stages),
        set_first=set_first,
        set_reference=_references(set_references),
        set_value=np.zeros(set_first[-1]),
        output_first=output_first,
        output_reference=_named_references(parts, outputs),
        output_record=_places(read, records, record_first),
        record_first=record_first,
        record_reference=_named_references(parts, records),
        stage_first=offsets([len(stage) for stage in stages]),
        stage_part=np.array([p for stage in stages for p in stage], dtype=np.int64),
        slow=lay_out_slow(network, outputs, degree, per),
        derivatives=derivatives,
    )
