"""Amplitude spectra of uniformly sampled signals, mesh orders and spectral lines.

Spectra are single-sided and amplitude-corrected: a sine of amplitude A in the middle of a frequency
bin shows A. Between two bins a Hann window shows up to 15 % less; `spectral_lines` interpolates and
is exact for a single sine.

Source: F. J. Harris, On the use of windows for harmonic analysis with the discrete Fourier
transform, Proc. IEEE 66 (1978); interpolation of Hann-windowed lines by T. Grandke, Interpolation
algorithms for discrete Fourier transforms of weighted signals, IEEE Trans. IM 32 (1983).
"""

import math
from typing import NamedTuple

import numpy as np

from herringbone.core import ParameterError

FEWEST_SAMPLES = 8
"""A shorter signal has no meaningful spectrum."""
PADDING = 4
"""Of spectra whose peaks are read: without it, lines between two bins are up to 15 % low."""


class Spectrum(NamedTuple):
    """Single-sided amplitude spectrum.

    Attributes:
        frequency: (k,) [Hz].
        amplitude: (k,) or (k, m) for m signals, in the signal's unit; zero at 0 Hz.
        mean: window-weighted mean that was removed, scalar array or (m,), in the signal's unit.
        resolution: distance of independent frequencies, 1 / duration [Hz].
    """

    frequency: np.ndarray
    amplitude: np.ndarray
    mean: np.ndarray
    resolution: float


class MeshOrder(NamedTuple):
    """A multiple of the mesh frequency [Hz]."""

    order: int
    frequency: float


class Line(NamedTuple):
    """A spectral line: frequency [Hz] and amplitude, in the signal's unit."""

    frequency: float
    amplitude: float


def hann_weight(count: int) -> np.ndarray:
    """A Hann window over so many samples (count,), whose sum is 1."""
    window = 0.5 - 0.5 * np.cos(2.0 * math.pi * np.arange(count) / count)
    return window / window.sum()


def amplitudes_at_multiples(
    time: np.ndarray, values: np.ndarray, frequency: float, count: int
) -> np.ndarray:
    """Amplitudes (count, signals) at 1, 2, ... times a frequency, each signal without its mean.

    Args:
        time: (n,), equidistant [s].
        values: (n, signals).
        frequency: [Hz].
        count: of multiples.
    """
    weight = hann_weight(time.size)
    alternating = (values - weight @ values) * weight[:, None]
    once = np.exp(-2j * math.pi * frequency * (time - time[0]))
    factor, found = np.ones_like(once), np.empty((count, values.shape[1]))
    for k in range(count):
        factor = factor * once
        found[k] = 2.0 * np.abs(factor @ alternating)
    return found


def amplitude_spectrum(signal: np.ndarray, sample_step: float, padding: int = 1) -> Spectrum:
    """Hann-windowed amplitude spectrum without the mean.

    Args:
        signal: samples (n,) or one signal per column (n, m).
        sample_step: time between samples [s].
        padding: the signal is padded with zeros to this many times its length; 4 draws a smooth
            curve whose peaks are at most 1 % low. It adds no resolution.

    Raises:
        ParameterError: too few samples, or a sample step that is not positive.
    """
    signal = np.asarray(signal, dtype=float)
    count = signal.shape[0]
    if count < FEWEST_SAMPLES:
        raise ParameterError(f"{count} samples make no spectrum; it takes {FEWEST_SAMPLES} or more")
    if not (math.isfinite(sample_step) and sample_step > 0.0):
        raise ParameterError(f"sample_step = {sample_step:g} s: it must be positive and finite")
    weight = hann_weight(count)
    mean = weight @ signal
    length = padding * count
    windowed = ((signal - mean).T * weight).T
    amplitude = one_sided(np.fft.rfft(windowed, length, axis=0), length)
    frequency = np.arange(amplitude.shape[0]) / (length * sample_step)
    return Spectrum(frequency, amplitude, mean, 1.0 / (count * sample_step))


def one_sided(transform: np.ndarray, length: int) -> np.ndarray:
    """Amplitudes of a real transform (k, ...) of signals without mean, of some length.

    Half the rate, the last of an even length, has no mirror image.
    """
    amplitude = 2.0 * np.abs(transform)
    amplitude[0] = 0.0
    if length % 2 == 0:
        amplitude[-1] *= 0.5
    return amplitude


def mesh_frequency(speed: float, number_of_teeth: float) -> float:
    """f_m = z w / (2 pi) [Hz] of a gear that turns with `speed` [rad/s]."""
    return abs(speed) * number_of_teeth / (2.0 * math.pi)


def mesh_orders(frequency: float, highest: float) -> tuple[MeshOrder, ...]:
    """The multiples of the mesh frequency [Hz] up to `highest` [Hz]."""
    if not frequency > 0.0:
        return ()
    return tuple(MeshOrder(k, k * frequency) for k in range(1, int(highest / frequency) + 1))


def spectral_lines(
    signal: np.ndarray, sample_step: float, highest: float, count: int = 3
) -> tuple[Line, ...]:
    """The largest lines of a signal below a frequency, largest first.

    Args:
        signal: samples (n,).
        sample_step: time between samples [s].
        highest: frequency up to which lines are looked for [Hz].
        count: at most so many lines.

    Raises:
        ParameterError: see `amplitude_spectrum`.
    """
    spectrum = amplitude_spectrum(signal, sample_step)
    amplitude = spectrum.amplitude
    inner = amplitude[1:-1]
    peaks = 1 + np.flatnonzero((inner > amplitude[:-2]) & (inner >= amplitude[2:]))
    peaks = peaks[spectrum.frequency[peaks] <= highest]
    largest = peaks[np.argsort(-amplitude[peaks], kind="stable")][:count]
    lines = [_interpolated(amplitude, int(k), spectrum.resolution) for k in largest]
    return tuple(sorted(lines, key=lambda line: -line.amplitude))


def _interpolated(amplitude: np.ndarray, k: int, resolution: float) -> Line:
    """Line at peak k from the larger one of its neighbours; exact for a single sine."""
    side = 1 if amplitude[k + 1] >= amplitude[k - 1] else -1
    ratio = amplitude[k + side] / amplitude[k]
    offset = (2.0 * ratio - 1.0) / (ratio + 1.0)
    offset = min(max(offset, 0.0), 0.5)
    height = amplitude[k] * (1.0 - offset**2) / np.sinc(offset)
    return Line((k + side * offset) * resolution, float(height))
