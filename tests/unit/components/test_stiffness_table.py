"""The reader of stiffness tables: good tables, and the message for each kind of bad one."""

import re

import numpy as np
import pytest
from support.gearing.gear_mesh import write_table

from herringbone.components.resources.stiffness_table import mesh_harmonics, read_stiffness_table
from herringbone.core import ResourceError

UNITS = "# units: load N, phase 1, stiffness N/m"


@pytest.fixture
def lines(tmp_path):
    """A good table (3 loads x 8 phases on both sides) as lines, to be spoiled."""
    file = write_table(tmp_path / "good.csv", stiffness, loads=(10.0, 100.0, 1000.0))
    return file.read_text().splitlines()


def stiffness(phase: float, load: float) -> float:
    return 1e9 + 1e7 * phase + 1e4 * load


@pytest.fixture
def message(tmp_path):
    """The message with which a table of these lines is refused."""

    def read(lines: list[str]) -> str:
        file = tmp_path / "bad.csv"
        file.write_text("\n".join(lines) + "\n")
        with pytest.raises(ResourceError) as caught:
            read_stiffness_table(file)
        assert "bad.csv" in str(caught.value)
        return str(caught.value)

    return read


def replace(lines: list[str], old: str, new: str) -> list[str]:
    assert any(old in line for line in lines)
    return [line.replace(old, new) for line in lines]


def rows_of(lines: list[str], load: float, phase: float) -> list[int]:
    return [i for i, line in enumerate(lines) if f",{load!r},{phase!r}," in line]


def check(table) -> None:
    for loads, grid in table:
        np.testing.assert_array_equal(loads, [10.0, 100.0, 1000.0])
        expected = [[stiffness(p / 8, f) for p in range(8)] for f in loads]
        np.testing.assert_array_equal(grid, expected)


def test_good_table(tmp_path, lines):
    check(read_stiffness_table(tmp_path / "good.csv"))


def test_order_of_rows_comments_and_blank_lines_do_not_matter(tmp_path, lines):
    head, rows = lines[:2], lines[2:]
    np.random.default_rng(0).shuffle(rows)
    file = tmp_path / "shuffled.csv"
    file.write_text("\n".join([head[0], "# a remark", "", head[1], *rows[:5], "# more", *rows[5:]]))
    check(read_stiffness_table(file))


def test_repeated_end_point_is_dropped(tmp_path, lines):
    ends = [
        f"{s},{f!r},1.0,{stiffness(0, f)!r}" for s in ("left", "right") for f in (10.0, 1e2, 1e3)
    ]
    file = tmp_path / "closed.csv"
    file.write_text("\n".join(lines + ends))
    check(read_stiffness_table(file))


def test_not_periodic(lines, message):
    ends = [
        f"{s},{f!r},1.0,{stiffness(1, f)!r}" for s in ("left", "right") for f in (10.0, 1e2, 1e3)
    ]
    text = message(lines + ends)
    assert "side left: not periodic" in text
    assert "phase 1 differs from phase 0 by 1 %" in text  # 1e7 of 1e9


def test_phases_that_do_not_start_at_zero(lines, message):
    shifted = [line.replace(",0.", ",0.0") if "," in line else line for line in lines]
    text = message(shifted)
    assert "phases must be equidistant from 0" in text
    assert "from 0 to 0.0875" in text


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "", "1,0e9".replace(",", ";"), "abc"])
def test_value_that_is_no_finite_number(lines, message, value):
    lines[5] = lines[5].rsplit(",", 1)[0] + f",{value}"
    text = message(lines)
    assert "line 6: stiffness" in text
    assert f"'{value}' is not a finite number" in text


@pytest.mark.parametrize("value", ["-1e9", "0"])
def test_stiffness_must_be_positive(lines, message, value):
    lines[5] = lines[5].rsplit(",", 1)[0] + f",{value}"
    text = message(lines)
    assert f"stiffness {float(value):g} N/m at load 10 N, phase 0.375 must be positive" in text


def test_load_must_not_be_negative(lines, message):
    assert "load -10 N must not be negative" in message(replace(lines, ",10.0,", ",-10.0,"))


def test_zero_load_and_zero_stiffness_there(tmp_path, lines):
    """Unloaded flanks may have a gap: secant 0 at load 0; below zero it is refused."""
    file = tmp_path / "zero.csv"
    changed = [
        re.sub(r",10\.0,(.*),.*", r",0.0,\1,0.0", line) if ",10.0," in line else line
        for line in lines
    ]
    file.write_text("\n".join(changed))
    for loads, grid in read_stiffness_table(file):
        assert loads[0] == 0.0
        assert not grid[0].any()
    file.write_text("\n".join(changed).replace(",0.0,0.125,0.0", ",0.0,0.125,-1.0"))
    with pytest.raises(ResourceError, match=r"stiffness -1 N/m at load 0 N, phase 0\.125 "):
        read_stiffness_table(file)


def test_wrong_unit(lines, message):
    text = message(replace(lines, "stiffness N/m", "stiffness N/mm"))
    assert "column 'stiffness' has unit 'N/mm'" in text
    assert "it takes N/m" in text


def test_unit_missing(lines, message):
    text = message(replace(lines, "load N, ", ""))
    assert "column 'load' has unit 'none'" in text


def test_units_line_missing(lines, message):
    assert "the first line must be '# units:" in message(lines[1:])


def test_empty_file(message):
    assert "the first line must be '# units:" in message([])


def test_header_without_rows(lines, message):
    assert "it has no rows" in message(lines[:2])


def test_missing_column(lines, message):
    text = message([lines[0], *[",".join(line.split(",")[:3]) for line in lines[1:]]])
    assert "column stiffness is missing" in text
    assert "it has side, load, phase" in text


def test_unknown_column(lines, message):
    text = message([lines[0], lines[1] + ",torque", *[line + ",1" for line in lines[2:]]])
    assert "column torque is unknown" in text


def test_short_row(lines, message):
    lines[4] = "left,10.0,0.25"
    assert "line 5: 3 fields, 4 expected" in message(lines)


def test_one_side_missing(lines, message):
    text = message([line for line in lines if not line.startswith("right")])
    assert "side right: 0 rows are no full grid" in text


def test_hole_in_the_grid(lines, message):
    text = message([line for i, line in enumerate(lines) if i != 7])
    assert "side left: 23 rows are no full grid of 3 loads x 8 phases" in text


def test_repeated_point_in_place_of_another(lines, message):
    """As many rows as a full grid has, but one point stands twice and one is missing."""
    lines[7] = lines[6]
    assert "no full grid" in message(lines)


def test_single_load(lines, message):
    text = message(lines[:2] + [line for line in lines if ",10.0," in line])
    assert "at least 2 x 4" in text


def test_force_law_that_is_not_monotone(lines, message):
    [left, _] = rows_of(lines, 100.0, 0.25)
    lines[left] = "left,100.0,0.25,5e7"  # 2 um; 1000 N has 1 um
    text = message(lines)
    assert "deflection does not rise from load 100 N to 1000 N at phase 0.25" in text


@pytest.mark.parametrize(("loads", "phases"), [(65, 8), (3, 129)])
def test_capacity(tmp_path, loads, phases):
    many = tuple(float(10 * (i + 1)) for i in range(loads))
    file = write_table(tmp_path / "large.csv", lambda p, f: 1e9, many, phases)
    with pytest.raises(ResourceError, match=f"{loads} loads x {phases} phases; at most 64 x 128"):
        read_stiffness_table(file)


def test_file_missing(tmp_path):
    with pytest.raises(ResourceError, match=r"cannot read .*nothing\.csv"):
        read_stiffness_table(tmp_path / "nothing.csv")


def test_file_that_is_no_text(tmp_path):
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(ResourceError, match=r"cannot read .*binary\.csv"):
        read_stiffness_table(tmp_path / "binary.csv")


@pytest.mark.parametrize("count", [3, 4, 8])
def test_harmonics_of_few_phases(count):
    """Half of an even number of phases has no mirror image."""
    phases = np.arange(count) / count
    highest = count // 2
    wave = 2.0 + 0.3 * np.cos(2.0 * np.pi * highest * phases)
    assert mesh_harmonics(wave)[highest - 1] == pytest.approx(0.3)
