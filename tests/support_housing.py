"""A small housing for tests: exact numbers, all parts of the format."""

from dataclasses import replace

import numpy as np

from herringbone.components.ports import HALVES
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
