"""What is kept of an entry stands for all that it depends on."""

import ast

import pytest

from herringbone.core.caching.keys import _MODULES, _closure, kernels_key
from herringbone.core.places.paths import CACHE_VARIABLE, PACKAGE
from herringbone.thesis import store
from herringbone.thesis.registry import ENTRIES

FILES = sorted((PACKAGE / "thesis").rglob("*.py"))
DRAWING = "herringbone.plotting"


@pytest.mark.parametrize("name", ENTRIES)
def test_keys_have_what_computes_and_no_pictures(name):
    module = ENTRIES[name].compute.__module__
    found = _closure([module], DRAWING)
    assert module in found
    assert any(other.split(".")[1] in {"gears", "analysis", "housing"} for other in found)
    assert not any(other.startswith(DRAWING) for other in found)


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.relative_to(PACKAGE).as_posix())
def test_entries_import_modules_by_name(file):
    """`import herringbone as hb` loads names lazily: what they depend on would not be seen."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            assert all(alias.name != "herringbone" for alias in node.names), node.lineno
        elif isinstance(node, ast.ImportFrom) and node.module == "herringbone":
            assert all(f"herringbone.{a.name}" in _MODULES for a in node.names), node.lineno


def test_keys_follow_data_and_code(tmp_path, monkeypatch):
    """A digit of a shipped file, or another module, is another key; a picture is not."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    entry = ENTRIES["table_2_1"]
    data = tmp_path / "systems"
    data.mkdir()
    monkeypatch.setattr(store, "systems_folder", lambda: data)
    keys = []
    for text in ("a = 1", "a = 2"):
        (data / "system.toml").write_text(text)
        store._surroundings.cache_clear()
        keys.append(store.entry_key(entry))
    store._surroundings.cache_clear()
    assert keys[0] != keys[1]
    stiffness = "herringbone.gears.stiffness.load_sharing"
    assert kernels_key(stiffness) != kernels_key("herringbone.gears.stiffness.slices")
    plot = "herringbone.plotting.style"
    assert kernels_key(stiffness, plot, without=DRAWING) == kernels_key(stiffness, without=DRAWING)
