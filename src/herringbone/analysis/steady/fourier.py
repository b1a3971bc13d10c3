"""Real periodic signals: values at equal places of a period, and coefficients of harmonics."""

import numpy as np


def in_time(coefficients: np.ndarray, places: int) -> np.ndarray:
    """Values (n, places) of signals of coefficients (n, harmonics)."""
    return np.fft.irfft(coefficients * places, places, axis=1)


def in_frequency(values: np.ndarray, count: int) -> np.ndarray:
    """Coefficients (n, count) of values (n, places)."""
    return np.fft.rfft(values, axis=1)[:, :count] / values.shape[1]
