"""Python FMUs: the slave that pythonfmu calls, and how they are packed and built."""
