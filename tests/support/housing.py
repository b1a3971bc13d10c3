"""A small housing for tests: exact numbers, all parts of the format."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from herringbone.components.ports import HALVES
from herringbone.components.resources import modal_data
from herringbone.components.resources.loader import REPORT, read_numbers
from herringbone.housing import Frame, ModalHousing, Point

WHEEL_X, HALF_WIDTH = 0.2182, 0.107


def seat_points() -> tuple[Point, ...]:
    return tuple(
        Point(
            name,
            "seat",
            (WHEEL_X * name.startswith("wheel"), 0.0, HALF_WIDTH * (1 if "left" in name else -1)),
            area=0.01,
        )
        for name in HALVES
    )


def small_housing(modes: int = 20, seed: int = 3, **changes) -> ModalHousing:
    """Random shapes at the four seats and one sensor; the last two modes are residual."""
    random = np.random.default_rng(seed)
    points = (*seat_points(), Point("A", "sensor", (0.0, 0.06, 0.14), ("z",), "node"))
    housing = ModalHousing(
        kind=("normal",) * (modes - 2) + ("residual",) * 2,
        frequency_hz=np.sort(random.uniform(200.0, 4000.0, modes)),
        damping_ratio=random.uniform(0.005, 0.05, modes),
        points=points,
        shapes=0.1 * random.standard_normal((13, modes)),
        valid_to_hz=2000.0,
        damping={"model": "viscous-modal", "source": "assumed"},
        boundary="base fixed",
        source={"tool": "test", "mesh": {"size_mm": 30}},
        frame=Frame((0.1, 0.0, -0.2), ((0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))),
        certificate={"next_frequency_hz": 4100.0},
    )
    root = random.standard_normal((12, 12))
    gram = random.standard_normal((modes, modes))
    housing = replace(
        housing,
        static=housing.static_compliance(),
        residual=1e-12 * root @ root.T,
        gram=gram @ gram.T,
    )
    return replace(housing, **changes)


def read_modes(
    modes: Path, shapes: Path, dofs: modal_data.Dofs, most: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Modes and shapes as the component reads them, with its refusals.

    Args:
        modes, shapes: the files.
        dofs: (point, dof) pairs that are needed.
        most: largest number of modes.

    Returns:
        frequency_hz (n,), damping_ratio (n,), shapes (len(dofs), n).

    Raises:
        ResourceError: see `read_numbers` and `collect`.
    """
    first, first_shape = read_numbers(modes, modal_data.MODE_COLUMNS)
    second, second_shape = read_numbers(shapes, modal_data.shape_columns(dofs))
    shape = np.array([*first_shape, *second_shape])
    out, report = np.zeros(1 + most * (2 + len(dofs))), np.zeros(REPORT)
    values = np.concatenate([first, second])
    refusal = modal_data.collect(values, shape, modal_data.wanted_rows(dofs), most, out, 0, report)
    if refusal:
        raise modal_data.refusals(dofs, most)[refusal - 1].error([modes, shapes], report)
    n = int(out[0])
    frequency_hz, damping_ratio = out[1 : 1 + n], out[1 + most : 1 + most + n]
    return frequency_hz, damping_ratio, out[1 + 2 * most :].reshape(len(dofs), most)[:, :n]


PROTOTYPE_HOUSING = {
    f"modal_housing.{name}": str(Path(__file__).parents[1] / "data" / "prototype_housing" / file)
    for name, file in (("modes", "modes.csv"), ("shapes", "shapes.csv"))
}
"""Housing of the dense prototypes whose figures some tests reproduce: 52 oscillators."""
