"""One macro step of an algorithm from an operating point that is disturbed in one entry.

Entries are what the step maps: values of all parts' blocks, signals at the communication points
that the algorithm looks back to, and rates of outputs at the start of the step.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import replace
from functools import partial

import numpy as np

from herringbone.analysis.stability.coordinates import Coordinates
from herringbone.analysis.stability.given_derivatives import check_orders, rated_outputs
from herringbone.analysis.stability.steps.linear_part import CHANGE, OTHER_CHANGE
from herringbone.analysis.stability.steps.step_map import linear_part
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.core import HerringboneError, Instance
from herringbone.cosim.algorithms import Algorithm
from herringbone.cosim.algorithms.prepared import PreparedRun
from herringbone.cosim.layouts.layout import HISTORY, Chunk, record_names
from herringbone.cosim.layouts.starts import starts_of
from herringbone.cosim.loops.common import DONE, get_all
from herringbone.cosim.structure.network import Network

_ROWS = HISTORY - 1
_PER_SECOND = 1e3
"""Differences of rates over those of the outputs [1/s]."""
_START = HISTORY
"""A macro step by which all history is there."""
_NEVER = 1 << 40
_FEW = 8
"""Calls for columns from which on it pays to compile the loop over them."""
_calls: Counter[type[PreparedRun]] = Counter()
"""In this process, by whose loop it is."""


class DisturbedSteps:
    """Macro steps of one algorithm on one system of linear parts.

    Args:
        network: parts and connections.
        members: its parts at the operating point, as `linear_network` gives them; they are left as
            they were.
        algorithm: coupling algorithm.

    Attributes:
        network: of the linear parts.
        parts: these.
        coordinates: in which their states are disturbed.
        changes: (all,) difference of each entry.
        z_changes: (n,) those of the coordinates, signals and rates.
        outputs: (m,) of all parts after the last step; a view.
        output_first: first output of each part.

    Raises:
        ParameterError: a part cannot do what the algorithm needs.
    """

    def __init__(
        self, network: Network, members: Sequence[Instance | StandIn], algorithm: Algorithm
    ) -> None:
        self.parts = [linear_part(member) for member in members]
        self.network = replace(network, parts=tuple(part.part for part in self.parts))
        self._start = [part.values.copy() for part in self.parts]
        self._laid_out = algorithm.prepare(self.network)  # the same for all steps
        self._laid_out.correct_evenly()
        layout = self._laid_out.layout
        check_orders(layout, self.parts)
        outputs = layout.output_reference.size
        self.output_first = layout.output_first
        self._records = np.zeros((1, sum(len(names) for names in record_names(network))))
        self._base = np.zeros((HISTORY, outputs))
        get_all(layout, self._base, self._records, 0)
        self._base[1:] = self._base[0]
        self._history = self._base.copy()
        self.outputs = self._history[0]
        signals = self._signal_changes(layout.output_first, layout.output_reference)
        self._rated = rated_outputs(layout)
        self._rates = np.zeros(self._rated.size)  # at the start of a step
        signals = np.concatenate([signals, _PER_SECOND * signals[self._rated]])
        self.coordinates = Coordinates(self.parts, signals.size)
        self.changes = np.concatenate([self.coordinates.changes, signals])
        self.z_changes = np.concatenate([self.coordinates.z_changes, signals])
        seen = [*self.coordinates.counts, _ROWS * outputs, self._rates.size]
        arrays = [*(part.values for part in self.parts), self._history, self._rates]
        self._array = np.repeat(np.arange(len(arrays)), seen)
        self._place = np.concatenate([np.arange(count) for count in seen])
        self._seen = [array.ravel()[:count] for array, count in zip(arrays, seen, strict=True)]
        # Many macro steps in one call: of parts that are what their values and last steps are.
        last_steps = [part.last_step for part in self.parts if isinstance(part, StandIn)]
        known = starts_of([*arrays, *last_steps], [*seen, *[0] * len(last_steps)])
        self._starts = None if self._rates.size else known

    def _signal_changes(self, first: np.ndarray, references: np.ndarray) -> np.ndarray:
        """Difference of each signal that an algorithm looks back to."""
        signals: list[float] = []
        for p, part in enumerate(self.parts):
            known = self.network.parts[p].variables.values()
            outputs = {v.reference: v for v in known if v.causality == "output"}
            for reference in references[first[p] : first[p + 1]]:
                v = outputs[int(reference)]
                change = CHANGE.get(v.unit or "", OTHER_CHANGE)
                signals.append(part.output_change(v.name, change))
        return np.array(signals * _ROWS)

    @contextmanager
    def prepared(self, step: float) -> Iterator[PreparedRun]:
        """A run of the algorithm; afterwards the parts are as they were."""
        prepared = copy(self._laid_out)
        try:
            for part, degree in zip(self.parts, prepared.degree, strict=True):
                part.prepare(step, degree)
            yield prepared
        finally:
            self._restore()
            for part in self.parts:
                part.release()

    def advance(
        self,
        prepared: PreparedRun,
        step: float,
        disturbed: Callable[[], None] = lambda: None,
    ) -> np.ndarray:
        """Entries after one macro step from the operating point, which is disturbed before."""
        chunk = Chunk(-_START * step, step, _START, 1, self._records, _NEVER)
        while True:
            self._restore()
            disturbed()
            if (rates := prepared.start_rates) is not None:
                rates[self._rated] = self._rates
            status, _, culprit = prepared.run(self._history, chunk)
            if (rates := prepared.start_rates) is not None:
                self._rates[:] = rates[self._rated]
            if status == DONE:
                return np.concatenate(self._seen)
            self._learn(culprit, step)

    def moved(
        self, prepared: PreparedRun, step: float, entries: np.ndarray, changes: np.ndarray
    ) -> np.ndarray:
        """(k, all) entries after a macro step from each of k changes (k,) of one entry alone."""
        if self._starts is None:
            found = [
                self.advance(prepared, step, partial(self.perturb, entry, change))
                for entry, change in zip(entries.tolist(), changes.tolist(), strict=True)
            ]
            return np.reshape(found, (entries.size, self._array.size))
        chunk = Chunk(-_START * step, step, _START, 1, self._records, _NEVER)
        starts = self._starts.changed(self._array[entries], self._place[entries], changes)
        kind = type(prepared)
        _calls[kind] += 1
        run_from = kind.run_from if _calls[kind] > _FEW else PreparedRun.run_from
        begin = 0
        while True:
            status, begin, culprit = run_from(prepared, starts, begin, self._history, chunk)
            if status == DONE:
                return starts.found
            self._learn(culprit, step)

    def _learn(self, culprit: int, step: float) -> None:
        """Let parts make ready for a step that was refused; raises HerringboneError if none can."""
        if not any([part.learn() for part in self.parts]):
            name = self.parts[culprit].name if culprit >= 0 else "the coupling"
            raise HerringboneError(f"{name} fails in one step of {step:g} s from equilibrium")

    def _restore(self) -> None:
        self._history[:] = self._base
        self._rates[:] = 0.0
        for part, start in zip(self.parts, self._start, strict=True):
            part.values[:] = start
            part.begin()

    def perturb(self, entry: int, change: float) -> None:
        """Add to an entry, before a step."""
        self._seen[self._array[entry]][self._place[entry]] += change  # views
