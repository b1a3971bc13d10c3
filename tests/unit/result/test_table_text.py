"""The text of a table reads back bit by bit."""

import io

import numpy as np
import pandas as pd
import pytest

from herringbone.result.tables import write_csv

EDGES = [0.0, -0.0, 5e-324, -2.2250738585072014e-308, 1.7976931348623157e308, 1e16, 1e-7, 0.1 + 0.2]


def _read_back(table: pd.DataFrame) -> np.ndarray:
    stream = io.StringIO()
    write_csv(stream, list(table.columns), [table])
    lines = stream.getvalue().splitlines()
    assert lines[0] == ",".join(table.columns)
    return np.array([[float(text) for text in line.split(",")] for line in lines[1:]])


def test_all_bit_patterns_read_back():
    rng = np.random.default_rng(5)
    drawn = rng.integers(0, 2**64, 40_000, dtype=np.uint64).view(np.float64)
    values = np.concatenate([EDGES, drawn[np.isfinite(drawn)]])
    values = values[: values.size // 4 * 4].reshape(-1, 4)
    found = _read_back(pd.DataFrame(values, columns=list("abcd")))
    assert found.tobytes() == values.tobytes()


@pytest.mark.parametrize("odd", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_reads_back(odd):
    values = np.array([[1.0, odd], [-0.0, 2.5]])
    np.testing.assert_array_equal(_read_back(pd.DataFrame(values, columns=["a", "b"])), values)


def test_no_rows_are_a_header():
    assert _read_back(pd.DataFrame(np.zeros((0, 2)), columns=["a", "b"])).size == 0
