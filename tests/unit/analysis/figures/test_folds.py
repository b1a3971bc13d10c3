"""Mesh orders above half the rate of records: where they show, how large, and who tells it."""

import re

import numpy as np
import pytest
from support.result import MESH_FREQUENCY, make_result

from herringbone.analysis.figures.folds import folds, hidden
from herringbone.analysis.figures.misfits.records import of_records
from herringbone.analysis.figures.spectra import PADDING, amplitude_spectrum
from herringbone.plotting import spectra

MESH, RATE, DURATION = 930.0, 20000.0, 0.24
GEAR = "gearbox.gear_mesh"
ZOOM = 0.011
"""A padded spectrum shows a line at most 1 % low."""


def spectrum_of(mesh, orders, duration=DURATION, rate=RATE):
    time = np.arange(round(duration * rate)) / rate
    signal = sum(a * np.cos(2.0 * np.pi * k * mesh * time + k) for k, a in orders.items())
    return amplitude_spectrum(signal[:, None], 1.0 / rate, PADDING)


def with_mesh_orders(step, orders):
    """A result whose mesh forces have more mesh orders, told by amplitude [N]."""
    result = make_result(record_step=step)
    for side in ("left", "right"):
        column = f"{GEAR}.mesh_{side}.force"
        time = result.data["time"].to_numpy()
        for k, amplitude in orders.items():
            result.data[column] += amplitude * np.cos(2.0 * np.pi * k * MESH_FREQUENCY * time)
    return result


def test_orders_show_at_their_distance_from_the_rate():
    """20000 - 21 * 930 = 470 Hz and 23 * 930 - 20000 = 1390 Hz; 22 of 460 Hz has nothing."""
    found = folds(spectrum_of(MESH, {1: 700.0, 2: 300.0, 21: 9.0, 23: 3.0}), MESH, 3000.0)
    assert [fold.frequency for fold in found] == pytest.approx([470.0, 1390.0])
    assert [fold.amplitude for fold in found] == pytest.approx([9.0, 3.0], rel=ZOOM)
    assert [fold.orders for fold in found] == [(21, 22), (20, 23)]


def test_what_is_no_fold():
    """Less than 1e-3 of the largest line, orders that are recorded, and lines beside the places."""
    assert not folds(spectrum_of(MESH, {1: 700.0, 21: 0.6}), MESH, 3000.0)
    assert not folds(spectrum_of(MESH, {1: 700.0, 5: 90.0, 10: 20.0}), MESH, 3000.0)
    assert not folds(spectrum_of(MESH, {1: 700.0, 0.4: 50.0}), MESH, 3000.0)


def test_folds_at_lower_orders_are_hidden():
    """50 mesh periods of 400 Hz are 0.125 s: order 30 shows at order 20, whatever it is."""
    found = spectrum_of(400.0, {1: 700.0, 22: 5.0, 30: 4.0})
    assert not folds(found, 400.0, 3000.0)
    assert hidden(found, 400.0, 3000.0) == pytest.approx(5.0, rel=ZOOM)
    assert hidden(spectrum_of(400.0, {1: 700.0, 22: 0.5}), 400.0, 3000.0) == 0.0
    assert hidden(spectrum_of(400.0, {1: 700.0, 22: 5.0}, 0.03), 400.0, 3000.0) == 0.0
    assert hidden(spectrum_of(MESH, {1: 700.0, 10: 20.0}), MESH, 3000.0) == 0.0


def test_orders_of_shafts_are_no_folds():
    """All of the pinion, of 27 teeth, up to 3 kHz: 20000 - 42 * 495.9 Hz lies at its order 45.1."""
    mesh, turn = 495.9, 495.9 / 27
    of_shaft = {1: 700.0, **{k / 27: 5.0 for k in range(1, 164) if k % 27}}
    seen = spectrum_of(mesh, of_shaft, 0.8)
    assert folds(seen, mesh, 3000.0)
    assert not folds(seen, mesh, 3000.0, (turn,))
    (found,) = folds(spectrum_of(mesh, {1: 700.0, 42: 5.0}, 0.8), mesh, 3000.0, (turn, turn / 3.0))
    assert found.orders == (42,)


def test_nothing_is_hidden_where_nothing_folds():
    """Orders 6 and 7 of 7600 Hz show at 4400 and 3200 Hz."""
    assert hidden(spectrum_of(7600.0, {1: 700.0, 3: 300.0}, rate=50e3), 7600.0, 3000.0) == 0.0


@pytest.mark.parametrize(
    ("step", "order", "at", "finer"), [(5e-5, 39, 2450, 2e-5), (1e-4, 16, 2800, 4e-5)]
)
def test_notes_and_pictures_tell_folded_orders(step, order, at, finer):
    """At 450 Hz: 20000 - 39 * 450 and 10000 - 16 * 450, of any record step."""
    result = with_mesh_orders(step, {order: 200.0})
    (line,) = of_records(result, GEAR)
    told = re.fullmatch(
        f"records every {step:g} s tell frequencies up to {0.5 / step:.0f} Hz: higher mesh "
        f"harmonics of {GEAR} show folded in spectra, the largest is {order} at {at} Hz, (.*) N of "
        f"mesh force; record_step={finer:g} makes that less",
        line.replace("1e+04", "10000"),
    )
    assert told
    assert float(told[1]) == pytest.approx(200.0, rel=ZOOM)
    texts = {t.get_text() for axes in spectra(result).axes for t in axes.texts}
    assert {f"(${order} f_m$)", f"( ): mesh orders above {0.5 / step:.0f} Hz, folded"} <= texts


def test_without_folded_orders_nothing_is_told():
    result = make_result(record_step=5e-5)
    assert not list(of_records(result, GEAR))
    assert not any("folded" in t.get_text() for a in spectra(result).axes for t in a.texts)
