"""What is said of a run: its result, its figures, its summary."""
