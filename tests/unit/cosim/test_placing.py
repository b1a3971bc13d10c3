"""Where parts stand in a picture."""

from herringbone.cosim.structure.placing import places


def test_a_line_stands_in_a_row_from_its_longer_end():
    found = places(["b", "a", "c"], [("a", "b"), ("b", "c"), ("c", "b")])
    assert found == {"a": (0.0, 0.0), "b": (1.0, 0.0), "c": (2.0, 0.0)}


def test_branches_stand_below_each_other_and_no_two_parts_at_one_place():
    joined = [("m", "s"), ("s", "x1"), ("s", "x2"), ("x1", "g1"), ("x2", "g2"), ("g1", "l"),
              ("g2", "l")]  # fmt: skip
    names = ["g1", "g2", "m", "s", "x1", "x2", "l", "alone"]
    found = places(names, joined)
    assert [found[name][0] for name in ("m", "s", "x1", "x2", "g1", "l")] == [0, 1, 2, 2, 3, 4]
    assert found["m"][1] == found["s"][1] == found["l"][1] == 0.5
    assert {found["g1"][1], found["g2"][1]} == {0.0, 1.0}
    assert found["alone"] == (0.0, 2.0)
    assert len(set(found.values())) == len(names)
