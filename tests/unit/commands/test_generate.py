"""The command that makes what is generated: what it calls different, and that it writes nothing."""

import subprocess

import pytest

from herringbone.commands.generate import __main__ as command
from herringbone.commands.generate.difference import difference
from herringbone.commands.generate.items import ITEMS, PICTURES, Item, clone

TABLE = "# units: x m\nname,x\na,1.0\nb,2.0\n"


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (TABLE, ""),
        (TABLE.replace("1.0", "1.000001"), ""),
        (TABLE.replace("1.0", "1.00001"), "1 numbers differ by more than rounding"),
        (TABLE.replace("b,", "c,"), "other words"),
        (TABLE + "c,3.0\n", "another table"),
    ],
)
def test_tables_differ_by_more_than_rounding(tmp_path, made, said):
    """Numbers may differ by 1e-6 of the largest one of their column."""
    old, new = tmp_path / "old.csv", tmp_path / "new.csv"
    old.write_text(TABLE)
    new.write_text(made)
    assert difference(old, new) == said


def test_texts_differ_by_any_character(tmp_path):
    old, new = tmp_path / "old.md", tmp_path / "new.md"
    new.write_text("1.0")
    assert difference(old, new) == "missing"
    old.write_text("1.00")
    assert difference(old, new) == "differs"


def test_check_says_what_differs_and_writes_nothing(tmp_path, monkeypatch, capfd):
    """A generator that appends a line to a README, and writes a file."""
    code = "from herringbone.core.places.paths import component_folder as f\n"
    script = tmp_path / "generator.py"
    monkeypatch.setitem(ITEMS, "made", Item("two files", "no time", (str(script),)))
    readme = clone() / "fmus" / "gear_mesh" / "README.md"
    before = readme.read_text(encoding="utf-8")
    script.write_text(code + "f('gear_mesh').joinpath('README.md').open('a').write('more')\n"
                      "f('gear_mesh').joinpath('new.csv').write_text('1')\n")  # fmt: skip
    assert command.main(["made", "--check"]) == 1
    assert capfd.readouterr().out.splitlines() == [
        "fmus/gear_mesh/README.md: differs",
        "fmus/gear_mesh/new.csv: missing",
    ]
    assert readme.read_text(encoding="utf-8") == before


def test_a_generator_that_fails_is_told(monkeypatch, capfd):
    monkeypatch.setitem(ITEMS, "broken", Item("", "", ("-m no_such_module",)))
    assert command.main(["broken"]) == 2
    assert "python -m no_such_module ended with exit code 1" in capfd.readouterr().err


def test_unknown_names_are_refused(capsys):
    with pytest.raises(SystemExit):
        command.main(["tables"])
    assert (
        "there is no tables; there are: gear-pair, gear-table, housing" in capsys.readouterr().err
    )


def test_every_committed_picture_and_chart_is_made():
    made = {str(PICTURES / name) for item in ITEMS.values() for name in item.pictures}
    listed = subprocess.run(
        ["git", "-C", str(clone()), "ls-files", str(PICTURES)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if listed.returncode:
        pytest.skip("not a git clone")
    assert set(listed.stdout.split()) == made
