"""Directional derivatives of every component against central differences of its kernels."""

import numpy as np
import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Component, Instance

EPS = np.finfo(float).eps
TIME = 0.1


def _operating_point(component: Component) -> np.ndarray:
    """A block at a point where all equations act and none has a kink."""
    instance = Instance(component, component.name)
    instance.initialise()
    block, d = instance.block, component.declaration
    random = np.random.default_rng(1)
    count = d.state_count
    block[:count] = random.standard_normal(count)
    for v in d.inputs:
        block[d.index[v.name]] = random.standard_normal()
    if component.name == "gear_mesh":
        block[: count // 2] *= 1e-7
        block[count // 2 : count] *= 1e-3
        there = {"approach": 4e-6, "der(angle)": 100, "symmetry_deviation": 1e-5, "impact_force": 9}
        for name, value in there.items():
            block[d.index[name]] = value
    return block


def _evaluated(component: Component, block: np.ndarray) -> np.ndarray:
    """Outputs, then derivatives of the states."""
    d, b = component.declaration, block.copy()
    dx = np.zeros(d.state_count)
    component.kernels.out(b, TIME)
    component.kernels.rhs(b, TIME, dx)
    return np.concatenate([b[[d.index[v.name] for v in d.outputs]], dx])


def _differences(component: Component, block: np.ndarray, entry: int, h: float) -> np.ndarray:
    ahead, behind = block.copy(), block.copy()
    ahead[entry] += h
    behind[entry] -= h
    return (_evaluated(component, ahead) - _evaluated(component, behind)) / (2.0 * h)


@pytest.mark.parametrize("name", COMPONENTS)
def test_tangents_agree_with_differences(name):
    component = COMPONENTS[name]
    d, block = component.declaration, _operating_point(component)
    tangent, count = tangent_kernel(component), d.state_count
    outputs = [d.index[v.name] for v in d.outputs]
    size = np.abs(_evaluated(component, block)) + 1e-9
    for entry in [*range(count), *(d.index[v.name] for v in d.inputs)]:
        is_position = name == "gear_mesh" and entry < count // 2
        h = 1e-9 if is_position else 1e-4
        seed, dx, b = np.zeros(d.size), np.zeros(2 * count), block.copy()
        seed[entry] = 1.0
        tangent(b, TIME, seed, dx)
        exact = np.concatenate([seed[outputs], dx[count:]])
        difference = _differences(component, block, entry, h)
        # Rounding of two evaluations (terms may be 1e4 times their sum), and Richardson's estimate.
        rounding = 1e4 * EPS * size / h
        truncation = np.abs(_differences(component, block, entry, 2.0 * h) - difference)
        assert np.all(np.abs(exact - difference) <= rounding + truncation), d.variables[0].name


@pytest.mark.parametrize("name", COMPONENTS)
def test_tangents_also_give_outputs_and_derivatives(name):
    component = COMPONENTS[name]
    d, block = component.declaration, _operating_point(component)
    expected = _evaluated(component, block)
    dx = np.zeros(2 * d.state_count)
    tangent_kernel(component)(block, TIME, np.zeros(d.size), dx)
    assert np.array_equal(block[[d.index[v.name] for v in d.outputs]], expected[: len(d.outputs)])
    assert np.array_equal(dx[: d.state_count], expected[len(d.outputs) :])


def test_indicators_change_sign_at_contact():
    gear = COMPONENTS["gear_mesh"]
    d, block = gear.declaration, _operating_point(gear)
    block[: d.state_count] = 0.0
    block[d.index["symmetry_deviation"]] = 0.0
    backlash, cos_b = block[d.index["backlash"]], np.cos(block[d.index["base_helix_angle"]])
    z = np.zeros(gear.indicator_count)
    for approach, signs in (
        (1e-9, (1, 1)),
        (-1e-9, (-1, 1)),
        (-1.001 * backlash / cos_b, (-1, -1)),
    ):
        block[d.index["approach"]] = approach
        gear.indicators(block, TIME, z)
        assert np.sign(z).tolist() == [*signs, *signs]
