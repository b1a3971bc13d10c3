"""The rows of a run: what is recorded, and where it goes."""
