"""Pages of the shipped systems: what is read from their files; computed steps are not, here."""

import pytest

from herringbone.commands.generate import system_pages
from herringbone.core.places.paths import systems_folder
from herringbone.running.loading import load_scene, load_system

NAMES = sorted(file.parent.name for file in systems_folder().glob("*/system.toml"))


@pytest.mark.parametrize("name", NAMES)
def test_page_tells_the_system_and_its_scenes(name):
    system, folder = load_system(name)
    text = (folder / system_pages.PAGE).read_text(encoding="utf-8")
    scenes = [load_scene(folder, f.stem) for f in sorted((folder / "scenes").glob("*.toml"))]
    for lines in (
        [f"# {name}", "", f"{system.description}."],
        system_pages._scenes(name, scenes),
        system_pages._parts(system, folder),
    ):
        assert "\n".join(lines) in text, "python -m herringbone.commands.generate systems"
    assert text.count("| `li:degree=3,iterations=1` |") >= len(system_pages._TOLERANCES)
    assert (folder / system_pages.PICTURE).read_bytes().startswith(b"\x89PNG")
