"""What reduced housings are made for if nothing else is asked; help texts show it."""

from typing import Final

BAND: Final = 2000.0
"""Highest frequency of use [Hz]."""
TOLERANCE: Final = 0.05
"""Error of the receptance at the seats, over the static compliance."""
