"""A component's equations taken apart in its block: a linear rest, as matrices, and laws.

Matrices are taken from its kernels at unit vectors, as `analysis.twin.condensed.equations` does.
"""

from collections.abc import Callable

import numpy as np

from herringbone.kernels.compiling.jit import outside
from herringbone.kernels.condensed.in_block.form import Equations, Form
from herringbone.kernels.condensed.in_block.places import WorkPlaces, taken_places


def apart_taker(  # noqa: PLR0915 (kernels that share their layout)
    form: Form, at: WorkPlaces, equations: Equations
) -> Callable[[np.ndarray, np.ndarray], bool]:
    """Compile apart(b, w) -> bool: writes the matrices, and which states move; False if it is none.

    Args:
        form: of the component.
        at: places in the work space.
        equations: of the component.
    """
    owner, turning, given = equations.owner, equations.turning, equations.given
    n, channels, arguments = form.states, form.channels, form.arguments
    stiff, unknowns, tangent = np.array(form.stiff), len(form.stiff), form.tangent.ravel()
    of = taken_places(form, at.rungs)

    @outside(owner)
    def answer(b: np.ndarray, w: np.ndarray) -> float:
        """Rates and arguments at the states and channels; returns the size of the arguments."""
        z, size = w[at.z : at.z + arguments], 0.0
        given(b, w[at.x : at.x + n], w[at.u :], w[of.rates : of.rates + n], z)
        for k in range(arguments):
            size += abs(z[k])
        return size

    @outside(owner)
    def take_apart(b: np.ndarray, w: np.ndarray) -> bool:
        """Write matrices of the rest; False if it is none that the core can take."""
        dx, still = w[of.rates : of.rates + n], w[of.rates + n : of.rates + 2 * n]
        for i in range(n):
            w[at.x + i] = 0.0
        for c in range(channels):
            w[at.u + c] = 0.0
        not_linear = answer(b, w)
        for i in range(n):
            still[i] = dx[i]
            w[of.of_inputs + i * channels + channels - 1] = dx[i]
        for c in range(channels - 1):
            w[at.u + c] = 1.0
            not_linear += answer(b, w)
            w[at.u + c] = 0.0
            for i in range(n):
                w[of.of_inputs + i * channels + c] = dx[i] - still[i]
        for c in range(channels):
            not_linear += abs(w[of.of_inputs + turning * channels + c])
        for j in range(n):
            w[at.x + j] = 1.0
            answer(b, w)
            w[at.x + j] = 0.0
            for i in range(n):
                w[of.whole + i * n + j] = dx[i] - still[i]
            for k in range(arguments):
                w[of.of_states + k * n + j] = w[at.z + k]
        for i in range(n):
            not_linear += abs(w[of.whole + i * n + turning])
        return not_linear == 0.0

    @outside(owner)
    def add_tangents(w: np.ndarray) -> None:
        """Add what the laws do by their mean tangents."""
        for s in range(unknowns):
            for k in range(arguments):
                mean = tangent[s * arguments + k]
                if mean != 0.0:
                    for i in range(n):
                        by = mean * w[of.of_inputs + i * channels + int(stiff[s])]
                        for j in range(n):
                            w[of.whole + i * n + j] += by * w[of.of_states + k * n + j]

    @outside(owner)
    def find_moving(w: np.ndarray) -> None:
        """Find the states that can change: others give them a rate, or inputs do."""
        can, again = w[of.rates : of.rates + n], True
        for i in range(n):
            can[i] = 1.0
        while again:
            again = False
            for i in range(n):
                size = 0.0
                for c in range(channels):
                    size += abs(w[of.of_inputs + i * channels + c])
                for j in range(n):
                    size += can[j] * abs(w[of.whole + i * n + j])
                if can[i] != 0.0 and size == 0.0:
                    can[i], again = 0.0, True

    @outside(owner)
    def moving(w: np.ndarray) -> bool:
        """List the states that move; False if one that never does is felt by others."""
        can, count, felt = w[of.rates : of.rates + n], 0, 0.0
        find_moving(w)
        for i in range(n):
            if can[i] != 0.0 and i != turning:
                w[at.states + count] = i
                count += 1
        w[at.inside] = count
        for j in range(n):
            if can[j] == 0.0:
                for k in range(arguments):
                    felt += abs(w[of.of_states + k * n + j])
                for i in range(count):
                    felt += abs(w[of.whole + int(w[at.states + i]) * n + j])
        return felt == 0.0

    @outside(owner)
    def apart(b: np.ndarray, w: np.ndarray) -> bool:
        if not take_apart(b, w):
            return False
        add_tangents(w)
        return moving(w)

    return apart
