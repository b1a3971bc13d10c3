"""Natural modes: x' = a x with right vectors r_k and left vectors l_k, l_k^H r_k = 1.

    f_k = |lambda_k| / (2 pi),   zeta_k = -Re(lambda_k) / |lambda_k|
    participation of a part p in mode k:  Re sum over states i of p of conj(l_ki) r_ki

The participations of all parts add up to 1, whatever units the states have; of an undamped
mechanical system they are shares of the kinetic energy. The answer of a mode to the mesh is that of
`mesh_answer`; modes with a small one are not heard, wherever a mesh order crosses them.

Source: I. J. Perez-Arriaga, G. C. Verghese, F. C. Schweppe, Selective modal analysis with
applications to electric power systems, IEEE Trans. PAS 101 (1982), for participation.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd
from scipy.linalg import eig, matrix_balance
from scipy.sparse.csgraph import connected_components

from herringbone.analysis.anatomy import anatomy, orders_told, value_at
from herringbone.analysis.modes.critical_speeds import ORDERS, critical_speeds, mesh_crossings
from herringbone.analysis.modes.excitations import Excitations, excitations
from herringbone.analysis.modes.linearised import Linearised, linearised, seen_row
from herringbone.analysis.modes.mesh_answer import mesh_answer, undamped
from herringbone.core import ParameterError
from herringbone.core.declaring.roles import GEARS, Quantity, Role
from herringbone.core.facts import Facts
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.structure.system import System

_SLOWEST = 1e-6
"""Oscillation over the fastest rate below which it is rounding of rigid rotation."""


@dataclass(frozen=True, eq=False, repr=False)
class NaturalModes(Facts):
    """The oscillating modes of a system, slowest first.

    Attributes:
        linear: the system about its equilibrium.
        rates: (n,) eigenvalues, imaginary part positive [1/s].
        shapes: (states, n) right vectors.
        participation: one row per mode, one column per part that has states; rows add up to 1.
        mesh_answer: (n, 2) see there: in phase, in the worst phases; 0 without gear pair, inf
            without damping.
        mesh_weight: (n,) finite, what orders modes by their answer, see there.
        excited: orders of other parts than gear pairs, and the shaft that they are told by.
        others: how many eigenvalues do not oscillate; without those of places that a part keeps
            for more data than it has, as a housing does for modes.
        notes: lines that the user should read.
    """

    linear: Linearised
    rates: np.ndarray
    shapes: np.ndarray
    participation: pd.DataFrame
    mesh_answer: np.ndarray
    mesh_weight: np.ndarray
    excited: Excitations
    others: int
    notes: tuple[str, ...] = ()

    @property
    def system(self) -> System:
        """As it was linearised."""
        return self.linear.core.twin.system

    @property
    def frequency_hz(self) -> np.ndarray:
        """(n,) |lambda| / (2 pi) [Hz]."""
        return np.abs(self.rates) / (2.0 * math.pi)

    @property
    def damping_ratio(self) -> np.ndarray:
        """(n,) [1]; 0 where it is rounding."""
        return np.where(undamped(self.rates), 0.0, -self.rates.real / np.abs(self.rates))

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row per mode.

        "mode" from 1, "frequency" [Hz], "damping_ratio", "mesh_answer", "mesh_answer_any_phase",
        and "share.PART" of each part.
        """
        first = pd.DataFrame({
            "mode": np.arange(1, self.rates.size + 1),
            "frequency": self.frequency_hz,
            "damping_ratio": self.damping_ratio,
            "mesh_answer": self.mesh_answer[:, 0],
            "mesh_answer_any_phase": self.mesh_answer[:, 1],
        })  # fmt: skip
        return pd.concat([first, self.participation.add_prefix("share.")], axis=1)

    def motion(self, column: str) -> np.ndarray:
        """(n,) complex motion of an output in each mode, in the scale of `shapes`.

        Raises:
            ParameterError: there is no such output.
        """
        row = seen_row(self.linear, column)
        if row is None:
            raise ParameterError(f"system '{self.system.name}' has no output {column}")
        return row @ self.shapes

    def largest(self, count: int, highest: float) -> list[int]:
        """Modes up to a frequency [Hz] with the largest answers in phase, slowest first.

        Without a gear pair the first ones.
        """
        below = np.flatnonzero(self.frequency_hz <= highest)
        order = np.argsort(-self.mesh_weight[below], kind="stable")[:count]
        return sorted(int(k) for k in below[order])

    def crossings(self, orders: Sequence[int], highest_speed: float) -> pd.DataFrame:
        """Pinion speeds at which mesh orders, of the first gear pair, meet natural frequencies.

        Args:
            orders: of the mesh.
            highest_speed: [r/min].

        Returns:
            "speed" [r/min], "order", "mode" from 1, "frequency" [Hz], "mesh_answer"; the largest
            answers first, see `mesh_weight`. Empty without a gear pair.
        """
        return mesh_crossings(self, orders, highest_speed)

    def critical_speeds(
        self, highest_speed: float, highest: float, orders: Sequence[int] = ORDERS
    ) -> pd.DataFrame:
        """Speeds of the reference shaft at which orders of parts and of the mesh meet modes.

        That shaft and its present speed are those of `excited`; frequencies are those at the
        present speed.

        Args:
            highest_speed: [r/min].
            highest: frequency up to which modes count [Hz].
            orders: of the mesh.

        Returns:
            "excitation" for people, "part", "order" in periods per turn of the part's own shaft (of
            a gear pair its pinion), "mode" from 1, "frequency" [Hz], "speed" and "from_present",
            that less the present one [r/min], "answer" of the mode to the part, over that of the
            mode that answers most; nearest to the present speed first.
        """
        return critical_speeds(self, highest_speed, highest, orders)

    @property
    def teeth(self) -> float | None:
        """Of the first pinion; None without a gear pair that tells them."""
        known = anatomy(self.system)
        for pair in known.with_role(Role.GEAR_PAIR):
            column = known.column(pair, Quantity.NUMBER_OF_TEETH, GEARS[0])
            if column is not None:
                return value_at(self.system, column)
        return None

    @property
    def teeth_of_reference(self) -> float | None:
        """`teeth`, but None where speeds are those of another shaft than the pinion's."""
        return self.teeth if self.excited.reference in {"", GEARS[0]} else None

    def _facts(self) -> dict[str, str]:
        found = self.frequency_hz
        between = f", {found.min():.4g} to {found.max():.4g} Hz" if found.size else ""
        return {
            "system": self.system.name,
            "modes": f"{found.size}{between}",
            "not oscillating": str(self.others),
            "parts": ", ".join(self.participation.columns),
            "notes": "; ".join(self.notes),
        }


def oscillating(rates: np.ndarray) -> np.ndarray:
    """Which eigenvalues (n,) are those of oscillations, one of each pair, and not rounding."""
    return rates.imag > _SLOWEST * np.abs(rates).max(initial=0.0)


def natural_modes(system: System, notes: Sequence[str] = ()) -> NaturalModes:
    """Modes of a system about its start values.

    Args:
        system: its parts are all components of this package; its start values are an equilibrium.
        notes: lines on how it was prepared.

    Raises:
        StructureError: it cannot be taken apart.
    """
    found = linearised(system)
    with one_blas_thread():
        balanced, (scale, _) = matrix_balance(found.a, permute=False, separate=True)
        rates, left, right = eig(balanced, left=True, right=True)
    kept = np.flatnonzero(oscillating(rates))
    kept = kept[np.argsort(np.abs(rates[kept]), kind="stable")]
    rates, others = rates[kept], int(rates.size - 2 * kept.size) - _unused(found.a)
    left, right = left[:, kept] / scale[:, None], right[:, kept] * scale[:, None]
    left = left / np.conj((left.conj() * right).sum(axis=0))
    shares = (left.conj() * right).real
    twin = found.core.twin
    firsts = twin.layout.state_first
    participation = pd.DataFrame({
        str(instance.name): shares[firsts[p] : firsts[p + 1]].sum(axis=0)
        for p, instance in enumerate(twin.instances)
        if firsts[p + 1] > firsts[p]
    })  # fmt: skip
    heard = mesh_answer(found, rates, left, right)
    excited = excitations(found, rates, left, right)
    orders = orders_told(system)
    first = (
        (f"{orders}, over the speed of its pinion; other pairs have their own",) if orders else ()
    )
    told = (*notes, *found.notes, *heard.notes, *excited.notes, *first)
    return NaturalModes(
        found, rates, right, participation, heard.answer, heard.weight, excited, others, told
    )


def _unused(a: np.ndarray) -> int:
    """States joined to no other, that nothing moves: a position and its rate."""
    count, label = connected_components(a != 0.0, directed=False)
    groups = (np.flatnonzero(label == k) for k in range(count))
    blocks = (a[np.ix_(own, own)] for own in groups)
    return sum(len(block) for block in blocks if not (block @ block).any())
