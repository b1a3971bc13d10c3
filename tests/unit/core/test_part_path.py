"""Paths of parts: any ending that is not ambiguous is understood, the whole path always."""

import re

import pytest

from herringbone.core import ParameterError, StructureError
from herringbone.core.places.part_path import (
    PartPath,
    endings,
    find_columns,
    find_part,
    flat_name,
    in_groups,
    split_variable,
)

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
    assert split_variable(PARTS, text, "the rig") == (part, variable)
    assert find_part(PARTS, text.removesuffix(f".{variable}"), "the rig") == part


@pytest.mark.parametrize(
    ("text", "error", "said"),
    [
        ("motor", ParameterError, "'motor' must be INSTANCE.VARIABLE"),
        (".w", ParameterError, "must be INSTANCE.VARIABLE"),
        ("motor.", ParameterError, "must be INSTANCE.VARIABLE"),
        (
            "gear.w",
            StructureError,
            "'gear' may mean first.gear or second.gear or a.b.gear; w",
        ),
        ("ear.w", StructureError, "the rig has no part 'ear'; it has: motor, first.gear,"),
        ("second.motor.w", StructureError, "the rig has no part 'second'"),
    ],
)
def test_what_is_refused(text, error, said):
    with pytest.raises(error, match=re.escape(said)):
        split_variable(PARTS, text, "the rig")


def test_a_whole_path_wins_over_endings_of_others():
    parts = [PartPath("gear"), PartPath("first.gear")]
    assert find_part(parts, "gear", "it") == "gear"
    assert split_variable(parts, "gear.w", "it") == ("gear", "w")
    with pytest.raises(StructureError, match=r"it: 'gear' may mean first\.gear or second\.gear"):
        find_part(PARTS[1:3], "gear", "it")


def test_names_of_a_column():
    assert endings(PARTS, "motor.flange.w") == ("motor.flange.w",)
    assert endings(PARTS, "a.b.gear.x.y") == ("a.b.gear.x.y", "b.gear.x.y", "gear.x.y")
    assert endings(PARTS, "stranger.y") == ("stranger.y",)


def test_groups_of_columns():
    """By any ending of the part; a group of which no column is there is none."""
    columns = ["motor.w", "first.gear.w", "second.gear.w", "second.gear.f"]
    groups = {"speeds": ["gear.w", "motor.*"], "forces": ["second.*.f"], "other": ["ear.w", "w"]}
    assert in_groups(PARTS, columns, groups) == {
        "speeds": ["motor.w", "first.gear.w", "second.gear.w"],
        "forces": ["second.gear.f"],
    }


def test_a_flat_name_has_no_dots():
    assert flat_name(PartPath("a.b_c.d")) == "a__b_c__d"


def test_a_variable_may_belong_to_two_parts():
    parts = [PartPath("x.gear"), PartPath("y.gear.pinion")]
    with pytest.raises(StructureError, match=r"a variable of gear or of gear\.pinion; write more"):
        split_variable(parts, "gear.pinion.w", "it")
    assert split_variable(parts, "x.gear.pinion.w", "it") == ("x.gear", "pinion.w")


COLUMNS = (
    "a.b.gear.pinion.w", "a.b.gear.wheel.w", "motor.torque", "motor.flange.w", "gear.motor.torque",
)  # fmt: skip


@pytest.mark.parametrize(
    ("pattern", "meant"),
    [
        ("gear.pinion.w", ["a.b.gear.pinion.w"]),
        ("gear.*.w", ["a.b.gear.pinion.w", "a.b.gear.wheel.w"]),
        ("motor.torque", ["motor.torque"]),
        ("pinion.w", ["a.b.gear.pinion.w"]),
        ("torque", []),
        ("inion.w", []),
    ],
)
def test_what_a_pattern_means(pattern, meant):
    """Whole variables of parts first, then endings of their names, which begin after a dot."""
    assert find_columns(PARTS, COLUMNS, [pattern]) == {pattern: meant}
    assert in_groups(PARTS, COLUMNS, {"group": [pattern]}) == ({"group": meant} if meant else {})
