"""What docstrings and pages name is there: modules and files move, what speaks of them stays."""

import re
from pathlib import Path

import pytest

from herringbone.core.places.paths import PACKAGE

FILES = sorted(PACKAGE.rglob("*.py"))
ROOMS = sorted(place.name for place in PACKAGE.iterdir() if (place / "__init__.py").is_file())
ROOT = Path(__file__).parents[2]
PAGES = ("CONTRIBUTING.md", "docs/architecture.md", "docs/glossary.md", "tests/campaigns/README.md")
PLACES = (ROOT, PACKAGE, ROOT / "tests")
"""Where their paths begin."""
NOT_HERE = {"..", ".venv", "build"}
"""Outside, or made."""
PATH = re.compile(r"(?<![\w/.])(?:[\w.-]+/)+[\w.-]+")
NAMED = re.compile(rf"`(?:herringbone\.)?((?:{'|'.join(ROOMS)})(?:\.\w+)+)`")


def is_there(name):
    """True for a room, a module, or a word of the last one that the name leads to."""
    place = PACKAGE
    for part in name.split("."):
        if (place / part).is_dir():
            place /= part
            continue
        if place.is_dir() and (place / f"{part}.py").is_file():
            place /= f"{part}.py"
            continue
        sources = [place] if place.is_file() else place.glob("__init__.py*")
        return any(re.search(rf"\b{part}\b", s.read_text(encoding="utf-8")) for s in sources)
    return True


def test_named_modules_exist():
    named = [
        (file.relative_to(PACKAGE).as_posix(), name)
        for file in FILES
        for name in NAMED.findall(file.read_text(encoding="utf-8"))
    ]
    assert len(named) > 50
    assert [(file, name) for file, name in named if not is_there(name)] == []


@pytest.mark.parametrize("page", PAGES)
def test_named_files_exist(page):
    code = re.findall(r"```[^`]*```|`[^`\n]+`", (ROOT / page).read_text(encoding="utf-8"))
    named = {name.rstrip(".") for piece in code for name in PATH.findall(piece)}
    assert [name for name in named if is_ours(name) and not exists(name)] == []


def is_ours(path):
    first = path.split("/")[0]
    return first not in NOT_HERE and exists(first)


def exists(path):
    return any((place / path).exists() for place in PLACES)


@pytest.mark.parametrize("name", ["core.roles", "running.settled", "core.part_path.flat_name"])
def test_a_module_that_has_moved_is_seen(name):
    assert NAMED.findall(f"see `{name}`") == [name]
    assert not is_there(name)
