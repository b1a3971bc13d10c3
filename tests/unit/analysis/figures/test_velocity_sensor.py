"""Sensor chain: filters, aliasing, clipping and digits against closed forms."""

import numpy as np
import pytest

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.core import ParameterError

STEP = 2e-5
BARE = {"high_pass_hz": 0.0, "bits": 0}


def sine(frequency: float, amplitude: float = 1e-3, duration: float = 1.0) -> np.ndarray:
    return amplitude * np.sin(2 * np.pi * frequency * STEP * np.arange(round(duration / STEP)))


def amplitude_at(velocity: np.ndarray, frequency: float) -> float:
    """Of a whole number of periods, at 2 kHz."""
    t = np.arange(len(velocity)) / 2000.0
    return 2 * abs(np.mean(velocity * np.exp(-2j * np.pi * frequency * t)))


@pytest.mark.parametrize(("line", "seen"), [(675, 675), (1350, 650), (2025, 25), (1800, 200)])
def test_lines_fold(line, seen):
    """27 teeth at 1500 r/min: the second harmonic, 1350 Hz, shows at 650 Hz, the third at 25 Hz."""
    sensor = VelocitySensor(**BARE)
    record = sensor.measure(sine(line), STEP)
    assert sensor.alias_hz(line) == seen
    assert amplitude_at(record.velocity, seen) == pytest.approx(1e-3, rel=1e-9)
    np.testing.assert_allclose(record.time, np.arange(2000) * 5e-4, rtol=1e-12)


def test_anti_alias_filter():
    """Butterworth of order 8 at 800 Hz: 1 / sqrt(1 + (tan / tan) ** 16), after its transient."""
    record = VelocitySensor(anti_alias=True, **BARE).measure(sine(1350, duration=2.0), STEP)
    ratio = np.tan(np.pi * 1350 * STEP) / np.tan(np.pi * 800 * STEP)
    expected = 1e-3 / np.sqrt(1 + ratio**16)
    assert amplitude_at(record.velocity[2000:], 650) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("options", "frequency", "corner", "power"),
    [({"high_pass_hz": 10.0}, 5, 10, -4), ({"low_pass_hz": 400.0}, 900, 400, 4)],
)
def test_band_limits(options, frequency, corner, power):
    record = VelocitySensor(**(BARE | options)).measure(sine(frequency, duration=3.0), STEP)
    ratio = np.tan(np.pi * frequency * STEP) / np.tan(np.pi * corner * STEP)
    expected = 1e-3 / np.sqrt(1 + ratio**power)
    assert amplitude_at(record.velocity[4000:], frequency) == pytest.approx(expected, rel=1e-5)


def test_clipping_counts():
    """A sine of twice the range is beyond it for two thirds of the time."""
    record = VelocitySensor(**BARE).measure(sine(13.0, amplitude=0.1, duration=2.0), STEP)
    assert np.abs(record.velocity).max() == 0.05
    assert record.saturated == pytest.approx(4000 * 2 / 3, abs=60)  # 52 crossings of either limit


def test_digits():
    """16 bits over +-50 mm/s: steps of 1.53 um/s, rms error of a twelfth of its square."""
    exact = VelocitySensor(**BARE).measure(sine(77.7), STEP)
    record = VelocitySensor(high_pass_hz=0.0).measure(sine(77.7), STEP)
    digit = 0.1 / 2**16
    np.testing.assert_allclose(
        record.velocity / digit, np.round(record.velocity / digit), atol=1e-9
    )
    error = record.velocity - exact.velocity
    assert np.abs(error).max() <= digit / 2 * (1 + 1e-9)
    assert error.std() == pytest.approx(digit / np.sqrt(12), rel=0.1)
    top = VelocitySensor(high_pass_hz=0.0).measure(np.full(100, 0.2), STEP)
    assert top.velocity[0] == pytest.approx(0.05 - digit)


def test_columns():
    both = np.column_stack([sine(50.0), sine(50.0, amplitude=0.2)])
    record = VelocitySensor().measure(both, STEP)
    alone = VelocitySensor().measure(both[:, 1], STEP)
    np.testing.assert_array_equal(record.velocity[:, 1], alone.velocity)
    assert record.saturated.tolist() == [0, alone.saturated]


@pytest.mark.parametrize(
    ("options", "step", "expected"),
    [
        ({}, 2e-4, "records every 0.0002 s are too coarse for the sensor; it takes 0.0001 s"),
        ({"low_pass_hz": 5e3}, 5e-5, "too coarse for the sensor; it takes 2e-05 s"),
        ({}, 3e-5, "do not fit samples every 0.0005 s"),
        ({}, 0.0, "step = 0 s must be positive"),
        ({"range": 0.0}, STEP, "range = 0 m/s must be positive"),
        ({"bits": 40}, STEP, "bits = 40: it must lie between 0 and 32"),
        ({"high_pass_hz": 5e3}, 5e-5, "too coarse for the sensor; it takes 2e-05 s"),
        ({"high_pass_hz": np.inf}, STEP, "high_pass_hz = inf Hz must not be negative or infinite"),
        ({"high_pass_hz": -1.0}, STEP, "high_pass_hz = -1 Hz must not be negative"),
    ],
)
def test_bad_input(options, step, expected):
    with pytest.raises(ParameterError, match=expected):
        VelocitySensor(**options).measure(sine(50.0), step)
