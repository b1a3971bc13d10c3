"""A tolerance where parts refuse steps: the run ends as one with a step that they take does."""

import numpy as np
import pytest
from support.foreign.drivetrain import VALUES, drivetrain, exact

import herringbone as hb

T_END = 0.02


def searched(system, **options):
    values = VALUES | {"motor.from": 1.0, "load.from": 1.0}
    return hb.run(system, values=values, start="rest", t_end=T_END, **options)


def speed_error(result) -> float:
    """Of the motor's speed, over its alternating part; its own torque never comes."""
    told, true = result["motor.w"].to_numpy(), exact(result["time"].to_numpy(), 1.0)[:, 1]
    return float(np.linalg.norm(told - true) / np.linalg.norm(true - true.mean()))


def test_shorter_steps_are_tried_until_parts_take_them(tmp_path):
    """The first two, of T_END/47 and of half of that, are refused; the third is not."""
    system = drivetrain(tmp_path, 2, steps="1.5e-4 0.0")
    result = searched(system, tolerance=1e-3)
    assert result.outcome.completed and not result.outcome.message
    assert result.info.communication_step <= T_END / 47 / 4
    assert result.verification.error <= 1e-3
    assert speed_error(result) <= 2e-3


@pytest.mark.parametrize("options", [{}, {"tolerance": 1e-3}])
def test_usual_steps_are_tried_where_parts_take_one_length_only(tmp_path, options):
    """0.1 ms, which nothing proposes. Second order: 82 Hz, 122 steps in a period."""
    folder = tmp_path / "results"
    result = searched(drivetrain(tmp_path, 2, steps="1e-4 1e-4"), output=folder, **options)
    assert result.outcome.completed
    # Runs with shorter steps fail after it, and their rows stood beside its summary.
    np.testing.assert_array_equal(hb.load(folder).data.to_numpy(), result.data.to_numpy())
    assert result.info.communication_step == pytest.approx(1e-4, rel=1e-6)
    assert speed_error(result) < (2 * np.pi * 82 * 1e-4) ** 2
    assert any("its error is not known: " in note for note in result.info.notes)
    if options:
        assert result.verification.missed
        assert result.outcome.message.startswith("whether tolerance = 0.001 is met is not known: ")
    else:
        assert result.verification is None


INNER = 'fixedInternalStepSize="1.25e-4"'


@pytest.mark.parametrize("steps", ["1.25e-4 1.25e-4", ""])
def test_declared_inner_steps_are_kept_to(tmp_path, steps):
    """Of FMI 3.0: no usual step is this one, which parts of one step length are tried with."""
    system = drivetrain(tmp_path, 3, INNER, steps=steps)
    options = {} if steps else {"step": 2.9e-4, "algorithm": "jacobi"}
    result = searched(system, **options)
    told = [note for note in result.info.notes if "takes inner steps of" in note]
    if steps:
        assert result.outcome.completed and not told
        assert result.info.communication_step == pytest.approx(1.25e-4, rel=1e-6)
        assert speed_error(result) < (2 * np.pi * 82 * 1.25e-4) ** 2
    else:
        assert [note.split()[0] for note in told] == ["motor", "load"]
        assert all("no whole number" in note and "step=0.00025 fits" in note for note in told)


def test_what_fails_with_every_step_ends_as_such(tmp_path):
    """No step is taken, and the message holds the part."""
    result = searched(drivetrain(tmp_path, 2, steps="1e-30 0.0"), tolerance=1e-3)
    assert result.outcome.kind is hb.OutcomeKind.COUPLING_FAILED
    assert "motor fails" in result.outcome.message or "load fails" in result.outcome.message
