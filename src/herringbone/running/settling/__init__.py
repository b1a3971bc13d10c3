"""A start in equilibrium beside foreign FMUs: what these settle to, and how they come there."""
