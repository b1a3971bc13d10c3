"""The monolithic twin: the same equations as the co-simulation, solved as one system.

Dormand-Prince of order 8 (E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
Equations I, 1993, section II.5) at a tolerance far below coupling errors, restarted at the
breakpoints that the components declare.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from copy import copy
from dataclasses import replace
from functools import cached_property
from types import ModuleType

import numpy as np

from herringbone.analysis.twin.called import CalledTwin
from herringbone.analysis.twin.source import TwinLayout, twin_layout, twin_source
from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import component
from herringbone.core import HerringboneError, Instance, StructureError
from herringbone.core.caching.generated import load_generated
from herringbone.core.caching.keys import digest_of
from herringbone.core.caching.remembered import Remembered
from herringbone.core.process.activity import activity
from herringbone.cosim.structure.network import Network, build_network
from herringbone.cosim.structure.system import PartSpec, System

TOLERANCE = 1e-10
"""Relative tolerance of the twin."""
_SIZE = 1e-5
"""Of positions in their units: the absolute tolerance is the relative one, or TOLERANCE if that is
less, of it. Deflections are some um, and what is lost at each step would limit closer solutions."""
_LATE = 1e9
"""Time [s] before which all breakpoints lie."""
_FEW = 20_000
"""Evaluations of a twin in one process for which it is not compiled: a second, or half of it."""
_called: Counter[str] = Counter()
"""Evaluations by calls, by source of the twin."""
_networks: Remembered[Network] = Remembered(32)
"""By connections and components, without parts: values change nothing in it."""


def refuse_foreign_parts(
    system: System,
    then: str = "there is no monolithic reference for this system",
    instead: str = "",
) -> None:
    """Check that the equations of all parts are known.

    Args:
        system: of the parts.
        then: what follows if they are not.
        instead: what to do.

    Raises:
        StructureError: a part is a foreign FMU.
    """
    if system.foreign_parts:
        one = len(system.foreign_parts) == 1
        what, whose = ("is a foreign FMU", "its") if one else ("are foreign FMUs", "their")
        raise StructureError(
            f"{', '.join(system.foreign_parts)} {what}: {whose} equations are not known, so "
            f"that {then}{instead and f'; {instead}'}"
        )


def make_instances(system: System) -> list[Instance]:
    """Instances of a system's components, values set and initialised.

    Raises:
        StructureError: a part is a foreign FMU, whose equations are not known.
        ParameterError, ResourceError: bad values.
    """
    refuse_foreign_parts(system)
    return [make_instance(spec) for spec in system.parts]


def make_instance(spec: PartSpec) -> Instance:
    """Instance of a part's component, values set and initialised.

    Raises:
        ParameterError, ResourceError: bad values.
    """
    instance = Instance(component(str(spec.component)), spec.name)
    for name, value in spec.values.items():
        instance.set(name, value)
    instance.initialise()
    return instance


def _network(system: System, instances: list[Instance]) -> Network:
    """See `build_network`."""
    parts = tuple(InProcessPart(i) for i in instances)
    key = system.connections, tuple((part.name, part.component) for part in system.parts)
    known = _networks(key, lambda: replace(build_network(system, parts), parts=()))
    return replace(known, parts=parts)


class Twin:
    """A system as one right-hand side.

    Args:
        system: its parts are all components of this package.

    Raises:
        StructureError, ParameterError, ResourceError: see `make_instances`, `build_network`.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.instances = make_instances(system)
        self.network = _network(system, self.instances)
        self._places: dict[str, int] = {}
        self.layout: TwinLayout = twin_layout(self.instances)
        self._source = twin_source(self.network, self.instances, self.layout)
        self._by_calls = CalledTwin(self.network, self.instances, self.layout)
        self.block = np.concatenate([i.block for i in self.instances])

    def __reduce__(self) -> tuple[Callable[..., "Twin"], tuple[System, dict[str, np.ndarray]]]:
        """Made anew, with the same values: what is compiled is that of a process."""
        return _with_values, (self.system, {i.name: i.block for i in self.instances})

    def with_blocks(self, blocks: Mapping[str, np.ndarray]) -> "Twin":
        """The same with other values, tables among them, in the blocks of some parts, by name."""
        found = object.__new__(Twin)
        found.__dict__.update(self.__dict__)
        found.instances = [copy(instance) for instance in self.instances]
        for instance in found.instances:
            instance.block = blocks.get(instance.name, instance.block)
        found.block = np.concatenate([i.block for i in found.instances])
        return found

    @cached_property
    def _compiled(self) -> ModuleType:
        return load_generated("twin", self._source)

    def _equations(self, evaluations: int) -> CalledTwin | ModuleType:
        """The equations, compiled from where on it pays; bits are equal."""
        asked = _called[self._source] + evaluations
        if asked > _FEW:
            return self._compiled
        _called[self._source] = asked
        return self._by_calls

    @property
    def content(self) -> str:
        """Digest of all that the equations follow from: structure, and what blocks start with."""
        return digest_of(self._source, *(i.block.tobytes() for i in self.instances))

    @property
    def state(self) -> np.ndarray:
        """Start values of all states (n,)."""
        counts = [i.component.declaration.state_count for i in self.instances]
        return np.concatenate([i.block[:n] for i, n in zip(self.instances, counts, strict=True)])

    @cached_property
    def turning(self) -> list[int]:
        """Indices of the states that are angles that grow."""
        return [
            first + k
            for first, instance in zip(self.layout.state_first, self.instances, strict=False)
            for k, state in enumerate(instance.component.declaration.states)
            if state.steady == "rotating"
        ]

    def rhs(self, t: float, x: np.ndarray) -> np.ndarray:
        """Derivative of all states (n,) at time t [s]."""
        dx = np.zeros_like(x)
        self._equations(1).rhs(self.block, x, float(t), dx)
        return dx

    def index(self, column: str) -> int:
        """Index in the twin's block of `instance.variable`."""
        if column not in self._places:
            self._places[column] = self._place(column)
        return self._places[column]

    def _place(self, column: str) -> int:
        name, variable = self.system.split(column)
        for p, instance in enumerate(self.instances):
            if instance.name == name:
                declaration = instance.component.declaration
                return self.layout.block_first[p] + declaration.index[variable]
        raise StructureError(f"the twin has no part '{name}'")

    def observe(
        self,
        times: np.ndarray,
        states: np.ndarray,
        columns: Sequence[str],
        block: np.ndarray | None = None,
    ) -> np.ndarray:
        """Values (times, columns) of outputs at times and states (n, times).

        The block, of all parts, is the twin's own if none is given.
        """
        values = np.empty((times.size, len(columns)))
        indices = np.array([self.index(c) for c in columns], dtype=np.int64)
        equations = self._equations(times.size)
        equations.observe(
            self.block if block is None else block,
            times,
            np.ascontiguousarray(states),
            indices,
            values,
        )
        return values

    def breakpoints(self, t_end: float) -> list[float]:
        """Times in (0, t_end) at which the right-hand side is not smooth."""
        found = {t for i in self.instances for t in i.component.breakpoints(i.block)}
        return sorted(t for t in found if 0.0 < t < t_end)

    @property
    def settled(self) -> float:
        """Time [s] after which the right-hand side is smooth for good."""
        return max([0.0, *self.breakpoints(_LATE)])

    def solve(
        self,
        times: np.ndarray,
        columns: Sequence[str],
        tolerance: float = TOLERANCE,
        progress: Callable[[float, float], None] | None = None,
    ) -> np.ndarray:
        """Outputs (times, columns) of the solution from the start values.

        Args:
            times: ascending, from 0 [s].
            columns: `instance.variable`.
            tolerance: relative tolerance; 1e-13 leaves 1e-9 of what alternates, 1e-10 some 5e-8
                where teeth meet and part.
            progress: called with the time reached and the end [s].

        Raises:
            HerringboneError: the solver gives up.
        """
        t_end = float(times[-1])
        states = np.empty((self.state.size, times.size))
        x, t0 = self.state, 0.0
        what = f"solving {self.system.name} as one system"
        with activity(what, shown=progress is not None):
            for t1 in [*self.breakpoints(t_end), t_end]:
                last = t1 == t_end
                inside = (times >= t0) & ((times <= t1) if last else (times < t1))
                x = self._solve_piece(
                    t0, t1, x, times, np.flatnonzero(inside), states, tolerance, progress
                )
                t0 = t1
        return self.observe(times, states, columns)

    def _solve_piece(
        self,
        t0: float,
        t1: float,
        x: np.ndarray,
        times: np.ndarray,
        rows: np.ndarray,
        states: np.ndarray,
        tolerance: float,
        progress: Callable[[float, float], None] | None,
    ) -> np.ndarray:
        """Solve between two breakpoints; fills the states at the wanted rows."""
        from scipy.integrate import DOP853  # noqa: PLC0415 (lazy)

        smallest = _SIZE * min(tolerance, TOLERANCE)
        solver = DOP853(self.rhs, t0, x, t1, rtol=tolerance, atol=smallest)
        wanted = times[rows]
        position = 0
        while solver.status == "running":
            message = solver.step()
            if solver.status == "failed":
                raise HerringboneError(f"the monolithic twin stops at {solver.t:g} s: {message}")
            end = int(np.searchsorted(wanted, solver.t, side="right"))
            if end > position:
                inside = wanted[position:end]
                states[:, rows[position:end]] = solver.dense_output()(inside)
                position = end
            if progress:
                progress(solver.t, float(times[-1]))
        return solver.y


def _with_values(system: System, blocks: Mapping[str, np.ndarray]) -> Twin:
    return Twin(system).with_blocks(blocks)
