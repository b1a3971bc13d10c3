"""Harmonic balance of many equations with scalar laws; arrays only."""
