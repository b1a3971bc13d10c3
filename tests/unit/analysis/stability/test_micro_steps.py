"""Maps composed of a few micro steps, against all micro steps of classical Runge-Kutta."""

import numpy as np
import pytest
from scipy.interpolate import KroghInterpolator

from herringbone.analysis.stability.steps.micro_steps import Rows, composed

STATES, INPUTS, OUTPUTS = 3, 2, 2
STEP = 0.3
ROUNDING = 1e-13
"""A few hundred additions of numbers of the order of 1."""


def system():
    """dx/dt = a x + b u; outputs c x + d u, of which the first has nodes."""
    random = np.random.default_rng(1)
    shapes = (STATES, STATES), (STATES, INPUTS), (OUTPUTS, STATES), (OUTPUTS, INPUTS)
    return [random.standard_normal(shape) for shape in shapes]


def stepped(x, nodal, degree, count, step):
    """States, outputs of the first at the nodes, and of both at the end, after all micro steps."""
    a, b, c, d = system()
    inputs = KroghInterpolator(np.linspace(0.0, 1.0, degree + 1), nodal.T)
    total, found = max(degree, 1) * count, []
    h = step / total

    for k in range(total):
        early, middle, late = (b @ inputs((k + s) / total) for s in (0.0, 0.5, 1.0))
        k1 = a @ x + early
        k2 = a @ (x + 0.5 * h * k1) + middle
        k3 = a @ (x + 0.5 * h * k2) + middle
        k4 = a @ (x + h * k3) + late
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        if (k + 1) % count == 0:
            found.append(c @ x + d @ inputs((k + 1) / total))
    nodes = [y[0] for y in found] if degree else []
    return np.concatenate([x, nodes, found[-1]])


def matrix(degree, count, step):
    """By columns: unit states, unit values of the inputs at their nodes."""
    columns = []
    for unit in np.eye(STATES + INPUTS * (degree + 1)):
        nodal = unit[STATES:].reshape(INPUTS, degree + 1)
        columns.append(stepped(unit[:STATES], nodal, degree, count, step))
    return np.array(columns).T


@pytest.mark.parametrize("count", [1, 2, 3, 7, 16, 29])
@pytest.mark.parametrize("degree", [0, 1, 2, 3, 4])
def test_composed_map_is_that_of_all_micro_steps(degree, count):
    """Nodes between parts and within them: `count` is a multiple of the degree, or not."""
    nodes = np.arange(STATES, STATES + degree)
    rows = Rows(STATES, nodes.reshape(max(degree, 1), -1), STATES + degree + np.arange(OUTPUTS))
    part = matrix(degree, 1, STEP / count)
    found = composed(part, rows, degree, count)
    assert found == pytest.approx(matrix(degree, count, STEP), rel=0.0, abs=ROUNDING)
