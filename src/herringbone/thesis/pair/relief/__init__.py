"""Tip relief: what it does to stiffness, transmission error and bearing forces."""
