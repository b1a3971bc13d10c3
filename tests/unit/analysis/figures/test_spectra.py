"""Spectra: amplitude, frequency and mean of known signals; mesh orders."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.result import MESH_FREQUENCY, SPEED, TORQUE, make_foreign_result, make_result

from herringbone.analysis.figures.channels import largest_lines, moments
from herringbone.analysis.figures.operating_point import (
    power_balance,
    run_mesh_frequency,
    steady_part,
)
from herringbone.analysis.figures.order_tracking import frequency_map
from herringbone.analysis.figures.spectra import (
    amplitude_spectrum,
    mesh_frequency,
    mesh_orders,
    spectral_lines,
)
from herringbone.core import ParameterError

STEP = 20e-6
TIME = np.arange(8000) * STEP


def test_amplitude_of_a_sine_in_the_middle_of_a_bin():
    frequency = 72 / (TIME.size * STEP)
    spectrum = amplitude_spectrum(5.0 + 3.0 * np.sin(2.0 * math.pi * frequency * TIME), STEP)
    peak = int(spectrum.amplitude.argmax())
    assert spectrum.frequency[peak] == pytest.approx(frequency, rel=1e-12)
    assert spectrum.amplitude[peak] == pytest.approx(3.0, rel=1e-10)
    assert spectrum.mean == pytest.approx(5.0, rel=1e-10)
    assert spectrum.amplitude[0] == 0.0


@pytest.mark.parametrize("offset", [0.0, 0.1, 0.25, 0.5, 0.77])
def test_lines_are_exact_between_bins(offset):
    frequency = (72 + offset) / (TIME.size * STEP)
    signal = -7.0 + 3.0 * np.sin(2.0 * math.pi * frequency * TIME + 0.4)
    (line,) = spectral_lines(signal, STEP, 3000.0, count=1)
    assert line.amplitude == pytest.approx(3.0, rel=1e-3)
    assert line.frequency == pytest.approx(frequency, rel=1e-5)


def test_padding_draws_peaks_at_most_one_percent_low():
    frequency = 72.5 / (TIME.size * STEP)
    signal = np.sin(2.0 * math.pi * frequency * TIME)
    assert amplitude_spectrum(signal, STEP).amplitude.max() < 0.87
    assert 0.99 < amplitude_spectrum(signal, STEP, padding=4).amplitude.max() < 1.001


def test_line_at_half_the_rate():
    """It has no mirror image, so that it is not counted twice."""
    time = np.arange(2000) / 1800.0
    wave = np.cos(2.0 * np.pi * 900.0 * time)
    assert amplitude_spectrum(wave, 1.0 / 1800.0).amplitude.max() == pytest.approx(1.0)
    assert frequency_map(time, np.ones(2000), wave, 0.5).amplitude.max() == pytest.approx(1.0)


def test_mean_does_not_leak_into_the_spectrum():
    assert amplitude_spectrum(np.full(501, 1e6), STEP).amplitude.max() < 1e-8


def test_columns_are_independent_signals():
    signals = np.column_stack([np.sin(900.0 * TIME), 4.0 + np.cos(4000.0 * TIME)])
    both = amplitude_spectrum(signals, STEP)
    for i in range(2):
        one = amplitude_spectrum(signals[:, i], STEP)
        assert both.amplitude[:, i] == pytest.approx(one.amplitude, abs=1e-12)
        assert both.mean[i] == pytest.approx(one.mean)


def test_lines_stay_below_the_highest_frequency():
    signal = np.sin(2.0 * math.pi * 500.0 * TIME) + 9.0 * np.sin(2.0 * math.pi * 5000.0 * TIME)
    lines = spectral_lines(signal, STEP, 3000.0)
    assert lines[0].frequency == pytest.approx(500.0, rel=1e-5)
    assert lines[0].amplitude == pytest.approx(1.0, rel=1e-3)


def test_bad_input_is_refused():
    with pytest.raises(ParameterError, match="3 samples"):
        amplitude_spectrum(np.zeros(3), STEP)
    with pytest.raises(ParameterError, match="sample_step"):
        amplitude_spectrum(np.zeros(100), 0.0)


@pytest.mark.parametrize(("speed", "expected"), [(800, 360), (1000, 450), (1200, 540), (1500, 675)])
def test_mesh_frequency_of_27_teeth(speed, expected):
    assert mesh_frequency(speed * math.pi / 30.0, 27) == pytest.approx(expected)
    assert mesh_frequency(-speed * math.pi / 30.0, 27) == pytest.approx(expected)


def test_mesh_orders():
    orders = mesh_orders(450.0, 1400.0)
    assert [(o.order, o.frequency) for o in orders] == [(1, 450.0), (2, 900.0), (3, 1350.0)]
    assert mesh_orders(0.0, 3000.0) == ()


def test_mesh_frequency_of_a_run_uses_its_number_of_teeth():
    assert run_mesh_frequency(make_result()) == pytest.approx(MESH_FREQUENCY, rel=1e-5)
    other = make_result(parameters={"gearbox.gear_mesh.pinion.number_of_teeth": 30.0})
    assert run_mesh_frequency(other) == pytest.approx(500.0, rel=1e-5)
    assert run_mesh_frequency(other, 54) == pytest.approx(900.0, rel=1e-5)
    assert run_mesh_frequency(make_foreign_result()) is None


def test_steady_part_leaves_out_the_first_fifth_and_the_run_up():
    result = make_result()
    part = steady_part(result)
    assert part.steady
    assert part.begin == pytest.approx(0.04)
    speed = SPEED * np.minimum(1.0, result.data["time"].to_numpy() / 0.15)
    result.data["gearbox.gear_mesh.pinion.w"] = speed
    part = steady_part(result)
    assert part.steady
    assert part.begin == pytest.approx(0.15 * 0.99, abs=1e-4)
    result.data["gearbox.gear_mesh.pinion.w"] = SPEED * result.data["time"].to_numpy()
    assert not steady_part(result).steady
    assert run_mesh_frequency(result) is None


def test_a_second_load_is_not_left_out():
    """One drive and one load balance; with another load powers are told by part."""
    result = make_result()
    known = result.info.anatomy
    parts = {**known.parts, "second_load": known.parts["load_motor"]}
    info = replace(result.info, anatomy=replace(known, parts=parts))
    assert power_balance(replace(result, info=info)) is None


def test_power_balance_closes():
    power = power_balance(make_result())
    losses = power.drive_loss + power.transmission_loss + power.load_loss
    assert power.supplied == pytest.approx(losses, rel=1e-12)
    assert power.circulating == pytest.approx(TORQUE * SPEED, rel=1e-3)
    assert power.transmission_loss == pytest.approx(70.0, abs=5.0)
    assert power_balance(make_result("gearbox")) is None


def test_moments_and_largest_lines_of_a_group():
    result = make_result()
    found = moments(result, "gearbox.bearing_supports.shaft.pinion_left.f_y")
    assert found.mean == pytest.approx(1988.0, abs=0.1)
    assert found.ac_rms == pytest.approx(math.sqrt(0.5 * (12.0**2 + 4.8**2 + 1.0)), rel=0.01)
    lines = largest_lines(result, result.channel("bearing_force"), 3000.0)
    assert [round(line.frequency) for line in lines[:2]] == [450, 900]
    assert lines[0].amplitude == pytest.approx(12.0, rel=1e-3)


@pytest.mark.parametrize("speed", [0.0, 1e-14, 0.5])
def test_a_gear_at_rest_has_no_mesh_orders(speed):
    """Less than one mesh period in the record; the orders of 1e-14 rad/s would be endless."""
    result = make_result("gearbox", t_end=0.1)
    result.data["gear_mesh.pinion.w"] = speed
    assert run_mesh_frequency(result) is None
