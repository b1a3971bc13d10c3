"""Real periodic signals: values at equal places of a period, and coefficients of harmonics."""

import numpy as np


def in_time(coefficients: np.ndarray, orders: np.ndarray, places: int) -> np.ndarray:
    """Values (n, places) of signals of coefficients (n, harmonics) of ascending orders.

    Fewer places than the orders need take them for lower ones; see `lattice`.
    """
    if orders[-1] > places // 2:
        found, back = _taken_for(orders, places)
        lower = np.zeros((len(coefficients), places // 2 + 1), dtype=complex)
        lower[:, found] = np.where(back, coefficients.conj(), coefficients)
        return np.fft.irfft(lower, places, axis=1, norm="forward")
    if orders.size <= orders[-1]:
        every = np.zeros((len(coefficients), orders[-1] + 1), dtype=complex)
        every[:, orders] = coefficients
        coefficients = every
    return np.fft.irfft(coefficients, places, axis=1, norm="forward")


def in_frequency(values: np.ndarray, orders: np.ndarray) -> np.ndarray:
    """Coefficients (n, harmonics), of some orders, of values (n, places)."""
    found = np.fft.rfft(values, axis=1, norm="forward")
    if orders[-1] > values.shape[1] // 2:
        taken, back = _taken_for(orders, values.shape[1])
        found = found[:, taken]
        return np.where(back, found.conj(), found)
    return found[:, : orders[-1] + 1] if orders.size > orders[-1] else found[:, orders]


def _taken_for(orders: np.ndarray, places: int) -> tuple[np.ndarray, np.ndarray]:
    """The orders as which places see others, and which of them as conjugates."""
    rest = orders % places
    back = rest > places // 2
    return np.where(back, places - rest, rest), back


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


def among(orders: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Which of the orders are among known ones, ascending and at least one."""
    place = np.minimum(np.searchsorted(known, orders), known.size - 1)
    return known[place] == orders


def squares(coefficients: np.ndarray) -> np.ndarray:
    """Squares of the sizes of coefficients."""
    return coefficients.real**2 + coefficients.imag**2
