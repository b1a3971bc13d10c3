"""Forward mode against derivatives that are known in closed form."""

import importlib
import math

import numpy as np
import pytest

from herringbone.kernels.compiling.jit import kernel
from herringbone.kernels.derivatives.dual_expressions import NotDifferentiableError
from herringbone.kernels.derivatives.forward_mode import differentiate
from herringbone.kernels.elementary import cosine, exponential, sine

EPS = np.finfo(float).eps
WEIGHTS = (2, 0, 1)
SHIFT = 0.25


@kernel
def _square_and_root(x: float) -> tuple[float, float]:
    return x**2, math.sqrt(x)


@kernel
def _smooth(x: float, y: float) -> float:
    square, root = _square_and_root(x)
    product = sine(square) * cosine(y) / exponential(root)
    product -= y * SHIFT
    return product


@kernel
def _kinked(b: np.ndarray, n: int) -> float:
    total = 0.0
    for i in range(n):
        value = min(b[i], 1.0) if b[i] > 0.0 else abs(b[i])
        total += max(value, 0.5) * b[WEIGHTS[i]]
    count = 0
    while count < 2:
        count += 1
        total *= 0.5
    return total + math.floor(b[0])


@kernel
def _swap(b: np.ndarray, out: np.ndarray) -> None:
    tail = b[1:]
    out[0], out[1] = tail[0], b[0]
    out[0], out[1] = out[1] * out[0], out[0]
    out[2] = out[3] = 3.0


@kernel
def _counted(b: np.ndarray) -> float:
    copy = b.sum()
    return copy


def test_chain_product_and_quotient_rule():
    (smooth,) = differentiate(_smooth)
    x, y = 0.7, 1.3
    value, dx = smooth(x, 1.0, y, 0.0)
    _, dy = smooth(x, 0.0, y, 1.0)
    decay = math.exp(-math.sqrt(x))
    expected = math.cos(y) * decay * (
        2 * x * math.cos(x * x) - 0.5 / math.sqrt(x) * math.sin(x * x)
    )  # fmt: skip
    assert value == _smooth(x, y)
    assert dx == pytest.approx(expected, rel=16 * EPS)
    assert dy == pytest.approx(-math.sin(x * x) * math.sin(y) * decay - SHIFT, rel=16 * EPS)


def test_branches_loops_and_kinks_take_the_side_of_the_value():
    (kinked,) = differentiate(_kinked)
    b = np.array([2.0, -0.75, 0.25])
    jacobian = [kinked(b, row, 3)[1] for row in np.eye(3)]
    # (1 b[2] + |b[1]| b[0] + 0.5 b[1]) / 4, where the first and last value are at their limits
    assert jacobian == [0.25 * 0.75, 0.25 * (0.5 - b[0]), 0.25]
    assert kinked(b, np.zeros(3), 3) == (_kinked(b, 3), 0.0)


def test_arrays_views_and_simultaneous_assignment():
    (swap,) = differentiate(_swap)
    b, out, out_dot = np.array([3.0, 5.0]), np.zeros(4), np.full(4, 9.0)
    swap(b, np.array([1.0, 10.0]), out, out_dot)
    assert out.tolist() == [15.0, 5.0, 3.0, 3.0]
    assert out_dot.tolist() == [3.0 * 10.0 + 5.0 * 1.0, 10.0, 0.0, 0.0]


def test_what_is_not_known_is_refused():
    with pytest.raises(NotDifferentiableError, match=r"_counted: .* does not know 'b.sum'"):
        differentiate(_counted)


def test_files_of_the_same_name_are_told_apart(tmp_path, monkeypatch):
    """As `motion` and `layout` of two components: the later constant and kernel stood for both."""
    monkeypatch.syspath_prepend(tmp_path)
    of_package = (
        "from herringbone.kernels.compiling.jit import kernel\n\nFACTOR = {0}.0\n\n\n"
        "@kernel\ndef scaled(x: float) -> float:\n    return FACTOR * x\n"
    )
    for k, name in enumerate(("first_pair", "second_pair")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text("")
        (tmp_path / name / "layout.py").write_text(of_package.format(k + 2))
    (tmp_path / "both_pairs.py").write_text(
        "from first_pair import layout as a\nfrom first_pair.layout import scaled as one\n"
        "from second_pair import layout as b\nfrom second_pair.layout import scaled as two\n"
        "from herringbone.kernels.compiling.jit import kernel\n\n\n"
        "@kernel\ndef both(x: float) -> float:\n    return one(x) * a.FACTOR + two(x) * b.FACTOR\n"
    )
    (both,) = differentiate(importlib.import_module("both_pairs").both)
    assert both(1.0, 1.0) == (2.0 * 2.0 + 3.0 * 3.0,) * 2
