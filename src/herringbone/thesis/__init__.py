"""The thesis as a report: its studies computed, and each of its sentences with a verdict."""
