"""A system at an operating point: set points, steady states, natural modes, leaner models."""
