"""Derivatives of compiled functions in forward mode."""
