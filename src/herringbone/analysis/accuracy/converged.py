"""A reference for systems that have no twin: a run of the same parts at a much shorter step.

What the parts themselves err is in both, and does not show.
"""

import math
from collections.abc import Callable, Mapping, Sequence

from herringbone.analysis.accuracy.apart import outputs_in, varies
from herringbone.analysis.accuracy.error import Rows, errors_by_group
from herringbone.core import HerringboneError, OutcomeKind
from herringbone.core.part import Part, closing_all
from herringbone.core.places.part_path import in_groups
from herringbone.cosim.algorithms import LI, Algorithm, Jacobi
from herringbone.cosim.rows.record import Grid
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import simulate
from herringbone.cosim.structure.network import build_network
from herringbone.cosim.structure.system import System
from herringbone.cosim.units import own_unit

_FINER = 4
"""The reference's steps in the shortest step of the runs, at the least."""
_SHARED = 4
"""So many times more steps than that are made, if one run then serves all."""


class Converged:
    """Outputs of a system at the communication points of several runs, from finer runs.

    Args:
        system: structure with start values.
        open_parts: makes its parts.
        grids: communication points of the runs.

    Attributes:
        groups: columns by channel group; all connected outputs by unit if the system names no
            channels.
        note: what the reference is.

    Raises:
        HerringboneError: a part cannot be used.
    """

    def __init__(
        self, system: System, open_parts: Callable[[], list[Part]], grids: Sequence[Grid]
    ) -> None:
        self._system, self._open_parts = system, open_parts
        with closing_all(open_parts()) as parts:
            network = build_network(system, parts)
            repeats = all(p.addresses.can_restore for p in parts)
            names = list(network.exchanged)
            sources = [(network.parts[c.source], c.output) for c in network.connections]
            units = {
                f"{part.name}.{name}": own_unit(part.variables[name]) for part, name in sources
            }
        self._algorithm: Algorithm = LI(degree=4) if repeats else Jacobi(order=2)
        self.groups = in_groups(system.paths, names, system.channels) or _by_unit(names, units)
        most = max(grid.count for grid in grids)
        common = math.lcm(*(grid.count for grid in grids))
        self._fewest = _FINER * most
        shared = common * math.ceil(self._fewest / common)
        self._common = common if shared <= _SHARED * self._fewest else 0
        self._runs: dict[int, Recording] = {}
        t_end = grids[0].step * grids[0].count
        self.note = (
            f"errors against runs of the same parts with {self._algorithm} in steps of at most "
            f"{t_end / self._fewest:.3g} s; what the parts themselves err does not show"
        )

    def errors(self, recording: Recording) -> dict[str, float]:
        """Relative error by channel group; infinite if the run ended early.

        Groups that do not vary are left out, if others do.
        """
        if not recording.outcome.reached_end:
            return dict.fromkeys(self.groups, math.inf)
        count = len(recording.time) - 1
        finer, every = self._at(count, float(recording.time[-1]))
        run, exact = (Rows(r.values[::k], r.names) for r, k in ((recording, 1), (finer, every)))
        moving = {name: own for name, own in self.groups.items() if varies(exact.of(own))}
        return errors_by_group(moving or self.groups, run, exact)

    def _at(self, count: int, t_end: float) -> tuple[Recording, int]:
        """A finer run, and every how many of its rows are the points of a run of so many steps."""
        rows = self._common or count
        if rows not in self._runs:
            pieces = math.ceil(self._fewest / rows)
            grid = Grid(t_end / (rows * pieces), rows * pieces, pieces)
            with closing_all(self._open_parts()) as parts:
                run = simulate(self._system, parts, self._algorithm, grid)
            if run.outcome.kind is OutcomeKind.INTERRUPTED:  # with it the chart
                raise KeyboardInterrupt
            if not run.outcome.reached_end:
                raise HerringboneError(
                    f"the reference, {self._algorithm} at {grid.step:.3g} s, ended early: "
                    f"{run.outcome.message}"
                )
            self._runs[rows] = run
        return self._runs[rows], rows // count


def _by_unit(names: Sequence[str], units: Mapping[str, str]) -> dict[str, list[str]]:
    """Outputs by unit, as a run tells its error."""
    groups: dict[str, list[str]] = {}
    for name in names:
        groups.setdefault(outputs_in(units[name]), []).append(name)
    return groups
