"""Step sizes of a system, tried and judged."""
