"""Checkpoints: the whole state of a run as arrays, from which a fresh process goes on."""
