"""Charts of systems of foreign FMUs: errors against finer runs of the same parts."""

import numpy as np
import pytest

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import ParameterError

CONNECTIONS = [["one.fo", "two.f"], ["two.x", "one.xo"], ["two.v", "one.vo"]]
VALUES = {"one.k": 10.0, "one.ko": 100.0, "one.co": 0.01, "two.k": 1000.0, "one.v0": 1.0}
STEPS = (1e-3, 2e-3, 4e-3, 8e-3)


@pytest.fixture
def oscillator(kinds, tmp_path):
    """The linear oscillator of the co-simulation benchmarks, cut at a force."""
    mass = kinds / "oscillator_mass.fmu"
    lines = ['name = "oscillator"', f"connections = {CONNECTIONS}", "[parts]"]
    lines += [f'{part} = {{ fmu = "{mass}" }}' for part in ("one", "two")]
    (tmp_path / "system.toml").write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


def test_slope_of_held_inputs(oscillator):
    """Fourth order in the step, from 1 to 8 ms."""
    found = hb.chart(oscillator, algorithms=("li:degree=3",), steps=STEPS, t_end=1.0, values=VALUES)
    errors = [point.worst for point in sorted(found.points, key=lambda p: p.step)]
    slope = np.polyfit(np.log(STEPS), np.log(errors), 1)[0]
    assert slope == pytest.approx(4.0, abs=0.1)
    assert any("finer" in note or "runs of the same parts" in note for note in found.notes)


def test_adaptive_steps_are_refused(oscillator):
    with pytest.raises(ParameterError, match="fixed steps only"):
        hb.chart(oscillator, algorithms=("li",), tolerances=(1e-3,), t_end=1.0, steps=STEPS)


def test_bench_of_other_parts(capsys):
    assert main(["bench", "accuracy", "--set", "load_motor.inertia=3"]) == 2
    assert "name it: bench macro-step" in capsys.readouterr().err
