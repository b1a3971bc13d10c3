"""Lines of a record at multiples of a shaft's turn, and the speed that a record tells.

A line that lies above half the sampling rate is folded; its complex amplitude at the true frequency
is the same on the samples, so that nothing is to be told apart but lines that fold onto each other.
"""

import numpy as np

from herringbone.analysis.figures.spectra import hann_weight

_LARGE = 0.1
"""Lines that tell the speed, over the largest one."""
_SPAN = 2.0
"""The speed is looked for between the stated one over this and times this."""
_AS_GOOD = 0.8
"""Of the share of the best speed: so much at the stated one, and that is taken."""
_PARTS = 8
"""Candidates per width of a line."""


def line_amplitudes(samples: np.ndarray, rate: float, frequencies: np.ndarray) -> np.ndarray:
    """Complex amplitudes (k,) of lines of samples (n,), under a Hann window.

    Args:
        samples: (n,).
        rate: [Hz].
        frequencies: (k,), also above half the rate [Hz].
    """
    weight = hann_weight(samples.size)
    off = (samples - weight @ samples) * weight
    turning = np.exp(-2j * np.pi / rate * np.outer(frequencies, np.arange(samples.size)))
    return 2.0 * turning @ off


def told_speed(
    samples: np.ndarray, rate: float, frequencies: np.ndarray, amplitudes: np.ndarray
) -> float:
    """Speed that lines tell, over the one that is stated.

    It is the speed at which the places of predicted lines, moved along, have lines; the stated one
    if that is nearly as good, but for less than the width of a line. Logarithms of amplitudes are
    added, as resonances at other places make other lines large. With teeth that deviate, mesh
    harmonics are not the largest lines, so that all are asked. Far from the stated speed a
    wrong one may do better by chance: 0.7298 was told as 0.7393, one of some fifty drawn ones.

    Args:
        samples: (n,).
        rate: [Hz].
        frequencies: (k,) of predicted lines at the stated speed, also above half the rate [Hz].
        amplitudes: (k,) theirs.
    """
    frequencies = frequencies[amplitudes >= _LARGE * amplitudes.max()]
    width = rate / samples.size / frequencies.max()
    count = int(2.0 * np.log(_SPAN) / width * _PARTS)
    ratios = np.exp(np.linspace(-np.log(_SPAN), np.log(_SPAN), count))
    met = _met(samples, rate, np.outer(ratios, frequencies))
    near = np.abs(ratios - 1.0) <= 2.0 * width
    best, own = int(np.argmax(met)), int(np.flatnonzero(near)[np.argmax(met[near])])
    usual = float(np.median(met))
    as_good = met[own] - usual >= _AS_GOOD * (met[best] - usual)
    return float(ratios[own] if as_good else ratios[best])


def _met(samples: np.ndarray, rate: float, frequencies: np.ndarray) -> np.ndarray:
    """Mean logarithm of amplitudes, over the median, at frequencies (candidates, k)."""
    window, length = hann_weight(samples.size), _PARTS * samples.size
    size = np.abs(np.fft.rfft((samples - window @ samples) * window, length))
    rest = frequencies % rate
    places = np.rint(np.minimum(rest, rate - rest) * length / rate).astype(int)
    return np.log1p(size / np.median(size))[places].mean(axis=1)
