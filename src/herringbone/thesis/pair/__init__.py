"""Entries: the gear pair, its mesh stiffness, profile modification."""
