"""Golden results are written where they have changed, and not where a processor rounds apart."""

import numpy as np
import pytest

from herringbone.components.registry import component
from herringbone.fmi import golden

NAME = "shaft_coupling"
ROWS = np.random.default_rng(7).normal(size=(5, len(golden.columns(component(NAME))))) * 1e3


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Function: text of the golden result after rows were found, beside what is there."""
    file = tmp_path / "golden.csv"
    monkeypatch.setattr(golden, "golden_file", lambda found: file)
    monkeypatch.setattr(golden, "build_python_fmus", dict.fromkeys)

    def write(rows):
        monkeypatch.setattr(golden, "golden_run", lambda found, fmu: rows)
        golden.write_golden([NAME])
        return file.read_text(encoding="utf-8")

    return write


def test_what_rounds_apart_stays(written):
    """13 digits are written: numbers below a tenth of their column's largest have more to lose."""
    before = written(ROWS)
    assert before.startswith("time,")
    assert written(ROWS + 1e-13 * np.abs(ROWS).max(axis=0)) == before


@pytest.mark.parametrize("changed", [ROWS * (1.0 + 1e-11), ROWS[:-1], ROWS[:, :-1]])
def test_what_has_changed_is_written(written, changed):
    before = written(ROWS)
    assert written(changed) != before
