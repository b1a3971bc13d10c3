"""Stability of the coupling: limits, why they are exceeded, and what to choose."""
