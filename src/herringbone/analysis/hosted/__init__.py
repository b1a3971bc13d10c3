"""A gearbox as one component for any host: chosen causality, few variables, its own equilibrium."""
