"""A prediction beside a record: each planted fault is named with its number, and no other."""

import hashlib
import subprocess
import tracemalloc

import numpy as np
import pytest

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.measured.beside import beside
from herringbone.analysis.measured.lines import line_amplitudes, told_speed
from herringbone.analysis.measured.predicted import Predicted
from herringbone.analysis.measured.record import MeasuredRecord
from herringbone.core import ParameterError

RATE, STEP, MESH, MESHES = 2000.0, 1e-4, 450.0, 81
LENGTH = 2.4
NOISE = 0.05
_SENSOR = VelocitySensor(high_pass_hz=0.0, bits=0)


def vibration(time, speed=1.0, seed=0):
    """Lines at all orders of the wheel, large near mesh harmonics, through fixed resonances."""
    random = np.random.default_rng(seed)
    orders = np.arange(1, 5 * MESHES)
    near = np.abs(orders / MESHES - np.rint(orders / MESHES))
    sizes = 1e-3 * np.exp(-8.0 * near) * random.uniform(0.2, 1.0, orders.size)
    phases = random.uniform(0.0, 2.0 * np.pi, orders.size)
    frequencies = orders * MESH / MESHES * speed
    resonance = sum(
        1.0 / np.hypot(1.0 - (frequencies / f) ** 2, 0.1) for f in (170.0, 430.0, 1300.0)
    )
    return np.cos(2.0 * np.pi * np.outer(time, frequencies) + phases) @ (sizes * resonance)


def drawn():
    """A seed, from the last commit."""
    head = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, check=False).stdout
    return int(hashlib.sha256(head).hexdigest()[:8], 16)


@pytest.fixture(scope="module")
def predicted():
    return Predicted(vibration(np.arange(0.0, LENGTH, STEP)), STEP, _SENSOR, MESH, MESHES)


def record(shift=0.0, gain=1.0, speed=1.0, seed=0, noise=NOISE, length=1.2):
    """A record that begins `shift` after the prediction's samples."""
    time = 0.2 + shift + np.arange(0.0, length, 1.0 / RATE)
    clean = gain * vibration(time, speed, seed)
    rubbish = noise * clean.std() * np.random.default_rng(7).standard_normal(clean.size)
    return MeasuredRecord(clean + rubbish, RATE, "A", "record.csv")


def test_the_same_vibration_has_no_fault(predicted):
    found = beside(record(), predicted)
    assert found.faults == ()
    assert found.speed == pytest.approx(1.0, abs=2e-4)
    assert found.gain == pytest.approx(1.0, abs=0.02)
    assert found.likeness > 0.99
    strong = found.lines.head(10)
    assert strong["coherence"].min() > 0.95
    assert strong["ratio"].to_numpy() == pytest.approx(1.0, abs=0.05)


def test_a_time_shift_is_named(predicted):
    found = beside(record(shift=0.0374), predicted)
    assert [f.partition(":")[0] for f in found.faults] == ["time shift"]
    assert found.shift == pytest.approx(0.0374, abs=1.0 / RATE)
    assert "37.4" in found.faults[0]


def test_a_gain_is_named(predicted):
    found = beside(record(gain=2.0), predicted)
    assert [f.partition(":")[0] for f in found.faults] == ["gain"]
    assert found.gain == pytest.approx(2.0, rel=0.02)


@pytest.mark.parametrize("speed", [0.8, 0.995, 1.03, 1.2, 1.5])
def test_another_speed_is_named_and_hides_the_rest(predicted, speed):
    found = beside(record(speed=speed, gain=2.0), predicted)
    assert [f.partition(":")[0] for f in found.faults] == ["other speed"]
    assert found.speed == pytest.approx(speed, rel=1e-3)
    assert np.isnan(found.gain)


def test_faults_that_were_not_chosen_are_named(predicted):
    """Drawn from the last commit: shift, gain and speed."""
    random = np.random.default_rng(drawn())
    for _ in range(4):
        shift, gain = random.uniform(0.002, 0.178), random.uniform(1.3, 4.0)
        found = beside(record(shift=shift, gain=gain), predicted)
        assert found.shift == pytest.approx(shift, abs=1.0 / RATE), (shift, gain)
        assert found.gain == pytest.approx(gain, rel=0.03), (shift, gain)
        speed = random.choice([-1.0, 1.0]) * random.uniform(0.01, 0.4) + 1.0
        assert beside(record(speed=speed), predicted).speed == pytest.approx(speed, rel=1e-3), speed


@pytest.mark.parametrize("speed", [0.7298, 77.0 / 78.0, 78.0 / 77.0])
def test_side_bands_are_not_taken_for_their_neighbours(predicted, speed):
    """At one in 77 beside these speeds most lines lie on other ones, and some are larger there."""
    assert beside(record(speed=speed), predicted).speed == pytest.approx(speed, rel=1e-3)


def test_speeds_of_other_vibrations_under_noise_are_told(predicted):
    """Drawn from the last commit."""
    random = np.random.default_rng(drawn())
    for _ in range(6):
        speed, noise = random.uniform(0.6, 1.4), random.choice([0.05, 0.2, 0.5])
        shift, seed = random.uniform(0.002, 0.178), int(random.integers(100))
        found = beside(record(shift, 1.0, speed, seed, noise), predicted).speed
        assert found == pytest.approx(speed, rel=1e-3), (speed, noise, shift, seed)


def test_another_vibration_is_no_gain(predicted):
    found = beside(record(seed=3), predicted)
    assert found.likeness < 0.9
    assert not any("gain" in fault for fault in found.faults)


def test_noise_is_not_coherent_and_has_no_speed(predicted):
    noise = np.random.default_rng(1).standard_normal(2400)
    found = beside(MeasuredRecord(noise, RATE, "A", "noise.csv"), predicted)
    assert [fault.partition(":")[0] for fault in found.faults] == ["no lines"]
    assert np.isnan(found.speed)
    assert found.lines["coherence"].mean() < 0.4  # one over six periods is expected


def test_what_cannot_be_compared_is_refused(predicted):
    short = record(length=0.3)
    with pytest.raises(ParameterError, match=r"lasts 0.3 s; it takes 3 periods of 0.18 s"):
        beside(short, predicted)
    with pytest.raises(ParameterError, match="is sampled at 5000 Hz and the prediction at 2000 Hz"):
        beside(short._replace(sampling_hz=5000.0), predicted)


def test_coherence_follows_periods_that_are_no_whole_samples():
    """At 447.3 Hz the wheel turns in 362.17 samples; pieces begin within half a sample of it."""
    ratio = 447.3 / MESH
    fine = vibration(np.arange(0.0, LENGTH, STEP), ratio)
    found = beside(record(speed=ratio, noise=0.0), Predicted(fine, STEP, _SENSOR, 447.3, MESHES))
    assert found.faults == ()
    assert found.lines.head(10)["coherence"].min() > 0.98


ORDERS, SIZES = np.array([81, 162, 243, 324, 405]), 1e-5 * np.array([3.0, 2.8, 7.6, 2.5, 1.5])


def few_lines(time, orders=ORDERS, sizes=SIZES):
    """Mesh harmonics alone, or other orders."""
    phases = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, orders.size)
    return np.sin(2.0 * np.pi * MESH / MESHES * np.outer(time, orders) + phases) @ sizes


def of_few_lines(**kwargs):
    fine = np.arange(0.0, 2.0, 1.0 / (25 * RATE))
    sensor = VelocitySensor(high_pass_hz=0.0, low_pass_hz=0.0, bits=0)
    return Predicted(few_lines(fine, **kwargs), fine[1], sensor, MESH, MESHES)


TIMES = 0.2 + np.arange(3400) / RATE
FOLDED = {"orders": np.array([162, 243, 117]), "sizes": 1e-5 * np.array([3.0, 7.6, 3.0])}


@pytest.mark.parametrize("shift", [0.0, 0.9e-3, 4.13e-3, 13.7e-3])
def test_lines_that_fold_onto_each_other_are_the_same_after_a_shift(shift):
    """At 360 times the turn's frequency, 243 and 117 share a place and turn opposite ways."""
    velocity = few_lines(TIMES + shift, **FOLDED)
    found = beside(MeasuredRecord(velocity, RATE, "A", "r.csv"), of_few_lines(**FOLDED))
    assert [one.partition(":")[0] for one in found.faults] == ["time shift"] * (shift > 0.0)
    assert min(found.shift, 0.02 - found.shift) == pytest.approx(min(shift, 0.02 - shift), abs=1e-6)
    assert found.gain == pytest.approx(1.0, abs=1e-3)
    assert found.lines["ratio"].to_numpy() == pytest.approx(1.0, abs=1e-3)
    alone = found.lines.set_index("order")["alone"]
    assert alone[243] == pytest.approx(7.6 / 10.6, rel=1e-3)
    assert alone[162] == pytest.approx(1.0)


def test_many_lines_that_fold_are_the_same_after_a_shift():
    """Sizes drawn: an order has a partner of its size. No sensor, no noise."""
    orders = np.arange(1, 406)
    sizes = np.random.default_rng(5).rayleigh(6e-6, 405)
    sizes[orders % 81 == 0] = SIZES
    kwargs = {"orders": orders, "sizes": sizes}
    velocity = few_lines(TIMES + 0.0374, **kwargs)
    found = beside(MeasuredRecord(velocity, RATE, "A", "r.csv"), of_few_lines(**kwargs))
    assert found.shift == pytest.approx(0.0374, abs=1e-6)
    assert found.lines["ratio"].to_numpy() == pytest.approx(1.0, abs=0.01)
    width = RATE / velocity.size
    assert found.lines["shows_at"].between(width, 0.5 * RATE - width).all()


def test_lines_that_all_show_at_one_place_tell_no_shift():
    """At 500 Hz of mesh and 2000 Hz, harmonics show at 500 Hz, 1000 Hz or 0 Hz."""
    fine = np.arange(0.0, 2.0, 2e-5)
    sensor = VelocitySensor(high_pass_hz=0.0, low_pass_hz=0.0, bits=0)
    predicted = Predicted(few_lines(fine * 500.0 / MESH), 2e-5, sensor, 500.0, MESHES)
    record = MeasuredRecord(few_lines((TIMES + 2e-4) * 500.0 / MESH), RATE, "A", "r.csv")
    with pytest.raises(ParameterError, match="all predicted lines show at 500 Hz when they are"):
        beside(record, predicted)


def test_a_reversed_sign_is_no_time_shift(predicted):
    own = record()
    for gain, faults in ((-1.0, ["polarity"]), (-2.0, ["polarity", "gain"])):
        found = beside(own._replace(velocity=gain * own.velocity), predicted)
        assert [one.partition(":")[0] for one in found.faults] == faults
        assert found.gain == pytest.approx(gain, rel=0.02)
        assert found.likeness > 0.99
        assert found.lines.head(10)["ratio"].to_numpy() == pytest.approx(-gain, rel=0.05)


@pytest.mark.parametrize("length", [1200, 3400])
def test_noise_tells_no_speed_and_lines_under_noise_do(length):
    """Of even noise, one record in a thousand tells one; lines are found under 1.8 times theirs."""
    predicted = of_few_lines()
    clean = few_lines(TIMES[:length])
    orders, sizes = predicted.lines
    for seed in range(20):
        noise = 1.8 * clean.std() * np.random.default_rng(seed).standard_normal(length)
        told = [
            told_speed(v, RATE, predicted.turn_hz * orders, sizes) for v in (noise, clean + noise)
        ]
        assert np.isnan(told[0]), seed
        assert told[1] == pytest.approx(1.0, abs=1e-3), seed


def test_memory_does_not_grow_with_lines_and_samples():
    """9625 orders of 40000 samples, as of 25 and 77 teeth: 5.7 GiB if all factors were held."""
    samples = np.random.default_rng(0).standard_normal(40000)
    frequencies = np.arange(1, 9626) * 450.0 / 1925
    tracemalloc.start()
    found = line_amplitudes(samples, 1e4, frequencies)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 50 * 2**20
    weight = (1.0 - np.cos(2.0 * np.pi * np.arange(40000) / 40000)) / 40000
    off = (samples - weight @ samples) * weight
    for k in (0, 4000, 9624):
        turned = np.exp(-2j * np.pi * frequencies[k] / 1e4 * np.arange(40000))
        assert abs(found[k] - 2.0 * turned @ off) < 1e-9 * np.abs(off).sum()
