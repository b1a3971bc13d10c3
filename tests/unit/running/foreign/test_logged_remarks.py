"""What foreign parts log in a run is a line of the summary."""

import pytest
from support.parts.fakes import FakePart

from herringbone.core import Outcome, OutcomeKind
from herringbone.running.foreign.remarks import remarks_of


class Talking(FakePart):
    """A part that has logged something."""

    def __init__(self, name, *said):
        super().__init__(name)
        self.said = list(said)

    def messages(self):
        return self.said


def remarks(kind, *said):
    parts = [Talking("motor", *said), Talking("own", "nobody asks"), Talking("mute")]
    return remarks_of(parts, ["motor", "mute"], Outcome(kind, 1.0))


@pytest.mark.parametrize(
    ("said", "line"),
    [
        (["getting warm"], "motor says: getting warm"),
        (["a", "b", "c", "d"], "motor says: a; b; and 2 more"),
        (["x" * 300], f"motor says: {'x' * 197}..."),
    ],
)
def test_a_line_for_each_foreign_part_that_says_something(said, line):
    assert remarks(OutcomeKind.COMPLETED, *said) == [line]


def test_the_outcome_tells_what_a_part_says_that_ended_the_run():
    assert remarks(OutcomeKind.PART_FAILED, "solver failed") == []
