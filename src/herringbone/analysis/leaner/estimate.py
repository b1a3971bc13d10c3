"""What a leaner model would change of a motion, without solving for that of the leaner model.

One linear solve with the Jacobian J of the balance at the motion of the whole model, whatever is
left out:

    F_lean(r) = what the laws give and the motion lacks, with the leaner linear part
    r_lean = r - J^-1 F_lean(r),    y_lean = H_lean r_lean

All of the linear part, reactions included, is exact; the laws are followed along their slopes.
"""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from herringbone.analysis.leaner.question import Apart, Lines, Question, apart, lines_of
from herringbone.analysis.leaner.reactions import Reactions
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.correction import (
    Bent,
    bent,
    jacobian,
    packed,
    sloped,
    unpacked,
)
from herringbone.analysis.steady.harmonic_balance.families import Families
from herringbone.analysis.steady.harmonic_balance.fourier import in_frequency, in_time, on
from herringbone.analysis.steady.harmonic_balance.krylov import gmres
from herringbone.analysis.steady.harmonic_balance.orbit import Period
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure, alternating_rows
from herringbone.core import ParameterError
from herringbone.core.one_thread import one_blas_thread

_CLOSE = 0.01
"""Residual of the linear equations of a period of many meshes."""


class Estimates:
    """Errors of leaner models at a motion of the whole one.

    Args:
        state: that motion.
        questions: what is asked of it; outputs that are affine.
        names: states that may be held.

    Raises:
        ParameterError: an output is a product of others.
    """

    def __init__(
        self, state: SteadyState, questions: Sequence[Question], names: Sequence[str]
    ) -> None:
        self._state, self._questions = state, questions
        columns = dict.fromkeys(c for q in questions for c in q.columns)
        self._place = {name: k for k, name in enumerate(columns)}
        self._rows = _rows(state.structure, tuple(columns))
        orbit = state.orbit
        with one_blas_thread():
            self._lines = {question.name: lines_of(state, question) for question in questions}
            problem = state.structure.problem
            one = state.meshes == 1
            self._found: Bent = (
                sloped(problem, orbit.samples, every=True) if one else bent(problem, orbit.samples)
            )
            self._inverse: Callable[[np.ndarray], np.ndarray] = (
                self._of_a_mesh() if one else self._of_many()
            )
            self._reactions = Reactions(state, names, self._found, self._rows)
            self._moving = self._reactions.moving(orbit.channels)
            self._whole = orbit.response.outputs(self._rows, orbit.q, orbit.channels)

    def held(self, names: Sequence[str]) -> dict[str, Apart]:
        """Errors by question if these states are held."""
        places = self._reactions.places
        own = [places[name] for name in names if name in places]
        with one_blas_thread():
            push = self._reactions.holding(own, self._moving)
            step = self._answered(own, push)
            channels = np.zeros_like(self._state.orbit.channels)
            channels[self._found.unknown] = step
            again = self._reactions.moving(channels)
            push = push + self._reactions.holding(own, again)
            changed = self._changed(own, push, channels)
        return self._apart(self._whole + changed, self._state.orbit.response.orders)

    def alone(self, names: Sequence[str]) -> dict[str, Mapping[str, Apart]]:
        """Errors by state and question if each of these is held alone, with what goes with it."""
        with one_blas_thread():
            every = self._reactions.alone(self._moving)
            found: dict[str, Mapping[str, Apart]] = {}
            nothing = np.zeros_like(self._state.orbit.channels)
            for name in names:
                if (place := self._reactions.places.get(name)) is None:
                    continue
                push = every[[place]]
                channels = nothing.copy()
                channels[self._found.unknown] = self._answered([place], push)
                changed = self._changed([place], push, channels)
                orders = self._state.orbit.response.orders
                found[name] = self._apart(self._whole + changed, orders)
        return found

    def of(self, structure: Structure) -> dict[str, Apart]:
        """Errors by question of a leaner model of the same states and tangents."""
        state, orbit = self._state, self._state.orbit
        with one_blas_thread(), np.errstate(all="ignore"):
            balance = Balance(structure.problem, self._period, state.motion)
            response, missing = balance.missing(orbit)
            orders, known = response.orders, orbit.response.orders
            own = on(known, missing[: structure.problem.values], orders)
            step = on(orders, own, known)
            step[self._found.unknown] = on(orders, self._inverse(own[self._found.unknown]), known)
            given = on(orders, orbit.channels, known)
            given[: len(step)] += step
            rows = _rows(structure, tuple(self._place))
            values = response.outputs(rows, response.coordinates(given), given)
        return self._apart(values, orders)

    @property
    def _period(self) -> Period:
        state = self._state
        per_mesh = state.orbit.places // state.meshes
        thin = 0.0 if state.meshes == 1 else state.tolerance
        return Period(per_mesh // 4, state.orbit.places, state.meshes, thin)

    def _answered(self, own: Sequence[int], push: np.ndarray) -> np.ndarray:
        """Changes of the laws' unknown values (unknowns, harmonics) under reactions."""
        found, orbit = self._found, self._state.orbit
        orders = orbit.response.orders
        along = np.einsum("trh,rh->th", self._reactions.along[:, list(own)], push)
        moved = in_time(along, orders, orbit.places)
        off = np.zeros((found.unknown.size, orbit.places))
        for tangent, unknown in enumerate(found.owner):
            if unknown >= 0:
                off[unknown] += found.bends[:, tangent] * moved[tangent]
        return self._inverse(in_frequency(off, orders))

    def _changed(self, own: Sequence[int], push: np.ndarray, channels: np.ndarray) -> np.ndarray:
        """What outputs change by under reactions and changes of the channels."""
        response = self._state.orbit.response
        by = np.einsum("crh,rh->ch", self._reactions.outputs[:, list(own)], push)
        return by + response.outputs(self._rows, response.coordinates(channels), channels)

    def _of_a_mesh(self) -> Callable[[np.ndarray], np.ndarray]:
        """J^-1 for a period of one mesh."""
        order = self._state.orbit.response.orders.size // 2
        factors = lu_factor(jacobian(self._state.orbit.response, self._found, order))

        def solve(off: np.ndarray) -> np.ndarray:
            found = off.copy()
            packed_off = packed(off[:, : order + 1])
            found[:, : order + 1] = unpacked(lu_solve(factors, packed_off), order)
            return found

        return solve

    def _of_many(self) -> Callable[[np.ndarray], np.ndarray]:
        """J^-1 for a period of many meshes."""
        state, found, orbit = self._state, self._found, self._state.orbit
        problem, answer = state.structure.problem, orbit.response
        per_mesh = orbit.places // state.meshes
        families = Families(answer.orders, state.meshes, per_mesh // 4)
        inverses = families.inverses(problem, answer, found)
        gains = answer.gain(found.along, found.along_angle, found.unknown, answer.orders.size)
        owners = found.owner

        def product(values: np.ndarray) -> np.ndarray:
            moved = in_time(np.einsum("tuh,uh->th", gains, values), answer.orders, orbit.places)
            bends = np.zeros((len(values), orbit.places))
            for tangent, unknown in enumerate(owners):
                if unknown >= 0:
                    bends[unknown] += found.bends[:, tangent] * moved[tangent]
            return values - in_frequency(bends, answer.orders)

        return lambda off: gmres(product, lambda v: families.solve(inverses, v), off, _CLOSE)

    def _apart(self, values: np.ndarray, orders: np.ndarray) -> dict[str, Apart]:
        found = {}
        for question in self._questions:
            theirs = self._lines[question.name]
            own = values[[self._place[name] for name in question.columns]]
            ours = Lines(own, orders, theirs.meshes, theirs.frequency)
            found[question.name] = apart(question, ours, theirs)
        return found


def _rows(structure: Structure, columns: Sequence[str]) -> Rows:
    wanted = structure.wanted(columns)
    if wanted.there.size:
        names = ", ".join(columns[k] for k in wanted.there)
        raise ParameterError(
            f"{names}: a product of others, whose change is not estimated; ask for other outputs"
        )
    return alternating_rows(wanted)
