"""Aliasing of a sensor at 2 kHz: at 1500 r/min the second mesh harmonic shows at 650 Hz."""

import tempfile
from pathlib import Path

import numpy as np

import herringbone as hb
from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor, sensor_velocity
from herringbone.analysis.figures.spectra import amplitude_spectrum

SPEED, TORQUE, TEETH = 1500.0, 200.0, 27
CYCLE = f"# units: time s, speed r/min, torque N.m\ntime,speed,torque\n0,{SPEED:g},{TORQUE:g}\n"
RECORD_STEP = 2e-5


def vibration(t_end: float) -> np.ndarray:
    """Axial velocity at the sensors A, B, C [m/s]."""
    with tempfile.TemporaryDirectory() as folder:
        cycle = Path(folder, "cycle.csv")
        cycle.write_text(CYCLE, encoding="utf-8")
        result = hb.run(
            "test_rig",
            t_end=t_end,
            step=RECORD_STEP,  # records are taken where steps end
            record_step=RECORD_STEP,
            values={"bench_controller.cycle": str(cycle)},
        )
        return sensor_velocity(result)


def lines(sensor: VelocitySensor, velocity: np.ndarray, frequencies: tuple) -> list[float]:
    """Amplitudes at sensor A [mm/s], the start left out."""
    record = sensor.measure(velocity, RECORD_STEP)
    steady = record.velocity[len(record.velocity) // 4 :, 0]
    spectrum = amplitude_spectrum(steady, 1.0 / sensor.sampling_hz)
    near = [np.abs(spectrum.frequency - f) < 2 * spectrum.resolution for f in frequencies]
    return [1e3 * float(spectrum.amplitude[rows].max()) for rows in near]


def main(t_end: float = 0.4) -> float:
    """The line at 650 Hz without the anti-alias filter, over that with it."""
    velocity = vibration(t_end)
    mesh = SPEED / 60.0 * TEETH
    plain, filtered = VelocitySensor(), VelocitySensor(anti_alias=True)
    alias = plain.alias_hz(2.0 * mesh)
    print(f"second mesh harmonic {2.0 * mesh:g} Hz shows at {alias:g} Hz")
    found = []
    for name, sensor in (("without", plain), ("with", filtered)):
        at_alias, at_mesh = lines(sensor, velocity, (alias, mesh))
        found.append(at_alias)
        print(
            f"{name:>8} filter: {at_alias:.4f} mm/s at {alias:g} Hz, {at_mesh:.4f} at {mesh:g} Hz"
        )
    return found[0] / found[1]


if __name__ == "__main__":
    main()
