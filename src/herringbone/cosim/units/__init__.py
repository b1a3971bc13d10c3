"""Parts whose variables have other than SI units, in SI units."""

from herringbone.cosim.units.part import SiPart, in_si_units
from herringbone.cosim.units.record import in_own_units, own_unit

__all__ = ["SiPart", "in_own_units", "in_si_units", "own_unit"]
