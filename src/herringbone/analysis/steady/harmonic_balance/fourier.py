"""Real periodic signals: values at equal places of a period, and coefficients of harmonics."""

import numpy as np


def in_time(coefficients: np.ndarray, orders: np.ndarray, places: int) -> np.ndarray:
    """Values (n, places) of signals of coefficients (n, harmonics) of ascending orders."""
    if orders.size <= orders[-1]:
        every = np.zeros((len(coefficients), orders[-1] + 1), dtype=complex)
        every[:, orders] = coefficients
        coefficients = every
    return np.fft.irfft(coefficients * places, places, axis=1)


def in_frequency(values: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """Coefficients (n, harmonics), of some orders, of values (n, places)."""
    found = np.fft.rfft(values, axis=1)
    found = found[:, : orders[-1] + 1] if orders.size > orders[-1] else found[:, orders]
    return found / values.shape[1]


def on(orders: np.ndarray, coefficients: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Coefficients (n, harmonics) of orders, from those (n, ...) of known ones; zero elsewhere."""
    found = np.zeros((len(coefficients), orders.size), dtype=complex)
    if orders.size > orders[-1] and known.size > known[-1]:  # none is left out
        count = min(orders.size, known.size)
        found[:, :count] = coefficients[:, :count]
        return found
    _, here, there = np.intersect1d(orders, known, assume_unique=True, return_indices=True)
    found[:, here] = coefficients[:, there]
    return found
