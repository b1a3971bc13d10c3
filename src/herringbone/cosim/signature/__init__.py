"""What a part is in the coupling, found by trial steps instead of guessed from what it declares."""

from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.probe import find_signature
from herringbone.cosim.signature.signature import Answer, Kind, Signature

__all__ = ["Answer", "Kind", "Laboratory", "Signature", "find_signature"]
