"""Periodic motions of a linear part with laws, by harmonics; arrays and callables only."""
