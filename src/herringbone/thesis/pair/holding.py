"""How the pinion may be held axially; the thesis does not say."""

from herringbone.gears.stiffness.load_sharing import RIGID

MICROMETRES = (0.0, 10.0, 20.0)
"""Symmetry deviations f_A of the thesis [um]."""
TORQUES = (200.0, 2000.0)
"""Of the pinion [N m]: that of the thesis' dynamics, and one near that of its mesh stiffness."""
HELD = 1e8
"""Axial stiffness of the pinion on an ordinary bearing [N/m]."""
HOLDINGS = {"floating": 0.0, "held by 10⁸ N/m": HELD, "rigid": RIGID}
"""Axial stiffness of the pinion [N/m], by what it is called."""
