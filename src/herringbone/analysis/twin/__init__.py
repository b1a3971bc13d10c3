"""A system without coupling: the monolithic twin, and the system as one component."""
