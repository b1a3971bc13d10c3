"""Lines of a record at multiples of a shaft's turn, and the speed that a record tells.

A line that lies above half the sampling rate is folded; its complex amplitude at the true frequency
is the same on the samples, so that nothing is to be told apart but lines that fold onto each other.
"""

import math

import numpy as np
import scipy.linalg
import scipy.special

from herringbone.analysis.figures.spectra import hann_weight
from herringbone.core.process.one_thread import one_blas_thread

_LARGE = 0.1
"""Lines whose places are asked at every speed, over the largest one."""
_MOST = 300
"""Lines, the largest ones, that are taken out of a record at speeds that may be the right one."""
_SPAN = 2.0
"""The speed is looked for between the stated one over this and times this."""
_AS_GOOD = 0.75
"""Speeds that have so much of the best mean logarithm, above the usual one, may be the right one.
"""
_PARTS = 8
"""Candidates, and places of the spectrum, per width of a line."""
_COARSE = 4
"""How many of these are passed over at first."""
_COINCIDE = 1e-3
"""Added to a line's own product, so that lines that fold onto each other are one."""
_ASKED = 32
"""Speeds that tell what share of a record lines take by chance."""
_RARE = 1e-3
"""Records of even noise of which a speed is told."""
_AT_ONCE = 256
"""Frequencies of which turning factors are held."""


def line_amplitudes(samples: np.ndarray, rate: float, frequencies: np.ndarray) -> np.ndarray:
    """Complex amplitudes (k,) of lines of samples (n,), under a Hann window.

    Args:
        samples: (n,).
        rate: [Hz].
        frequencies: (k,), also above half the rate [Hz].
    """
    weight = hann_weight(samples.size)
    return 2.0 * turned_back((samples - weight @ samples) * weight, rate, frequencies)


def turned_back(samples: np.ndarray, rate: float, frequencies: np.ndarray) -> np.ndarray:
    """Sums (k,) of samples (n,), each turned back by its phase at frequencies (k,) [Hz].

    A sample's phase is that of the block in which it lies and that in the block: 2 sqrt(n) factors
    in place of n.
    """
    block = math.isqrt(samples.size) + 1
    rows = -(-samples.size // block)
    table = np.zeros((rows, block))
    table.flat[: samples.size] = samples
    found = np.empty(frequencies.size, dtype=complex)
    for first in range(0, frequencies.size, _AT_ONCE):
        piece = slice(first, first + _AT_ONCE)
        rates = -2j * np.pi / rate * frequencies[piece]
        within = np.exp(np.outer(np.arange(block), rates))
        begins = np.exp(np.outer(block * np.arange(rows), rates))
        found[piece] = ((table @ within) * begins).sum(axis=0)
    return found


@one_blas_thread()
def told_speed(
    samples: np.ndarray, rate: float, frequencies: np.ndarray, amplitudes: np.ndarray
) -> float:
    """Speed that lines tell, over the one that is stated.

    Right may be speeds at which the places of predicted lines, moved along, have lines. Logarithms
    of amplitudes are added, as resonances at other places make other lines large. With teeth that
    deviate, mesh harmonics are not the largest lines, so that all are asked.

    That alone takes side bands for their neighbours: moved by one in 77, each line beside a mesh
    harmonic of 77 turns lies where the next one was. Of these speeds it is the one whose lines,
    fitted to the record, leave the least of it (the likeliest one under even noise).

    Returns:
        The speed; NaN if lines at the best one take no more of the record than of even noise.

    Args:
        samples: (n,).
        rate: [Hz].
        frequencies: (k,) of predicted lines at the stated speed, also above half the rate [Hz].
        amplitudes: (k,) theirs.
    """
    spectrum = _Spectrum(samples, rate)
    large = frequencies[amplitudes >= _LARGE * amplitudes.max()]
    taken = frequencies[np.argsort(-amplitudes, kind="stable")[:_MOST]]
    step = rate / samples.size / large.max() / _PARTS
    count = int(2.0 * np.log(_SPAN) / step)
    ratios = np.exp(np.linspace(-np.log(_SPAN), np.log(_SPAN), count))
    met = sum(spectrum.logarithms(ratios * f) for f in large) / large.size
    usual = float(np.median(met))
    good = np.flatnonzero(met - usual >= _AS_GOOD * (met.max() - usual))
    places = np.unique(np.clip(good[:, None] + np.arange(-_PARTS, _PARTS + 1), 0, count - 1))

    def left(place: int) -> float:
        return spectrum.left(float(ratios[place]) * taken)

    best = int(min(places[::_COARSE], key=left))
    near = range(max(0, best - _COARSE), min(count, best + _COARSE + 1))
    best = min(near, key=left)
    by_chance = 1.0 - float(np.median([left(k) for k in range(0, count, count // _ASKED)]))
    if 1.0 - left(best) < _most_by_chance(by_chance, samples.size, count):
        return float("nan")
    return float(ratios[best])


def _most_by_chance(usual: float, samples: int, tries: int) -> float:
    """Share of the energy of even noise that lines take at the best of many speeds, nearly always.

    Args:
        usual: share that they take at a speed.
        samples: of the record.
        tries: speeds.
    """
    free = samples / 3.0  # squares of a Hann window's samples are two thirds as many; by twos
    return float(scipy.special.betaincinv(free * usual, free * (1.0 - usual), 1.0 - _RARE / tries))


class _Spectrum:
    """Spectrum of samples (n,), under a Hann window, with `_PARTS` places per width of a line."""

    def __init__(self, samples: np.ndarray, rate: float) -> None:
        window, self._rate, self._length = hann_weight(samples.size), rate, _PARTS * samples.size
        off = samples - window @ samples
        self._lines = np.fft.fft(off * window, self._length)
        self._window = np.fft.fft(window, self._length)
        self._energy = float(window @ off**2)
        size = np.abs(self._lines)
        self._logarithms = np.log1p(size / np.median(size))

    def _places(self, frequencies: np.ndarray) -> np.ndarray:
        return np.rint(frequencies * (self._length / self._rate)).astype(int) % self._length

    def logarithms(self, frequencies: np.ndarray) -> np.ndarray:
        """Logarithms (k,) of amplitudes, over the median, at frequencies (k,)."""
        return self._logarithms[self._places(frequencies)]

    def left(self, frequencies: np.ndarray) -> float:
        """Share of the energy that lines at frequencies (k,) leave, by least squares."""
        own = self._places(frequencies)
        apart, together = (
            self._window[(own[:, None] + sign * own) % self._length] for sign in (-1, 1)
        )
        crossed = 0.5 * (apart - together).imag  # cosines by sines
        matrix = np.block(
            [[0.5 * (apart + together).real, crossed], [crossed.T, 0.5 * (apart - together).real]]
        )
        matrix[np.diag_indices_from(matrix)] += _COINCIDE * self._window[0].real
        by = np.concatenate([self._lines[own].real, -self._lines[own].imag])
        found = scipy.linalg.solve(matrix, by, assume_a="pos", overwrite_a=True)
        return 1.0 - float(by @ found) / self._energy
