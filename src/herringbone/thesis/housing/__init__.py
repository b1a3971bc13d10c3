"""Entries: modes of the housing, bearing forces, vibration of the seats."""
