"""Entries: the dynamic model of the gear transmission."""
