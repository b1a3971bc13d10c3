"""Modes that stand twice in a file: taken so, they would halve the stiffness."""

from collections.abc import Sequence

import numpy as np

from herringbone.core import ResourceError

_SAME_FREQUENCY, _SAME_SHAPE = 1e-4, 0.999
"""Relative difference of frequencies, and MAC, within which modes of two sets are the same."""


def check_no_number_twice(numbers: Sequence[int], frequency: Sequence[float]) -> None:
    """Refuse a mode number that comes again: the file has the modes of two analyses.

    Args:
        numbers: (n,) of the modes in the file; those below 1 are no numbers.
        frequency: (n,) [1/time].

    Raises:
        ResourceError: a number stands twice.
    """
    first: dict[int, float] = {}
    for number, value in zip(numbers, frequency, strict=True):
        if number > 0 and number in first:
            raise ResourceError(
                f"mode {number} stands twice, with {first[number]:.6g} and {value:.6g} per unit of "
                "time; two analyses would be added up: keep one step, one load case, and one kind "
                "of data set (55 or 2414)"
            )
        first[number] = value


def check_no_mode_twice(frequency: np.ndarray, shapes: np.ndarray, file: str) -> None:
    """Refuse equal frequencies with equal shapes; modes of a double frequency are independent.

    Args:
        frequency: (n,) [1/time].
        shapes: (k, 3, n); NaN where a mode leaves a node out.
        file: named in the message.

    Raises:
        ResourceError: two modes are the same.
    """
    order = np.argsort(frequency, kind="stable")
    for i, one in enumerate(order):
        highest = frequency[one] * (1.0 + _SAME_FREQUENCY)
        for other in order[i + 1 :]:
            if frequency[other] > highest:
                break
            if _mac(shapes[..., one], shapes[..., other]) > _SAME_SHAPE:
                first, second = sorted((int(one) + 1, int(other) + 1))
                raise ResourceError(
                    f"{file}: modes {first} and {second} are the same, with {frequency[one]:.6g} "
                    "per unit of time, and would count twice; keep one step, or one kind of data "
                    "set (55 or 2414)"
                )


def _mac(one: np.ndarray, other: np.ndarray) -> float:
    """Modal assurance criterion over the nodes that both shapes have; 0 if one is at rest.

    Source: R. J. Allemang, Sound and Vibration 37 (2003) 14-23.
    """
    both = np.isfinite(one) & np.isfinite(other)
    a, b = one[both], other[both]
    size = float(a @ a) * float(b @ b)
    return float(a @ b) ** 2 / size if size > 0.0 else 0.0
