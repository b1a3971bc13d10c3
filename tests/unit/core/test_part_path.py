"""Paths of parts: any ending that is not ambiguous is understood, the whole path always."""

import re

import pytest

from herringbone.core import ParameterError, StructureError
from herringbone.core.part_path import PartPath, find_part, split_variable

PARTS = [PartPath(p) for p in ("motor", "first.gear", "second.gear", "second.housing", "a.b.gear")]


def test_a_path_knows_its_scope_and_name():
    path = PartPath("gear").inside("gearbox").inside("rig")
    assert path == "rig.gearbox.gear"
    assert (path.scope, path.name) == ("rig.gearbox", "gear")
    assert (PartPath("motor").scope, PartPath("motor").name) == ("", "motor")


@pytest.mark.parametrize(
    ("text", "part", "variable"),
    [
        ("motor.flange.w", "motor", "flange.w"),
        ("housing.left.v_y", "second.housing", "left.v_y"),
        ("second.housing.left.v_y", "second.housing", "left.v_y"),
        ("first.gear.pinion.w", "first.gear", "pinion.w"),
        ("b.gear.pinion.w", "a.b.gear", "pinion.w"),
        ("motor.der(x.y)[1, 2]", "motor", "der(x.y)[1, 2]"),
    ],
)
def test_what_is_understood(text, part, variable):
    assert split_variable(PARTS, text) == (part, variable)
    assert find_part(PARTS, text.removesuffix(f".{variable}")) == part


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("motor", ParameterError, "'motor' must be INSTANCE.VARIABLE"),
        (".w", ParameterError, "must be INSTANCE.VARIABLE"),
        ("motor.", ParameterError, "must be INSTANCE.VARIABLE"),
        ("gear.w", StructureError, "of first.gear or of second.gear or of a.b.gear; write more"),
        ("ear.w", StructureError, "there is no part 'ear'; there are: motor, first.gear,"),
        ("second.motor.w", StructureError, "there is no part 'second'"),
    ],
)
def test_what_is_refused(text, error, said):
    with pytest.raises(error, match=re.escape(said)):
        split_variable(PARTS, text)


def test_a_whole_path_wins_over_endings_of_others():
    parts = [PartPath("gear"), PartPath("first.gear")]
    assert find_part(parts, "gear") == "gear"
    assert split_variable(parts, "gear.w") == ("gear", "w")
    with pytest.raises(StructureError, match=r"'gear' may mean first\.gear, second\.gear"):
        find_part(PARTS[1:3], "gear")
