"""Periodic steady states: what a system comes to at a constant operating point."""
