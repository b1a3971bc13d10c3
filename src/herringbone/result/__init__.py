"""The result of a run: the table of recorded outputs, and how it was computed."""
