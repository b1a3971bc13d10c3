"""Reduction of housings to few oscillators, and how wrong that is."""
