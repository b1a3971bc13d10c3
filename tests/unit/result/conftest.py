"""Fixtures of the tests of results."""

from dataclasses import replace

import pytest
from support.result import make_result

from herringbone.core import Outcome, OutcomeKind


@pytest.fixture(scope="session")
def rig():
    """Every field filled, so that none is lost unseen."""
    result = make_result(t_end=0.02)
    outcome = Outcome(OutcomeKind.COMPLETED, 0.02, "a.b", "a message")
    info = replace(result.info, notes=("one", "two"), slow={"drive_motor": 3})
    return replace(result, outcome=outcome, info=info, error={"bearing_force": 0.1})
