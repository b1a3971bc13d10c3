"""Keys of what is cached: syntax, the closure of imports, digests of files."""

import importlib
import sys

from herringbone.core.caching import keys as cache_keys
from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.syntax import syntax_of


def test_syntax_leaves_out_comments_docstrings_and_layout():
    plain = syntax_of("import a\nx = 1\ndef f(y):\n    return y\n")
    said = '"""Says."""\nimport a\n\nx = 1  # one\n"""What x is."""\n'
    said += 'def f(y):\n    """Doc."""\n    return (y)\n'
    assert syntax_of(said) == plain
    assert syntax_of("import a\nx = 2\ndef f(y):\n    return y\n").digest != plain.digest


def test_closure_holds_what_is_imported_and_no_more():
    found = cache_keys._closure(["herringbone.components.gear_mesh"])
    assert {"herringbone.kernels.compiling.jit", "herringbone.kernels.elementary"} <= found
    assert "herringbone.components.drive_motor" not in found
    assert not any(name.startswith("herringbone.cosim") for name in found)


def test_what_is_made_of_a_system_depends_on_all_components():
    """The registry imports them by name; else a system would keep the code of a changed one."""
    found = cache_keys._closure(["herringbone.analysis.twin.composite"])
    for name in ("gear_mesh.contact", "drive_motor", "modal_housing"):
        assert f"herringbone.components.{name}" in found


def test_a_stored_file_is_known_by_its_digest(tmp_path, caplog):
    file = tmp_path / "kind" / "thing.bin"
    assert not is_stored(file)
    assert caplog.text == ""
    store(file, b"content")
    assert is_stored(file)
    for damaged in (b"", b"contenu"):
        file.write_bytes(damaged)
        assert not is_stored(file)
    assert "thing.bin is damaged; it is made anew" in caplog.text


def test_a_generated_module_depends_on_what_those_import_that_it_imports(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)

    def key(of):
        (tmp_path / "herringbone_inside.py").write_text(f"import {of}\n")
        outer = tmp_path / "herringbone_outer.py"
        outer.write_text("import herringbone_inside\n")
        for name in ("herringbone_inside", "herringbone_outer"):
            monkeypatch.delitem(sys.modules, name, raising=False)
        importlib.invalidate_caches()
        importlib.import_module("herringbone_outer")
        cache_keys.module_key.cache_clear()
        return cache_keys.module_key("herringbone_outer", str(outer))

    found = key("herringbone.kernels.elementary")
    assert key("herringbone.kernels.derivatives.dual_expressions") != found
    assert key("herringbone.kernels.elementary") == found
