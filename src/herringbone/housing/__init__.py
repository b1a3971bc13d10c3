"""Housings off line: finite elements, reduction, the neutral format, importers."""
