"""Signatures in lines for people."""

import numpy as np
import pytest

from herringbone.cosim.signature import Answer, Kind, Signature
from herringbone.cosim.signature.text import described


@pytest.mark.parametrize(
    ("kind", "line"),
    [
        (Kind.UNKNOWN, "whether it saves its state is not known"),
        (Kind.BODY, "it does not save its state"),
    ],
)
def test_what_was_never_tried_is_not_known(kind, line):
    """Without a trial, no state was saved."""
    nothing = np.zeros((0, 0))
    signature = Signature((), (), 1e-4, kind, nothing, Answer.UNKNOWN, nothing, restores=None)
    assert line in described(signature)
