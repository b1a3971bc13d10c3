"""The speed-accuracy chart of a system's scene."""
