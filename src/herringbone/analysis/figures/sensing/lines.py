"""Lines in what a sensor has sampled, and the mesh harmonics that show there."""

from dataclasses import dataclass

import numpy as np

from herringbone.analysis.figures.sensing.velocity_sensor import VelocitySensor
from herringbone.analysis.figures.spectra import FEWEST_SAMPLES, spectral_lines

_MOST_ORDERS = 50


@dataclass(frozen=True)
class SensorLine:
    """A line in a sampled record.

    Attributes:
        frequency_hz: at which it shows.
        amplitude: [m/s].
        mesh_order: harmonic of the mesh frequency that shows there; None if none does, or if what
            vibrates at that frequency itself is larger.
        folded: that harmonic lies above half the sampling rate.
    """

    frequency_hz: float
    amplitude: float
    mesh_order: int | None
    folded: bool


class Felt:
    """A vibration before it is sampled.

    Args:
        time: (n,) of even rows [s].
        velocity: (n,) [m/s].
    """

    def __init__(self, time: np.ndarray, velocity: np.ndarray) -> None:
        self._time, self._window = time, np.hanning(len(time))
        self._windowed = self._window * (velocity - velocity.mean())

    def amplitude(self, frequency: float) -> float:
        """At a frequency [Hz], through a Hann window [m/s]; 0 at what rows do not tell."""
        if frequency > 0.5 / (self._time[1] - self._time[0]):
            return 0.0
        turned = np.exp(-2j * np.pi * frequency * self._time)
        return float(2.0 * abs(self._windowed @ turned) / self._window.sum())


def sensor_lines(
    chain: VelocitySensor, samples: np.ndarray, felt: Felt, mesh: float | None, count: int = 3
) -> tuple[SensorLine, ...]:
    """The largest lines of samples, with the mesh harmonics that show there, largest first.

    Args:
        chain: that has sampled.
        samples: (n,) [m/s]; too few have no lines.
        felt: what was sampled.
        mesh: its frequency [Hz]; None if it is not known.
        count: at most so many lines.
    """
    if len(samples) < FEWEST_SAMPLES:
        return ()
    half, resolution = 0.5 * chain.sampling_hz, chain.sampling_hz / len(samples)
    found = spectral_lines(samples, 1.0 / chain.sampling_hz, half, count)

    def told(frequency: float) -> tuple[int | None, bool]:
        return (None, False) if mesh is None else _order(chain, mesh, frequency, resolution, felt)

    return tuple(
        SensorLine(line.frequency, line.amplitude, *told(line.frequency)) for line in found
    )


def _order(
    chain: VelocitySensor, mesh: float, frequency: float, resolution: float, felt: Felt
) -> tuple[int | None, bool]:
    """Lowest mesh harmonic that shows at a frequency, within a resolution; is it folded."""
    for k in range(1, _MOST_ORDERS + 1):
        if abs(chain.alias_hz(k * mesh) - frequency) > resolution:
            continue
        if k * mesh <= 0.5 * chain.sampling_hz:
            return k, False
        if felt.amplitude(k * mesh) > felt.amplitude(frequency):
            return k, True
    return None, False
