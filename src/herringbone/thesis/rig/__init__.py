"""Entries: the test rig, its sensors, and what was measured."""
