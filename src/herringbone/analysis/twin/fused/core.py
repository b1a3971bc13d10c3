"""A system whose parts are fused: its condensed core, and the outputs that can be recorded."""

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np

from herringbone.analysis.accuracy.apart import outputs_in
from herringbone.analysis.twin.condensed.equations import Equations, take_apart
from herringbone.analysis.twin.condensed.lean import leaner, with_harmonics
from herringbone.analysis.twin.condensed.recorded.outputs import (
    Outputs,
    affine_places,
    outputs_of_kernels,
)
from herringbone.analysis.twin.condensed.recorded.wanted import places_seen
from herringbone.analysis.twin.condensed.solution import CLOSE, COARSE, Solution
from herringbone.analysis.twin.condensed.system import Condensed, condensed
from herringbone.analysis.twin.monolithic import Twin
from herringbone.core import StructureError, Variable
from herringbone.core.caching.remembered import Remembered
from herringbone.core.lean import WHOLE, Lean
from herringbone.core.places.part_path import in_groups
from herringbone.core.places.wrong_column import meant_columns
from herringbone.cosim.structure.system import System

_OF_TOLERANCE = 100.0
"""Residual whose correction solves a step, over the tolerance: each makes it 1000 times smaller."""

_equations: Remembered[Equations] = Remembered(4)
"""By content; some MB each at the most."""


class Steps(NamedTuple):
    """How a core is marched.

    Attributes:
        length: longest base step [s].
        degree: of the polynomials.
        close: see `solution.CLOSE`.
        lean: see `march_arrays.Fixed`.
    """

    length: float
    degree: int
    close: float = CLOSE
    lean: bool = True


def closeness(tolerance: float) -> float:
    """Residual of the laws whose correction solves a step, for a tolerance."""
    return min(COARSE, _OF_TOLERANCE * tolerance)  # one evaluation of the laws for most steps


class Core:
    """The condensed core of a system.

    Args:
        system: its parts are all components of this package.
        like: of the same structure; what is the same is taken from it.
        same_tangents: take its mean tangents, too, so that harmonics of both can be compared.
        open_inputs: `instance.variable` of inputs that something outside gives.
        lean: what the model leaves out; as `like` if not given.

    Attributes:
        twin: the system as one right-hand side.
        condensed: the same, taken apart.
        affine: which of the places that are seen are affine.
        names: outputs that can be recorded, `instance.variable`.
        missing: outputs that only steps of the components make.
        lean: what the model leaves out.
        content: digest of all that the equations follow from, but for what is left out.

    Raises:
        StructureError: a part can neither be condensed nor stepped inside of the core.
        ParameterError, ResourceError: bad values.
    """

    def __init__(
        self,
        system: System,
        like: "Core | None" = None,
        *,
        same_tangents: bool = False,
        open_inputs: Sequence[str] = (),
        lean: Lean | None = None,
    ) -> None:
        self.lean: Lean = lean if lean is not None else like.lean if like else WHOLE
        self.twin = twin = with_harmonics(Twin(system), self.lean)
        for instance in twin.instances:
            if instance.component.samples:
                raise StructureError(
                    f"{instance.name}: {instance.component.name} takes samples, so that it cannot "
                    "be fused; run without fuse"
                )
        places = [twin.index(name) for name in open_inputs]
        known = like.condensed if like else None
        seen, self.content = places_seen(twin), twin.content
        key = self.content, tuple(seen), tuple(places)
        equations = _equations(key, lambda: take_apart(twin, seen, places))
        apart = leaner(twin, equations, self.lean, seen)
        self.condensed: Condensed = condensed(twin, apart, known, same_tangents=same_tangents)
        same = like is not None and self.condensed.modes.rates is like.condensed.modes.rates
        self.affine: np.ndarray = like.affine if like and same else affine_places(self.condensed)
        self.names = outputs_of_kernels(twin)
        declared = [
            f"{i.name}.{v.name}" for i in twin.instances for v in i.component.declaration.outputs
        ]
        self.missing = tuple(name for name in declared if name not in set(self.names))

    @property
    def unrecorded(self) -> list[str]:
        """A line on outputs that cannot be recorded, if there are any."""
        why = "not recorded, as only steps of the parts make them"
        return [f"{why}: {', '.join(self.missing)}"] if self.missing else []

    def leaner(self, lean: Lean) -> "Core":
        """The core of a leaner model, without taking the system apart again.

        Args:
            lean: what it leaves out besides what this one does.

        Raises:
            StructureError: it names what is not there.
        """
        found, known = copy(self), self.condensed
        found.lean, found.twin = self.lean | lean, with_harmonics(self.twin, lean)
        apart = leaner(found.twin, known.equations, lean, places_seen(found.twin))
        found.condensed = condensed(found.twin, apart, known, same_tangents=True)
        return found

    def chosen(
        self,
        patterns: Sequence[str],
        whole: System | None = None,
        others: Sequence[str] = (),
    ) -> tuple[str, ...]:
        """Outputs that match any of the patterns or are in a group of channels; all without.

        Args:
            patterns: of outputs, or names of groups.
            whole: system whose parts and channels count; the condensed one if None.
            others: outputs of its other parts, which patterns may match as well.

        Raises:
            StructureError: a pattern matches nothing.
        """
        if not patterns:
            return self.names
        system = self.twin.system if whole is None else whole
        wanted = {pattern: system.channels.get(pattern, [pattern]) for pattern in patterns}
        meant = in_groups(system.paths, (*self.names, *others), wanted)
        if missing := [pattern for pattern in patterns if pattern not in meant]:
            hint = meant_columns(missing[0], (*self.names, *others), system.channels)
            raise StructureError(f"record: no output matches '{missing[0]}'; {hint}")
        found = {name for names in meant.values() for name in names}
        return tuple(name for name in self.names if name in found)

    def groups(self) -> dict[str, list[str]]:
        """Outputs by group of channels; of a system without channels all of a unit."""
        return self._groups

    @cached_property
    def _groups(self) -> dict[str, list[str]]:
        system = self.twin.system
        if found := in_groups(system.paths, self.names, system.channels):
            return found
        by_unit: dict[str, list[str]] = {}
        for name in self.names:
            by_unit.setdefault(outputs_in(self.unit(name)), []).append(name)
        return by_unit

    def unit(self, name: str) -> str:
        """Unit of an output, "" if it has none."""
        return self.declared(name).unit

    def declared(self, name: str) -> Variable:
        """The variable that `instance.variable` names."""
        part, variable = self.twin.system.split(name)
        instance = next(i for i in self.twin.instances if i.name == part)
        return instance.component.declaration.variable(variable)

    def solution(self, steps: Steps) -> Solution:
        """A march from the start values on."""
        return Solution(self.condensed, steps.degree, steps.close, lean=steps.lean)

    def outputs(self, columns: Sequence[str], steps: Steps, *, inside: bool) -> Outputs:
        """Values of some outputs; see `Outputs`."""
        return Outputs(self.condensed, self.affine, columns, steps.degree, inside=inside)
