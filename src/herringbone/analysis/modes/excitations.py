"""Orders with which parts excite a system by their shafts' angles, such as engines and propellers.

Laws that repeat with an angle tell them, of all parts but gear pairs, whose orders are those of the
mesh. How much a mode answers to a part is the speed of its shaft over its torque at the resonance,

    |lambda_k| |c r_k| |l_k^H b| / |Re(lambda_k)|

c the row of the angle, b the column of the torque; over that of the mode that answers most.
"""

from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.modes.linearised import Linearised
from herringbone.analysis.modes.mesh_answer import undamped
from herringbone.analysis.twin.condensed.equations import periodic_arguments
from herringbone.core.declaring.roles import GEARS, Role
from herringbone.core.declaring.units import R_MIN

_OTHER = 1e-9
"""Turn of a shaft that is not that of the reference, over its own, above which it slips."""


class Excitation(NamedTuple):
    """An order of a part.

    Attributes:
        part: its name.
        order: periods per turn of its own shaft.
        ratio: turns of its shaft over those of the reference shaft.
        answer: (n,) of the modes, the largest is 1; 0 if nothing answers.
    """

    part: str
    order: float
    ratio: float
    answer: np.ndarray

    @property
    def label(self) -> str:
        """Part and order."""
        return f"{self.part} {self.order:.4g}"

    @property
    def slope(self) -> float:
        """Its frequency over the speed of the reference shaft [Hz min]."""
        return self.order * self.ratio / 60.0


class Excitations(NamedTuple):
    """Orders of a system's parts, and the shaft whose speed they are told by.

    Attributes:
        reference: "pinion", or the first part with orders where there is no gear pair; "" if
            nothing depends on an angle.
        speed: of the reference shaft at the start values [r/min].
        orders: of the parts, in their order.
        apart: parts whose shafts turn independently of the reference: at no speed of it are
            theirs known.
    """

    reference: str
    speed: float
    orders: tuple[Excitation, ...]
    apart: tuple[str, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """A line on parts whose orders are left out."""
        if not self.apart:
            return ()
        return (
            f"{', '.join(self.apart)}: orders without critical speeds, as nothing joins the "
            f"shaft's angle to that of the {self.reference}",
        )


def excitations(
    found: Linearised, rates: np.ndarray, left: np.ndarray, right: np.ndarray
) -> Excitations:
    """Orders of a system's parts.

    Args:
        found: the system.
        rates: (n,) eigenvalues.
        left, right: (states, n) their vectors, l_k^H r_k = 1.
    """
    twin, condensed = found.core.twin, found.core.condensed
    equations, turning = condensed.equations, condensed.modes.of_angles
    pairs = anatomy(twin.system).with_role(Role.GEAR_PAIR)
    known = [(str(twin.instances[p].name), p, at, turns)
             for p, at, turns in periodic_arguments(twin, equations)]  # fmt: skip
    known = [one for one in known if turning[one[2]].any()]
    if not known:
        return Excitations("", 0.0, (), ())
    name, _, first, _ = next((one for one in known if one[0] in pairs), known[0])
    speed = R_MIN * abs(float(equations.c[first] @ equations.a @ twin.state))
    values = dict(_values(found))
    orders: dict[tuple[str, Fraction], Excitation] = {}
    apart: dict[str, None] = {}
    for part, p, at, turns in known:
        if part in pairs:
            continue
        ratio = _ratio(turning[at], turning[first])
        if ratio is None:
            apart[part] = None
            continue
        answer = _answer(rates, equations.c[at] @ right, left.conj().T @ equations.b[:, values[p]])
        orders[part, turns] = Excitation(part, float(1 / turns), ratio, answer)
    reference = GEARS[0] if name in pairs else name
    return Excitations(reference, speed, tuple(orders.values()), tuple(apart))


def _values(found: Linearised) -> Iterator[tuple[int, slice]]:
    """Numbers of the parts with laws, and of their values among the channels."""
    condensed = found.core.condensed
    ends = condensed.calls().value.tolist()
    for p, first, end in zip(condensed.equations.laws, ends, ends[1:], strict=False):
        yield p, slice(int(first), int(end))


def _ratio(own: np.ndarray, reference: np.ndarray) -> float | None:
    """Turns (rotations,) of a shaft over those of another; None if it turns independently."""
    ratio = float(own @ reference / (reference @ reference))
    slips = np.abs(own - ratio * reference).max() > _OTHER * np.abs(own).max()
    return None if slips else abs(ratio)


def _answer(rates: np.ndarray, moved: np.ndarray, excited: np.ndarray) -> np.ndarray:
    """(n,) over the largest; if a mode is undamped, of all as with one damping ratio.

    Args:
        rates: (n,) eigenvalues.
        moved: (n,) angle of the shaft.
        excited: (n, values) by the part's torques.
    """
    product = np.abs(moved) * np.abs(excited).max(axis=1, initial=0.0)
    none = undamped(rates)
    answer = product if none.any() else product * np.abs(rates) / np.abs(rates.real)
    largest = answer.max(initial=0.0)
    return answer / largest if largest > 0.0 else answer
