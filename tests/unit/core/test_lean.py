"""What a leaner model leaves out: what is more, both together, and what is known besides."""

import pytest

from herringbone.core.lean import WHOLE, Lean
from herringbone.scenes import Model

ALL = Lean(("a.q",), ("b",), ("c",), ("d",), (("e", 8),))


def test_what_is_left_out_is_told_by_kind():
    assert (bool(WHOLE), WHOLE.only_held, WHOLE.parts) == (False, True, ())
    assert (bool(Lean("a.q")), Lean("a.q").only_held) == (True, True)
    assert (bool(ALL), ALL.only_held) == (True, False)
    assert (ALL.parts, ALL.straight) == (("b", "c", "d", "e"), ("c", "d"))


@pytest.mark.parametrize(
    ("more", "less", "at_least"),
    [
        (ALL, WHOLE, True),
        (ALL, ALL, True),
        (WHOLE, ALL, False),
        (Lean(("x", "y")), Lean(("y",)), True),
        (Lean(("x",)), Lean(one_way=("x",)), False),
        (Lean(harmonics={"e": 4}), Lean(harmonics={"e": 8}), True),
        (Lean(harmonics={"e": 8}), Lean(harmonics={"e": 4}), False),
        (Lean(harmonics={"e": 4}), Lean(harmonics={"f": 8}), False),
    ],
)
def test_one_leaves_out_at_least_what_another_does(more, less, at_least):
    assert (more >= less) == at_least


def test_both_together_leave_out_what_either_does():
    found = Lean(("x", "y"), frozen=("c",)) | Lean(("y", "z"), linear=("d",))
    assert found == Lean(("x", "y", "z"), frozen=("c",), linear=("d",))
    assert (ALL | WHOLE, WHOLE | ALL) == (ALL, ALL)


def test_what_is_known_of_a_model_is_no_part_of_what_it_leaves_out():
    """Else two models that leave out the same would be solved, and priced, twice."""
    known = Model(**vars(ALL), error=0.01, speed=9.0, torque=(0.0, 10.0))
    assert known.left_out == ALL
    assert type(known.left_out) is Lean
    assert hash(known.left_out) == hash(ALL)
    assert Model().left_out == WHOLE
