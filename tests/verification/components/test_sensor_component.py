"""The component velocity_sensor: filters, samples, converter; and that it disturbs nothing."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, freqs_zpk

import herringbone as hb
from herringbone.analysis.equilibrium import equilibrium
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.twin.composite import make_composite
from herringbone.components.velocity_sensor import VELOCITY_SENSOR
from herringbone.core import Instance, StructureError
from herringbone.cosim.algorithms import LI, GaussSeidel, Jacobi
from herringbone.cosim.structure.system import PartSpec
from herringbone.fmi.interface import has_model_exchange
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started

PERIOD = 5e-4
BARE = {"high_pass_hz": 0.0, "bits": 0}
OBSERVED = "modal_housing.pinion_left.v_z"
SYSTEM = f"""
name = "observed_rig"
description = "test rig with a velocity sensor on the input seat"
connections = [["{OBSERVED}", "sensor.velocity"]]
[parts]
test_rig = {{ system = "test_rig" }}
sensor = {{ component = "velocity_sensor" }}
"""


def sensor(**values: float) -> Instance:
    instance = Instance(VELOCITY_SENSOR, "sensor")
    for name, value in values.items():
        instance.set(name, float(value))
    instance.initialise()
    return instance


def follow(instance: Instance, u: Callable, times: np.ndarray, degree: int = 4) -> np.ndarray:
    """Held output at the communication points behind the first, for a velocity u(t)."""
    instance.set("interface_degree", float(degree))
    held = []
    for t, h in zip(times, np.diff(times), strict=False):
        instance.set("velocity", u(t))
        for node in range(1, degree + 1):
            instance.set(f"velocity.node{node}", u(t + h * node / degree))
        assert instance.step(t, h) == 0
        held.append(instance["velocity_sampled"])
    return np.array(held)


def sine(frequency: float, amplitude: float = 1e-3) -> Callable:
    return lambda t: amplitude * np.sin(2 * np.pi * frequency * t)


def grid(step: float, end: float) -> np.ndarray:
    return step * np.arange(round(end / step) + 1)


def amplitude_at(velocity: np.ndarray, frequency: float) -> complex:
    """Of a whole number of periods that begins at a sample at a whole period of the line."""
    t = PERIOD * np.arange(len(velocity))
    return 2 * np.mean(velocity * np.exp(-2j * np.pi * frequency * t)) * 1j


def gain(options: dict, frequency: float) -> complex:
    """Frequency response of the analog Butterworth filters."""
    wanted = (
        (2, options.get("high_pass_hz", 10.0), "highpass"),
        (2, options.get("low_pass_hz", 0.0), "lowpass"),
        (8, 800.0 * options.get("anti_alias", 0), "lowpass"),
    )
    w = 2 * np.pi * frequency
    found = [
        freqs_zpk(*butter(n, 2 * np.pi * corner, kind, analog=True, output="zpk"), [w])[1][0]
        for n, corner, kind in wanted
        if corner
    ]
    return complex(np.prod(found))


@pytest.mark.parametrize(
    ("options", "frequency"),
    [
        ({"high_pass_hz": 50.0}, 30.0),
        ({"low_pass_hz": 400.0, "high_pass_hz": 0.0}, 900.0),
        ({"anti_alias": 1}, 700.0),
        ({"anti_alias": 1, "low_pass_hz": 1500.0, "high_pass_hz": 20.0}, 600.0),
    ],
)
def test_filters_are_analog_butterworth(options, frequency):
    """Runge-Kutta's phase error is (w h)**4 / 120 < 1e-6 a radian, over 12 states; u is exact."""
    times = grid(1e-4, 0.6)
    held = follow(sensor(bits=0, **options), sine(frequency), times)
    samples = held[4::5][799:]  # behind the transients, from a sample at 0.4 s on
    folded = frequency if frequency < 1000 else 2000 - frequency
    found = amplitude_at(samples[:400], folded)
    assert found == pytest.approx(1e-3 * gain(options, frequency), abs=1e-8)


def test_second_mesh_harmonic_folds_unless_it_is_filtered():
    """27 teeth at 1500 r/min: 1350 Hz shows at 650 Hz; the filter takes it to (800/1350)**8."""
    found = []
    for anti_alias in (0, 1):
        held = follow(sensor(bits=0, anti_alias=anti_alias), sine(1350.0), grid(5e-5, 0.6))
        found.append(abs(amplitude_at(held[9::10][799:1199], 650.0)))
    high_pass = 1.0 / np.sqrt(1.0 + (10.0 / 1350.0) ** 4)
    # The polynomial of degree 4 through five nodes: (w h)**5 / 5! / 4**5 * max |product| = 1.5e-6.
    assert found[0] == pytest.approx(1e-3 * high_pass, rel=3e-5)
    assert found[1] == pytest.approx(1e-3 / np.sqrt(1.0 + (1350.0 / 800.0) ** 16), rel=1e-3)


@pytest.mark.parametrize("options", [{}, {"anti_alias": True}, {"low_pass_hz": 1500.0}], ids=str)
def test_post_processing_converges_to_it(options):
    """The bilinear transform of the post-processing is of order 2 in the step of its input."""

    def u(t: np.ndarray) -> np.ndarray:
        return sine(675.0)(t) + sine(1350.0, 2e-3)(t)

    held = follow(sensor(bits=0, **options), u, grid(1e-5, 0.05))[49::50]
    difference = [
        np.abs(VelocitySensor(bits=0, **options).measure(u(grid(h, 0.05)), h).velocity[1:] - held)
        for h in (1e-5, 5e-6)
    ]
    coarse, fine = (np.linalg.norm(d) for d in difference)
    assert 1.8 < np.log2(coarse / fine) < 2.2
    assert difference[1].max() < 1e-4  # of 3e-3


def test_samples_do_not_depend_on_the_communication_step():
    """A cubic velocity is exact at degree 3; what differs is Runge-Kutta's error, below 1e-5."""
    rng = np.random.default_rng(3)
    irregular = np.sort(np.concatenate([grid(1e-3, 0.02), rng.uniform(0.0, 0.02, 30)]))

    def u(t: float) -> float:
        s = t / 0.02
        return 0.03 * (1.0 - 7.0 * s + 15.0 * s**2 - 9.0 * s**3)

    found = []
    for times in (grid(1e-5, 0.02), grid(1e-4, 0.02), grid(1e-3, 0.02), irregular):
        instance = sensor(bits=0, anti_alias=1, range=0.01)
        at = np.isclose(times[1:, None], grid(1e-3, 0.02)[1:], rtol=0, atol=1e-9).any(axis=1)
        held = follow(instance, u, times, degree=3)[at]
        found.append((held, instance["saturation_count"], instance["next_sample"]))
    for held, saturated, number in found[1:]:
        np.testing.assert_allclose(held, found[0][0], rtol=0, atol=1e-5 * 0.03)
        assert (saturated, number) == (found[0][1], 41)
    assert 0 < found[0][1] < 41


def test_samples_lie_where_they_are_counted():
    """A ramp shows the instants: sample k at first_sample + k / 2000, no drift, none twice."""
    instance = sensor(first_sample=1.7e-4, range=100.0, **BARE)
    times = np.cumsum(np.full(30001, 1e-4 / 3.0))
    held = follow(instance, lambda t: t, times, degree=1)
    ends = times[1:]
    number = np.floor((ends - 1.7e-4) / PERIOD)
    expected = np.where(number >= 0, 1.7e-4 + number * PERIOD, 0.0)
    np.testing.assert_allclose(held, expected, rtol=0, atol=1e-11)
    assert instance["next_sample"] == number[-1] + 1


def test_a_late_start_leaves_out_earlier_samples():
    instance = sensor(range=100.0, **BARE)
    held = follow(instance, lambda t: t, 5.0 + grid(1e-3, 3e-3), degree=1)
    np.testing.assert_allclose(held, [5.001, 5.002, 5.003], rtol=1e-12)
    assert instance["next_sample"] == 10007
    clipped = sensor(range=1.0, **BARE)
    follow(clipped, lambda t: t, 5.0 + grid(1e-3, 3e-3), degree=1)
    assert clipped["saturation_count"] == 7


def test_a_sample_at_the_start_shows_at_the_end_of_the_first_step():
    """Until then the output is 0, as it is before any first sample."""
    for first, expected in ((0.0, [3e-3, 3e-3]), (1e-4, [3e-3, 3e-3]), (1.5e-4, [0.0, 3e-3])):
        instance = Instance(VELOCITY_SENSOR, "sensor")
        for name, value in {**BARE, "velocity": 3e-3, "first_sample": first}.items():
            instance.set(name, value)
        instance.initialise()
        assert instance["velocity_sampled"] == 0.0
        assert follow(instance, lambda _: 3e-3, grid(1e-4, 2e-4)).tolist() == expected


def test_times_whose_samples_cannot_be_counted_come_to_an_end():
    """From 2^53 samples on their number has no successor: a step went on for ever."""
    instance = sensor()
    for t in (2.0**53, 1e300):
        assert instance.step(t, 1e-5) == 0


def test_converter_clips_and_rounds_exactly():
    """8 bits over +-0.05 m/s: digits -128 ... 127, multiples of 0.1 m/s / 256."""
    rng = np.random.default_rng(1)
    velocity = rng.uniform(-0.08, 0.08, 400)
    instance = sensor(bits=8, high_pass_hz=0.0)
    held = follow(instance, lambda t: velocity[round(t / PERIOD)], grid(PERIOD, 0.2)[:-1], degree=0)
    digit = 0.1 / 256
    expected = digit * np.clip(np.round(velocity[:-1] / digit), -128, 127)
    assert np.array_equal(held, expected)
    saturated = np.abs(velocity[:-1]) > 0.05
    # Sample 0 lies at the start of the first step, where the velocity is the same.
    assert instance["saturation_count"] == saturated.sum() + saturated[0]


def test_restored_state_gives_the_same_samples():
    instance = sensor(anti_alias=1, range=1e-3)
    first, second = grid(7e-5, 7e-3), 7e-3 + grid(7e-5, 7e-3)
    follow(instance, sine(90.0, 5e-3), first)
    saved = instance.block.copy()
    once = follow(instance, sine(90.0, 5e-3), second), instance["saturation_count"]
    size = VELOCITY_SENSOR.declaration.mutable_size
    instance.block[:size] = saved[:size]
    again = follow(instance, sine(90.0, 5e-3), second), instance["saturation_count"]
    assert np.array_equal(once[0], again[0])
    assert once[1] == again[1] > saved[VELOCITY_SENSOR.declaration.index["saturation_count"]] > 0
    assert len(np.unique(once[0])) >= 3


@pytest.fixture(scope="module")
def rig():
    system, folder = load_system("test_rig")
    return started(system, load_scene(folder, "loaded"))[0]


@pytest.fixture(scope="module")
def observed(rig):
    part = PartSpec("sensor", component="velocity_sensor")
    return replace(
        rig,
        parts=(*rig.parts, part),
        connections=(*rig.connections, (OBSERVED, "sensor.velocity")),
    )


def test_equilibrium_is_the_same(rig, observed):
    """Each is found to its own residual; forces and speeds of the rig are of order 1 to 1e3."""
    wanted, found = equilibrium(rig).values, equilibrium(observed).values
    assert set(wanted) == set(found)
    for name, value in wanted.items():
        assert found[name] == pytest.approx(value, rel=1e-6, abs=1e-9), name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("algorithm", "step"),
    [(Jacobi(2), 60e-6), (GaussSeidel(2), 60e-6), (LI(3), 720e-6)],
    ids=str,
)
def test_growth_of_a_step_is_the_same(algorithm, step, rig, observed):
    """What an observer adds decays: the largest growth stays that of the rig."""
    alone, both = (
        Amplification(*linear_network(system), algorithm).growth(step) for system in (rig, observed)
    )
    assert alone.radius > 1.0
    assert both.radius == pytest.approx(alone.radius, rel=1e-6)
    assert both.frequency == pytest.approx(alone.frequency, rel=1e-6)


def test_neither_model_exchange_nor_one_component_takes_samples(observed):
    assert not has_model_exchange(VELOCITY_SENSOR)
    with pytest.raises(StructureError, match=r'sensor: .* takes samples.*outside=\["sensor"\]'):
        make_composite(observed)


@pytest.mark.parametrize("options", [{}, {"anti_alias": True}], ids=["plain", "anti_alias"])
def test_on_the_rig_it_shows_what_post_processing_shows(options, tmp_path):
    """At 10 us the digital filter is warped by (pi f h)**2 / 3 = 3e-4 at 1 kHz, in 8 orders."""
    (tmp_path / "system.toml").write_text(SYSTEM, encoding="utf-8")
    _, folder = load_system("test_rig")
    scene = load_scene(folder, "loaded")
    values = {f"sensor.{name}": float(value) for name, value in ({"bits": 0} | options).items()}
    result = hb.run(
        tmp_path, scene=scene, t_end=0.03, step=1e-5, record_step=1e-5, fmu="in-process",
        values=values,
    )  # fmt: skip
    recorded = result[OBSERVED].to_numpy()
    wanted = VelocitySensor(bits=0, **options).measure(recorded, 1e-5).velocity[1:]
    found = result.data["sensor.velocity_sampled"].to_numpy()[50::50]
    assert np.abs(wanted).max() > 1e-5
    assert np.abs(found - wanted).max() < (5e-3 if options else 1e-3) * np.abs(wanted).max()
