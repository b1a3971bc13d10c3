"""Import of a small structure, its receptance by hand, and what a refusal says."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from herringbone.components.ports import HALVES
from herringbone.core import HerringboneError
from herringbone.housing.importers import import_housing
from support.files.fe_files import NODES

BAND = 500.0


def load(files, seats, **options):
    given = {"band_hz": BAND, "tolerance": 1e-12, "most_modes": 64} | options
    return import_housing(files if isinstance(files, list) else [files], seats, **given)


def refusal(action) -> str:
    with pytest.raises(HerringboneError) as caught:
        action()
    assert "\n" not in str(caught.value)
    return str(caught.value)


def seat_input(model):
    """(36, 12) by hand: gearbox x is y of the file, gearbox y is -x."""
    weights = {"pinion_left": {0: 0.25, 1: 0.5, 2: 0.25}}
    for n, name in enumerate(HALVES[1:], 1):
        weights[name] = dict.fromkeys(range(3 * n, 3 * n + 3), 1 / 3)
    found = np.zeros((3 * NODES, 12))
    for (n, name), axis in product(enumerate(HALVES), range(3)):
        of_file, sign = ((1, 1.0), (0, -1.0), (2, 1.0))[axis]
        for node, weight in weights[name].items():
            found[3 * node + of_file, 3 * n + axis] = sign * weight
    return found


def exact_receptance(model, frequency_hz):
    """Undamped, in m/N, by a solve in the file's units (mm, t, N)."""
    stiffness, mass, _ = model
    b = seat_input(model)
    return 1e-3 * b.T @ np.linalg.solve(stiffness - (2 * np.pi * frequency_hz) ** 2 * mass, b)


def assert_same_receptance(housing, model, rtol):
    undamped = replace(housing, damping_ratio=0.0 * housing.damping_ratio)
    for f in (0.0, 150.0, 460.0):
        expected = exact_receptance(model, f)
        found = undamped.receptance(np.array([f]))[0].real
        np.testing.assert_allclose(found, expected, atol=rtol * np.abs(expected).max())
