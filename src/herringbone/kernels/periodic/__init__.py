"""Periodic motion: harmonics of samples, and the equations that answer them."""
