"""Parts that hold their inputs, made to take and give polynomial signals."""

from herringbone.cosim.nodal.part import NodalPart

__all__ = ["NodalPart"]
