"""Leaner models of a system: what can be left out, and what that changes of what is asked."""
