"""What computes a point of a study, and the figures that stand in its row."""
