"""Vibration that was measured: files of others, and prediction beside them."""
