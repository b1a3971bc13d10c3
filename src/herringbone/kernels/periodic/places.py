"""Where the search for a periodic motion keeps what it works on, and the body that it is of."""

from typing import NamedTuple

from herringbone.kernels.periodic.harmonics import SAMPLES, WINDOW
from herringbone.kernels.periodic.turns import turns_scratch


class Body(NamedTuple):
    """Whose motion is looked for.

    Attributes:
        xs, vs: places of coordinates and of their rates among the states, which come first.
        sizes: usual sizes of the coordinates.
        turning: states that are angles which turn evenly, besides what they do as coordinates.
        free: the coordinate whose mean is free; -1: none.
        states: their number.
    """

    xs: tuple[int, ...]
    vs: tuple[int, ...]
    sizes: tuple[float, ...]
    turning: tuple[int, ...]
    free: int
    states: int

    @classmethod
    def of(
        cls,
        coordinates: tuple[tuple[int, int], ...],
        sizes: tuple[float, ...],
        turning: tuple[int, ...],
        free: int,
        states: int,
    ) -> "Body":
        """A body of coordinates, each with the places of it and of its rate."""
        xs, vs = tuple(x for x, _ in coordinates), tuple(v for _, v in coordinates)
        return cls(xs, vs, sizes, turning, free, states)


class Places(NamedTuple):
    """Places in the block, of so many numbers up to the next one; m: number of coordinates.

    Attributes:
        dx, kept: rates of the states, and the states in which the search begins.
        k, c: stiffness and damping (m, m), averaged over the period.
        re, im: linear equations of a harmonic (m, m).
        motion: displacements, rates and accelerations (3, SAMPLES, m) of the motion so far.
        g: accelerations (WINDOW, m) less those of the motion.
        mean, drift: (m,) of them, see `split`.
        x, y, order, found: (m,) of linear equations.
        table: cosines and sines (2, SAMPLES).
        end: scratch of what returns with the turns of gears.
    """

    dx: int
    kept: int
    k: int
    c: int
    re: int
    im: int
    motion: int
    g: int
    mean: int
    drift: int
    x: int
    y: int
    order: int
    found: int
    table: int
    end: int


def places_from(scratch: int, states: int, coordinates: int) -> Places:
    """Places from a start on."""
    m = coordinates
    sizes = (
        states, states, *4 * (m * m,), 3 * SAMPLES * m, WINDOW * m, *6 * (m,), 2 * SAMPLES,
    )  # fmt: skip
    found = [scratch]
    for size in sizes:
        found.append(found[-1] + size)
    return Places(*found)


def periodic_scratch(states: int, coordinates: int) -> int:
    """Length of the scratch space for so many states and coordinates."""
    return places_from(0, states, coordinates).end + turns_scratch(coordinates)
