"""What the trials of a slow part cost, in a line before they are made; no clock decides."""

from herringbone.core.process.activity import lasting, tell
from herringbone.core.wording import option
from herringbone.cosim.signature.laboratory import Laboratory
from herringbone.cosim.signature.memory import LONG

PATIENCE = 10.0
"""Time [s] up to which trials need not be announced."""
_ALONE, _EACH = 150, 200
"""Steps of the trials that find a signature: besides, and for each input."""


def usual_steps(inputs: int) -> int:
    """Steps, about, of the trials that find the signature of a part that all inputs move."""
    return _ALONE + _EACH * inputs


def tell_cost(lab: Laboratory, name: str) -> None:
    """Say before the trials for the signature of a slow part what they take.

    Args:
        lab: of the part, entered.
        name: of the part.
    """
    usual = usual_steps(len(lab.inputs))
    if usual * lab.seconds > PATIENCE:
        tell(
            f"{name} is slow, {lab.seconds:.2g} s a step: finding out what it is in a coupling "
            f"takes about {usual} steps, {lasting(usual * lab.seconds)}, and again {LONG} for each "
            f"time that inputs seem to do nothing; 'run' with {option('probe', False)} makes none, "
            "goes by what it declares, and holds inputs whose use that leaves open"
        )
