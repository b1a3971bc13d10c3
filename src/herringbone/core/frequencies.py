"""The range of frequencies that reports and pictures share."""

from typing import Final

HIGHEST: Final = 3000.0
"""End of spectra, and of lists of lines and modes, where nothing else is asked for [Hz]."""
