"""A tolerance with foreign parts: the whole run errs at most twice of it, and not too little.

The oscillator's solution is exact, see `support.foreign.oscillator`. The error of the search is
estimated by runs with longer steps, with the power 2 at the most; higher powers make the run finer
than asked for.
"""

import pytest
from support.foreign.oscillator import JOINED, Oscillator
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.commands import main as cli

TOLERANCES = (1e-2, 1e-4, 1e-6)


@pytest.mark.parametrize("plain", [False, True], ids=["restores", "plain"])
@pytest.mark.parametrize("cut", JOINED)
def test_error_over_tolerance(kinds, cut, plain):
    """And the step becomes no shorter as the tolerance loosens."""
    oscillator = Oscillator(kinds, cut, 0.01, plain=plain)
    steps = []
    for tolerance in TOLERANCES:
        result = hb.run(
            oscillator.system, tolerance=tolerance, record_step=1e-2, t_end=10.0, start="rest",
            values=oscillator.values,
        )  # fmt: skip
        share = max(oscillator.group_errors(result).values()) / tolerance
        assert 5e-4 < share < 2.0
        assert result.verification.error <= tolerance
        steps.append(result.info.communication_step)
    assert steps == sorted(steps, reverse=True)


def test_foreign_parts_alone_get_a_step_that_suits_them(kinds):
    """1.6 to 5.5 Hz: nothing is asked for, so 1e-3; not the step of a gearbox."""
    oscillator = Oscillator(kinds, "force and motion", 0.01)
    result = hb.run(oscillator.system, t_end=10.0, start="rest", values=oscillator.values)
    assert result.info.communication_step > 5e-4
    assert max(oscillator.group_errors(result).values()) < 2e-3
    assert any(note.startswith("tolerance = 0.001: steps of") for note in result.info.notes)
    assert not result.verification.missed


@pytest.mark.usefixtures("without_pictures")
def test_what_is_noise_ends_the_search(kinds, tmp_path, capsys):
    """The sensor's noise does not fall with the step; the best run is kept, and says so."""
    system = write_system(
        tmp_path,
        "noisy",
        [["rotor.flange.w", "sensor.w_true"], ["sensor.w_sensed", "vehicle.gearbox.w"],
         ["rotor.flange.phi", "vehicle.gearbox.phi"], ["vehicle.gearbox.tau", "rotor.flange.tau"]],
        {"sensor": kinds / "WheelSpeedSensor.fmu", "vehicle": kinds / "RoadVehicle.fmu",
         "rotor": kinds / "FixedStepRotor.fmu"},
    )  # fmt: skip
    result = hb.run(system, tolerance=1e-6, t_end=0.02, start="rest")
    assert result.outcome.completed
    (note,) = (note for note in result.info.notes if note.startswith("tolerance = 1e-06"))
    assert "not met: " in note
    assert result.outcome.message.startswith("tolerance = 1e-06 is not met: error ")
    assert result.verification.error > 1e-6
    assert result.verification.missed
    given = ["--tolerance", "1e-6", "--t-end", "0.02", "--start", "rest"]
    assert cli.main(["run", str(system), *given, "-o", str(tmp_path / "o")]) == 1
    assert "tolerance = 1e-06 is not met: error" in capsys.readouterr().err
