"""What follows from how a run ended: whether its figures count, and the exit code."""

import pytest

from herringbone.core import EXIT_CODES, Outcome, OutcomeKind

K = OutcomeKind
EXPECTED = {  # completed, reached its end, unstable, exit code
    K.COMPLETED: (True, True, False, 0),
    K.PART_LOST_AT_END: (False, True, False, 1),
    K.PART_MAKES_ENERGY: (False, True, False, 1),
    K.WITH_NAN: (False, True, False, 1),
    K.ENDED: (False, False, False, 0),
    K.INTERRUPTED: (False, False, False, 130),
    K.UNSTABLE: (False, True, True, 1),
    K.DIVERGED: (False, False, True, 1),
    K.PART_FAILED: (False, False, False, 1),
    K.COUPLING_FAILED: (False, False, False, 1),
    K.STEP_LIMIT: (False, False, False, 1),
}


@pytest.mark.parametrize("kind", K)
def test_what_follows_from_how_a_run_ended(kind):
    """A part that is lost when all is computed, or makes energy, costs no figure; only an end that
    was asked for is a success besides completion; 130 is the shell's code of Ctrl-C, 128 + SIGINT.
    """
    found = Outcome(kind, 0.5)
    told = found.completed, found.reached_end, found.unstable, EXIT_CODES[kind]
    assert told == EXPECTED[kind]
