"""The command `housing`, and what `check --as housing` shows."""
