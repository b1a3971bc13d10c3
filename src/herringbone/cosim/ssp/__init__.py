"""SSP 1.0 files: writing and reading systems."""
