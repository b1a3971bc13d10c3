"""Runs of systems whose parts are fused into one core."""
