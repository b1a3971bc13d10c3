"""Starts without load, which rises: where no start in equilibrium is known."""
