"""Equivalent radiated power: closed forms of one oscillator, interference, what it refuses."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.result import make_result

from herringbone.analysis.figures.modal_response import (
    housing_of,
    modal_velocity,
    moving_start,
    seat_forces,
)
from herringbone.analysis.figures.radiated_power import AIR_DENSITY, SPEED_OF_SOUND, radiated_power
from herringbone.core import Outcome, OutcomeKind, ParameterError
from herringbone.core.places.paths import component_folder
from herringbone.housing import SEAT_DOFS, ModalHousing, Point, default_housing, write_housing

STEP = 1e-5
SEATS = tuple(Point(seat, "seat", (0.0, 0.0, 0.0)) for seat, axis in SEAT_DOFS if axis == "x")
AT = SEAT_DOFS.index(("pinion_left", "y"))
SHAPE = 0.2
GRAM = 0.03


def oscillators(frequency_hz, damping_ratio, gram) -> ModalHousing:
    """All of them move pinion_left along y, as much."""
    count = len(frequency_hz)
    shapes = np.zeros((12, count))
    shapes[AT] = SHAPE
    return ModalHousing(
        kind=tuple("normal" if f else "rigid" for f in frequency_hz),
        frequency_hz=np.array(frequency_hz),
        damping_ratio=np.array(damping_ratio),
        points=SEATS,
        shapes=shapes,
        valid_to_hz=2000.0,
        damping={},
        gram=np.array(gram),
    )


def result_under(force):
    """A run of 0.5 s in which one force acts on the housing."""
    result = make_result(t_end=0.5, record_step=STEP)
    data = result.data.copy()
    for seat, axis in SEAT_DOFS:
        data[f"gearbox.bearing_supports.seat.{seat}.f_{axis}"] = 0.0
    data["gearbox.bearing_supports.seat.pinion_left.f_y"] = force(data["time"].to_numpy())
    return replace(result, data=data)


@pytest.mark.parametrize("begin", [3, 4096, 30_000])
def test_the_end_of_a_long_run_moves_as_the_whole(begin):
    """1 % of 100 Hz rings for 0.16 s, which 20 % of the end, left out, do not cover.

    Splines end anew at each piece of 4096 records.
    """
    housing = oscillators([100.0, 700.0], [0.01, 0.02], GRAM * np.eye(2))
    whole = result_under(lambda t: 20.0 * np.sin(2 * np.pi * 650.0 * t) + 5.0 * np.sin(1800.0 * t))
    data = whole.data
    end = replace(
        whole, data=data[begin:].reset_index(drop=True), before=data[:begin].reset_index(drop=True)
    )
    true = modal_velocity(housing, seat_forces(whole), STEP)[begin:]
    found = modal_velocity(housing, seat_forces(end), STEP, moving_start(end, housing))
    np.testing.assert_allclose(found, true, atol=1e-6 * np.abs(true).max())


@pytest.mark.parametrize("frequency", [100.0, 500.0, 1450.0])
def test_one_oscillator_under_a_sine(frequency):
    """P = rho c S |v|**2 / 2 with v of the harmonic response; all of it at its frequency."""
    own, zeta, amplitude = 500.0, 0.1, 30.0
    w, w0 = 2 * math.pi * frequency, 2 * math.pi * own
    velocity = w * SHAPE * amplitude / abs(w0**2 - w**2 + 2j * zeta * w0 * w)
    expected = AIR_DENSITY * SPEED_OF_SOUND * GRAM * velocity**2 / 2
    result = result_under(lambda t: amplitude * np.sin(w * t))
    found = radiated_power(result, oscillators([own], [zeta], [[GRAM]]))
    # Straight lines between records take (w h)**2 / 6 off the power: 1.4e-3 at 1450 Hz.
    assert found.total == pytest.approx(expected, rel=1.5e-3)
    near = np.abs(found.frequency_hz - frequency) < 2 * found.resolution_hz
    assert found.power[near].sum() == pytest.approx(found.total, rel=1e-3)
    assert found.level_db == pytest.approx(10 * math.log10(expected / 1e-12), abs=0.01)
    assert found.frequency_hz[-1] <= 2000.0


def test_surfaces_that_cancel():
    """Two equal oscillators, whose surfaces move against each other: none or four times."""
    result = result_under(lambda t: np.sin(2 * math.pi * 400 * t))
    power = [
        radiated_power(result, oscillators([500.0] * 2, [0.1] * 2, GRAM * np.array(gram))).total
        for gram in ([[1, -1], [-1, 1]], [[1, 0], [0, 1]], [[1, 1], [1, 1]])
    ]
    assert power[0] < 1e-12 * power[1]
    assert power[2] == pytest.approx(2 * power[1], rel=1e-12)


def test_exact_for_straight_lines():
    """F = a + b t from rest: v = b / w**2 (1 - exp(-z w t) (cos + z / sqrt(1 - z**2) sin))."""
    housing = oscillators([700.0, 0.0], [0.03, 0.0], GRAM * np.eye(2))
    time = np.arange(200) * 1e-4  # 13 records a period
    forces = np.zeros((time.size, 12))
    forces[:, AT] = 5.0 + 3.0 * time
    found = modal_velocity(housing, forces, 1e-4)
    w, zeta = 2 * math.pi * 700.0, 0.03
    root = math.sqrt(1 - zeta**2)
    swing = np.cos(w * root * time) + zeta / root * np.sin(w * root * time)
    ramp = SHAPE * 3.0 / w**2 * (1 - np.exp(-zeta * w * time) * swing)
    np.testing.assert_allclose(found[:, 0], ramp, atol=1e-12 * ramp.max())
    # The rigid one has no rest position: it starts at once.
    rigid = SHAPE * (5.0 * time + 3.0 * time**2 / 2)
    np.testing.assert_allclose(found[:, 1], rigid, atol=1e-12 * rigid.max())


@pytest.mark.parametrize("step", [1e-6, 1e-4, 1e-3])
def test_exact_for_cubics(step):
    """A hundred times as many rows change nothing, and of a mass v is the force's integral.

    h w is 0.004, 0.4 and 4: below and above where the phi functions are series.
    """
    housing = oscillators([700.0, 0.0], [0.03, 0.0], GRAM * np.eye(2))

    def seen(count, h):
        time = np.arange(count) * h
        forces = np.zeros((count, 12))
        forces[:, AT] = np.polyval([2.0, -3.0, 1.0, 0.5], time / (20 * step))
        return modal_velocity(housing, forces, h)

    coarse, fine = seen(21, step), seen(2001, step / 100)[::100]
    for k in range(2):
        scale = np.abs(fine[:, k]).max()
        np.testing.assert_allclose(coarse[:, k], fine[:, k], atol=1e-11 * scale)
    integral = np.polyval([0.5, -1.0, 0.5, 0.5, 0.0], np.arange(21) / 20)
    mass = SHAPE * 20 * step * integral
    np.testing.assert_allclose(coarse[:, 1], mass, atol=1e-12 * abs(mass).max())


def test_constant_forces_are_silent():
    found = radiated_power(result_under(lambda t: 2e3 + 0 * t), default_housing())
    assert found.level_db < -100.0


def test_data_of_a_run(tmp_path):
    result = make_result()
    np.testing.assert_array_equal(housing_of(result).gram, default_housing().gram)
    write_housing(oscillators([500.0], [0.1], [[GRAM]]), tmp_path)
    names = "modes", "shapes"
    own = {f"gearbox.modal_housing.{name}": str(tmp_path / f"{name}.csv") for name in names}
    info = replace(result.info, resources=own)
    assert housing_of(replace(result, info=info)).frequency_hz == [500.0]
    thesis = {f"gearbox.modal_housing.{name}": f"thesis_{name}.csv" for name in ("modes", "shapes")}
    assert housing_of(replace(result, info=replace(result.info, resources=thesis))) is None
    assert (component_folder("modal_housing") / "resources" / "thesis_modes.csv").is_file()
    assert housing_of(replace(result, info=replace(result.info, resources={}))) is None


def test_refused():
    result = make_result()
    with pytest.raises(ParameterError, match="no Gram matrix of the surface"):
        radiated_power(result, replace(default_housing(), gram=None))
    column = "gearbox.bearing_supports.seat.wheel_left.f_x"
    with pytest.raises(ParameterError, match=f"records no {column}"):
        seat_forces(replace(result, data=result.data.drop(columns=column)))
    diverged = replace(result, outcome=Outcome(OutcomeKind.DIVERGED, 0.1))
    with pytest.raises(ParameterError, match="diverged"):
        radiated_power(diverged)
    with pytest.raises(ParameterError, match="too short"):
        radiated_power(replace(result, data=result.data.iloc[:6]))
