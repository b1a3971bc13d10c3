"""Accuracy of gears: tolerances by ISO 1328-1, deviations of each tooth, their file."""
