"""Gear pairs of a system that is run: their values, tables, phases and flanks."""
