"""Macro steps in which outputs of foreign parts jump, taken in pieces."""
