"""Signals for tests of flanges: bursts of one frequency, smooth turns, constants."""

import numpy as np

from herringbone.analysis.flange.bench import Signal


def burst(size: float, period: float, cycles: float, phase: float = 0.0) -> Signal:
    """A sine of `size` under a Hann window of so many cycles [s]; it begins and ends at zero."""
    length = cycles * period

    def signal(t: np.ndarray) -> np.ndarray:
        inside = np.clip(t, 0.0, length)
        window = 0.5 - 0.5 * np.cos(2.0 * np.pi * inside / length)
        return size * window * np.sin(2.0 * np.pi * inside / period + phase)

    return signal


def turn(size: float, length: float) -> Signal:
    """From zero to `size` in `length` [s], with rates that begin and end at zero."""

    def signal(t: np.ndarray) -> np.ndarray:
        x = np.clip(t / length, 0.0, 1.0)
        return size * x**3 * (10.0 - 15.0 * x + 6.0 * x**2)

    return signal


def run_up(rate: float, length: float) -> Signal:
    """From rest to growing evenly by `rate` a second, in `length` [s]."""

    def signal(t: np.ndarray) -> np.ndarray:
        x = np.clip(t / length, 0.0, 1.0)
        return rate * (length * x**3 * (1.0 - 0.5 * x) + np.maximum(t - length, 0.0))

    return signal


def steady(rate: float) -> Signal:
    """What grows evenly by `rate` a second."""
    return lambda t: rate * t


def constant(size: float) -> Signal:
    """What is there from the start."""
    return lambda t: np.full_like(t, size)


def hann_mean(values: np.ndarray) -> float:
    """Mean in which vibration drops out."""
    window = np.hanning(len(values) + 2)[1:-1]
    return float(window @ values / window.sum())
