"""What a leaner model would change of a motion, without solving for that of the leaner model.

Two linear solves with the Jacobian J of the balance at the motion of the whole model, whatever is
left out:

    F_lean(r) = what the laws give and the motion lacks, with the leaner linear part
    r_lean = r - J^-1 F_lean(r), twice,    y_lean = H_lean r_lean

All of the linear part, reactions included, is exact; the laws are followed along their slopes, and
evaluated once where these lead to: a contact that opens there says so, and low lines of a table
without its high ones, which are of second order.
"""

from collections.abc import Sequence

import numpy as np

from herringbone.analysis.leaner.inverse import bent_by, of_a_mesh, of_many
from herringbone.analysis.leaner.question import Apart, Lines, Question, apart, lines_of
from herringbone.analysis.leaner.reactions import Reactions
from herringbone.analysis.steady.harmonic_balance.balance import Balance
from herringbone.analysis.steady.harmonic_balance.correction import (
    Bent,
    bent,
    sloped,
)
from herringbone.analysis.steady.harmonic_balance.fourier import among, in_frequency, in_time, on
from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.analysis.steady.harmonic_balance.response import Rows
from herringbone.analysis.steady.outputs import coefficients_of, of_rows
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.steady.structure import Structure, alternating_rows
from herringbone.analysis.twin.condensed.recorded.wanted import Wanted
from herringbone.core import ParameterError
from herringbone.core.process.one_thread import one_blas_thread

_STEPS = 2
"""Of Newton, from the motion of the whole model: the second one has what is of second order."""


class Estimates:
    """Errors of leaner models at a motion of the whole one.

    Args:
        state: that motion.
        questions: what is asked of it.
        names: states that may be held.

    Raises:
        ParameterError: inputs of an output's part are not affine.
    """

    def __init__(
        self, state: SteadyState, questions: Sequence[Question], names: Sequence[str]
    ) -> None:
        self._state, self._questions = state, questions
        columns = dict.fromkeys(c for q in questions for c in q.columns)
        self._place = {name: k for k, name in enumerate(columns)}
        self._wanted = _wanted(state.structure, tuple(columns))
        self._rows = alternating_rows(self._wanted)
        orbit = state.orbit
        with one_blas_thread(), np.errstate(all="ignore"):
            self._lines = {question.name: lines_of(state, question) for question in questions}
            problem = state.structure.problem
            one = state.meshes == 1
            self._found: Bent = (
                sloped(problem, orbit.samples, every=True) if one else bent(problem, orbit.samples)
            )
            self._inverse = of_a_mesh(state, self._found) if one else of_many(state, self._found)
            self._reactions = Reactions(state, names, self._found, self._rows)
            self._still = np.zeros_like(orbit.channels)
            self._moving = self._reactions.moving(orbit.channels)
            self._moving[:, 0] -= self._reactions.start
            self._unmoved = self._reactions.moving(self._still)
            self._given = Rows(problem.arguments, problem.of_angle, problem.of_channels)
            self._given_still, self._rows_still = (
                self._of(rows, self._still) for rows in (self._given, self._rows)
            )
            self._were = self._laws()
            self._whole = coefficients_of(self._wanted, orbit)

    def _laws(self) -> np.ndarray:
        """The laws' values less mean tangents (values, harmonics) at the whole model's motion."""
        orbit, problem = self._state.orbit, self._state.structure.problem
        given = problem.laws(orbit.samples.z).f - orbit.samples.z @ problem.tangent.T
        return in_frequency(np.ascontiguousarray(given.T), orbit.response.orders)

    def held(self, names: Sequence[str]) -> dict[str, Apart]:
        """Errors by question if these states are held."""
        places = self._reactions.places
        own = [places[name] for name in names if name in places]
        with one_blas_thread(), np.errstate(all="ignore"):
            holding = self._reactions.holding(own)
            push = holding(self._moving)
            step = self._answered(own, push)
            channels = self._still.copy()
            channels[self._found.unknown] = step
            push = push + holding(self._reactions.moving(channels) - self._unmoved)
            bent = self._still.copy()
            bent[self._found.unknown] = self._inverse(self._lacking(own, push, channels))
            push = push + holding(self._reactions.moving(bent) - self._unmoved)
            changed = self._changed(own, push, channels + bent)
            return self._apart(self._whole + changed)

    def _lacking(self, own: Sequence[int], push: np.ndarray, channels: np.ndarray) -> np.ndarray:
        """What the laws give at the changed motion, beyond their slopes (unknowns, harmonics)."""
        orbit, problem = self._state.orbit, self._state.structure.problem
        response, unknown = orbit.response, self._found.unknown
        change = _added(self._reactions.arguments[:, list(own)], push)
        change += self._of(self._given, channels) - self._given_still
        z = orbit.samples.z + in_time(change, response.orders, orbit.places).T
        given = problem.laws(np.ascontiguousarray(z)).f - z @ problem.tangent.T
        laws = in_frequency(np.ascontiguousarray(given[:, unknown].T), response.orders)
        return laws - self._were[unknown] - channels[unknown]

    def influences(self, names: Sequence[str]) -> dict[str, float]:
        """What each state changes if it is held alone, for a ranking; those that can move.

        It is the worst error over its tolerance. Of periods of many meshes, whose laws take long,
        it is the relative change of what the outputs are made of, without the laws' answer.
        """
        places = self._reactions.places
        own = [name for name in names if name in places]
        with one_blas_thread(), np.errstate(all="ignore"):
            every = self._reactions.alone(self._moving)
            if self._state.meshes > 1:
                return {name: self._row_change(places[name], every) for name in own}
            return {name: self._alone(places[name], every[[places[name]]]) for name in own}

    def _alone(self, place: int, push: np.ndarray) -> float:
        channels = self._still.copy()
        channels[self._found.unknown] = self._answered([place], push)
        found = self._apart(self._whole + self._changed([place], push, channels))
        return max(found[q.name].error / q.tolerance for q in self._questions)

    def _row_change(self, place: int, every: np.ndarray) -> float:
        changed = np.linalg.norm(self._reactions.outputs[:, place, 1:] * every[place, 1:], axis=1)
        sizes = np.linalg.norm(self._whole[:, 1:], axis=1)
        return float(np.linalg.norm(changed[sizes > 0.0] / sizes[sizes > 0.0]))

    def of(self, structure: Structure) -> dict[str, Apart]:
        """Errors by question of a leaner model of the same states and tangents."""
        state, orbit = self._state, self._state.orbit
        with one_blas_thread(), np.errstate(all="ignore"):
            balance = Balance(structure.problem, orbit.resolved, state.motion)
            for _ in range(_STEPS):
                orbit = self._stepped(balance, orbit)
            response, given = orbit.response, orbit.channels
            wanted = _wanted(structure, tuple(self._place))
            q, rows = response.coordinates(given), alternating_rows(wanted)
            values = response.outputs(rows, q, given)
            values[:, 0] += wanted.rows.still
            return self._apart(values, wanted, orbit)

    def _stepped(self, balance: Balance, orbit: Orbit) -> Orbit:
        """Channels after a step of Newton, with the Jacobian of the whole model."""
        response, step, _ = balance.missing(orbit, every=True)
        orders, known = response.orders, self._state.orbit.response.orders
        there, unknown = among(orders, known), self._found.unknown
        solved = on(orders, self._inverse(on(known, step[unknown], orders)), known)
        step[np.ix_(unknown, there)] = solved[:, there]  # lines that are new are as they come
        channels = on(orders, orbit.channels, orbit.response.orders) + step
        return orbit._replace(channels=channels, response=response)

    def _answered(self, own: Sequence[int], push: np.ndarray) -> np.ndarray:
        """Changes of the laws' unknown values (unknowns, harmonics) under reactions."""
        found, orbit = self._found, self._state.orbit
        orders = orbit.response.orders
        along = _added(self._reactions.along[:, list(own)], push)
        moved = in_time(along, orders, orbit.places)
        return self._inverse(in_frequency(bent_by(found, moved), orders))

    def _changed(self, own: Sequence[int], push: np.ndarray, channels: np.ndarray) -> np.ndarray:
        """What outputs change by under reactions and changes of the channels."""
        by = _added(self._reactions.outputs[:, list(own)], push)
        return by + self._of(self._rows, channels) - self._rows_still

    def _of(self, rows: Rows, channels: np.ndarray) -> np.ndarray:
        """Rows (n, harmonics) under channels; a rotation that nothing drives has its speed."""
        response = self._state.orbit.response
        return response.outputs(rows, response.coordinates(channels), channels)

    def _apart(
        self, rows: np.ndarray, wanted: Wanted | None = None, orbit: Orbit | None = None
    ) -> dict[str, Apart]:
        """Errors by question of coefficients (rows, harmonics of an orbit) of all affine rows."""
        state, orbit = self._state, orbit or self._state.orbit
        own = of_rows(state.structure, orbit, wanted or self._wanted, rows).coefficients
        found = {}
        for question in self._questions:
            theirs = self._lines[question.name]
            values = own[[self._place[name] for name in question.columns]]
            orders = orbit.response.orders
            made = question.lines(values, orders, theirs.frequency)
            ours = Lines(made, orders, theirs.meshes, theirs.frequency)
            found[question.name] = apart(question, ours, theirs)
        return found


def _added(gains: np.ndarray, push: np.ndarray) -> np.ndarray:
    """Sums (n, harmonics) over reactions (reactions, harmonics) of gains (n, the same)."""
    return np.einsum("crh,rh->ch", gains, push)


def _wanted(structure: Structure, columns: Sequence[str]) -> Wanted:
    wanted = structure.wanted(columns)
    if wanted.whole:
        names = ", ".join(columns[k] for k in wanted.there)
        raise ParameterError(
            f"{names}: made of what is no linear part, so that its change is not estimated; ask "
            "for other outputs"
        )
    return wanted
