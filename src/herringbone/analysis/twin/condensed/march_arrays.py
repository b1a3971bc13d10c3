"""The arrays of the compiled march."""

from typing import NamedTuple

import numpy as np

from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.kernels.condensed.collocation import Nodes, Sharp, Table
from herringbone.kernels.condensed.correction import Room


class Calls(NamedTuple):
    """Laws and sources by address; offsets by part, totals at the end.

    Attributes:
        blocks: the blocks of all parts, one behind the other; laws may write into theirs.
        law: (parts,) addresses of the laws.
        block: (parts,) where their blocks begin.
        clock: (parts,) places in all blocks where they expect the time, or -1.
        argument, value, tangent, indicator: (parts + 1,) offsets.
        source: (sources,) addresses of functions that write a source's signals, which are called
            at every node; none if all signals are known curves.
        source_block: (sources,) where their blocks begin.
        signal: (signals,) places of the signals; -1 of open inputs, which are always curves.
    """

    blocks: np.ndarray
    law: np.ndarray
    block: np.ndarray
    clock: np.ndarray
    argument: np.ndarray
    value: np.ndarray
    tangent: np.ndarray
    indicator: np.ndarray
    source: np.ndarray
    source_block: np.ndarray
    signal: np.ndarray


class Fixed(NamedTuple):
    """What depends on the system and the degree alone.

    Attributes:
        offset: (rows,) of `Rungs`, of the angles at the start.
        ahead: (differences of rungs, nodes, nodes of the last step): its polynomial, by its values,
            continued; the middle one is of equal steps, later ones of shorter ones.
        nodes: (nodes,) places in a step.
        one: value of the last channel, 0 if nothing depends on it.
        close: residual of the laws' values, over their size, whose correction solves a step.
        lean: arguments are taken along sharp directions alone at the nodes inside of a step, and
            are linear over the step along others.
        sharp: these directions.
        between: (nodes - 1, nodes) see `collocation.turned`.
    """

    offset: np.ndarray
    ahead: np.ndarray
    nodes: np.ndarray
    one: float
    close: float
    lean: bool
    sharp: Sharp
    between: np.ndarray


class State(NamedTuple):
    """Where a march stands.

    Attributes:
        q: (2 modes + rotations,) real parts of the coordinates, imaginary parts, and angles since
            the start [rad]: a sum of small steps keeps its digits; then zeros, see `Rungs`.
        u: (channels x nodes,) values of the step that was taken last.
        curve: (signals, 6) since when [s], and coefficients of powers of the time since then.
        place: base step, place in it in shortest steps, rung, rung of the last step (-1: none, or
            the laws bent in it), times that are kept, 1 if the laws' inputs in `Work.u` are those
            of the next step, nearly.
        counted: see `STEPS`.
    """

    q: np.ndarray
    u: np.ndarray
    curve: np.ndarray
    place: np.ndarray
    counted: np.ndarray


class Work(NamedTuple):
    """Room of a march: inputs of a step, twice (as of `State.u`), rows, twice, and places."""

    u: np.ndarray
    v: np.ndarray
    free: np.ndarray
    rows: np.ndarray
    chosen: np.ndarray


class Arrays(NamedTuple):
    """What a march works on."""

    calls: Calls
    fixed: Fixed
    table: Table
    nodes: Nodes
    room: Room
    state: State
    work: Work


class Samples(NamedTuple):
    """What is kept for each time that is wanted: the step that contains it.

    Attributes:
        times: ascending [s].
        held: (times, q + inputs): q and u of `State`, at the start of the step.
        since: [s] since the start of the step.
        length: of the step [s].
    """

    times: np.ndarray
    held: np.ndarray
    since: np.ndarray
    length: np.ndarray


class Asked(NamedTuple):
    """What a march is asked.

    Attributes:
        rungs: matrices of its base step, and of shorter ones.
        samples: what is to be kept; filled.
        t0: start of base step 0 [s].
        steps: base steps in all.
    """

    rungs: Rungs
    samples: Samples
    t0: float
    steps: int
