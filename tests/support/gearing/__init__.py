"""Gear pairs of tests, their teeth and energies."""
