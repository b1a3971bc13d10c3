"""Checkpoints of a run: taken now and then, and taken up by a fresh process."""

import time
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from herringbone.core import ParameterError
from herringbone.cosim.checkpoint.run_state import (
    Arrays,
    arrays_of,
    can_checkpoint,
    part_arrays,
    put_arrays,
    put_parts,
)

if TYPE_CHECKING:
    from herringbone.cosim.run import Run

SECONDS = 5.0
"""Wall time between two checkpoints."""


class Checkpoints:
    """Takes checkpoints of a run, if its parts allow it.

    Signals of other types than real, and records that are kept in memory, are left to a replay.

    Args:
        run: not started.
    """

    def __init__(self, run: "Run") -> None:
        self._run, self._taken = run, time.perf_counter()
        others = run.others.connected or run.others.recorded
        self._able = run.rows.leave and not others and can_checkpoint(run.network.parts)

    def take_in_time(self, done: int, wall: float) -> None:
        """A checkpoint, if the last one was long ago; see `take`."""
        if self._able and time.perf_counter() - self._taken > SECONDS:
            self.take(done, wall)

    def take(self, done: int, wall: float) -> None:
        """Keep the state after `done` units of the grid.

        Args:
            done: units of the grid.
            wall: time of the loop so far [s].

        Raises:
            HerringboneError: a part does not give its state, or there is no room for it.
        """
        stream = self._run.rows.stream
        if not self._able or stream is None:
            return
        stream.flush(done)
        stream.sink.checkpoint(_saved(self._run, done, wall))
        self._taken = time.perf_counter()

    def take_up(self, saved: Mapping[str, np.ndarray]) -> tuple[int, float]:
        """Go on from a checkpoint, in a run that is initialised and has compiled its loop.

        Returns:
            Units of the grid that are done, and the time that their loop took [s].

        Raises:
            HerringboneError: it is of another run.
        """
        run, stream = self._run, self._run.rows.stream
        if not self._able or stream is None:
            raise ParameterError("the checkpoint is of a run whose parts gave their states")
        if saved["history"].shape != run.history.shape:
            raise ParameterError("the checkpoint is of a run with other signals")
        run.history[...] = saved["history"]
        put_arrays("energy", run.watch.monitor, saved)
        put_parts(run.network.parts, saved)
        run.prepared.put(saved)
        run.record.put(saved["record"])
        stream.rows = int(saved["rows"])
        stream.last = float(saved["last"])
        stream.nan = {int(column): float(time) for column, time in saved["nan"]}
        return int(saved["done"]), float(saved["wall"])


def _saved(run: "Run", done: int, wall: float) -> Arrays:
    """All that the run must remember."""
    stream = run.rows.stream
    assert stream is not None
    return {
        "history": run.history.copy(),
        **arrays_of("energy", run.watch.monitor),
        **part_arrays(run.network.parts),
        **run.prepared.saved(),
        "record": run.record.saved(),
        "rows": np.array(stream.rows),
        "last": np.array(stream.last),
        "nan": np.array([*stream.nan.items()], dtype=float).reshape(-1, 2),
        "done": np.array(done),
        "wall": np.array(wall),
    }
