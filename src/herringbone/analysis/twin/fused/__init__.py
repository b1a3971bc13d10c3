"""Runs of systems whose parts are condensed into one core."""
