"""Kernels are cached by what they are compiled from; damaged files are compiled again.

This leans on the inside of numba: it is run with every minor version that pyproject admits.
"""

import importlib.util
import os
import subprocess
import sys
from importlib.metadata import requires, version

import numpy as np
import pytest

from herringbone.core.caching import keys as cache_keys
from herringbone.kernels.compiling.cache import KernelFiles, _CheckedData
from herringbone.kernels.compiling.linking import Piece, Whole

SOURCE = """
from herringbone.kernels.elementary import sine
from herringbone.kernels.compiling.jit import kernel


@kernel
def inner_part(x: float) -> float:
    return 2.0 * sine(x)


@kernel
def whole(x: float) -> float:
    return inner_part(x) + 1.0
"""
LONG = "".join(
    f"        value = max(value, math.sqrt(abs(value) * x + {i}.0) * 1e-9) + min(x, 0.0)\n"
    for i in range(100)
)
"""Lines of a function that no compiler puts into three callers."""
FACTORY = f"""
import math

import numpy as np
from herringbone.kernels.compiling.jit import inner, kernel


def factory(factor: float):
    @inner("same")
    def scaled(x: float) -> float:
        value = factor * x + np.floor(x)
{LONG}        return value

    return scaled
"""
KEPT = """
from herringbone.kernels.compiling.jit import inner, inner_kept


def factory(factor: float):
    @inner("same")
    def added(x: float) -> float:
        return x + factor

    @inner_kept("same", f"{factor}")
    def scaled(x: float) -> float:
        return factor * added(x)

    return scaled
"""
CALLER = """
from closures import factory
from herringbone.kernels.compiling.jit import kernel

part = factory({factor})


@kernel
def {name}(x: float) -> float:
    return part(x) + part(x + 1.0) + part(x + 2.0)
"""
CONSTANTS = """
import numpy as np
from herringbone.kernels.compiling.jit import kernel


@kernel
def entry(b: np.ndarray, side: int, part: int) -> float:
    return b[2 * side + part]


@kernel
def whole(b: np.ndarray) -> float:
    return entry(b, 0, 0) + 10.0 * entry(b, 0, 1) + 100.0 * entry(b, 1, 0) + entry(b, 1, b.size - 3)
"""


def in_process(folder, code, cache):
    """What a process prints that finds modules in a folder."""
    environment = {
        "PATH": "/usr/bin:/bin",
        "PYTHONPATH": str(folder),
        "HERRINGBONE_CACHE": str(cache),
    }
    run = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment
    )
    return run.stdout.strip()


def load(file, text):
    """A module of a file that is written."""
    file.write_text(text)
    spec = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache folder."""
    monkeypatch.setenv("HERRINGBONE_CACHE", str(tmp_path / "cache"))
    cache_keys.module_key.cache_clear()
    yield tmp_path / "cache"
    cache_keys.module_key.cache_clear()


def compiled_again(tmp_path, text):
    """Calls the kernel of an edited module, as a new process would; True if it was compiled."""
    cache_keys.module_key.cache_clear()
    module = load(tmp_path / "edited.py", text)
    value = module.whole(0.5)
    assert value == pytest.approx(1.958851077208406, abs=1e-15) or "3.0" in text
    return not module.whole.stats.cache_hits


def test_the_installed_numba_is_one_that_is_admitted():
    (asked,) = (r for r in requires("herringbone") if r.startswith("numba"))
    assert asked in {"numba<0.70,>=0.68", "numba>=0.68,<0.70"}
    assert tuple(map(int, version("numba").split(".")[:2])) in {(0, 68), (0, 69)}


def test_a_comment_does_not_compile_and_code_does(cache, tmp_path):
    assert compiled_again(tmp_path, SOURCE)
    assert not compiled_again(tmp_path, SOURCE)
    commented = "# a comment\n" + SOURCE.replace("float:\n", 'float:\n    """Doc."""\n')
    assert not compiled_again(tmp_path, commented)
    assert compiled_again(tmp_path, SOURCE.replace("2.0", "3.0"))


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("left", [0, 60])
def test_damaged_kernels_are_compiled_again(cache, tmp_path, caplog, suffix, left):
    assert compiled_again(tmp_path, SOURCE)
    for file in cache.rglob(f"*.{suffix}"):
        file.write_bytes(file.read_bytes()[:left])
    assert compiled_again(tmp_path, SOURCE)
    assert "cached kernel" in caplog.text
    assert "it is compiled again" in caplog.text
    assert not compiled_again(tmp_path, SOURCE)


def test_pieces_have_no_machine_code_and_are_their_wholes_own(cache, tmp_path, monkeypatch):
    (tmp_path / "closures.py").write_text(FACTORY)
    monkeypatch.syspath_prepend(tmp_path)
    module = load(tmp_path / "caller.py", CALLER.format(factor=2.0, name="whole"))
    module.whole(0.5)
    (whole,) = module.whole.overloads.values()
    (piece,) = module.part.piece.overloads.values()
    assert isinstance(whole.library, Whole)
    assert isinstance(piece.library, Piece)
    assert piece.library.get_pointer_to_function(piece.fndesc.mangled_name) == 0
    assert not module.part.overloads
    defined = [f for f in whole.library._final_module.functions if not f.is_declaration]
    found = [f.linkage.name for f in defined if "scaled" in f.name]
    assert found == ["internal"]  # it is there, as it is too long to become a part of its caller


INLINED = """
from herringbone.kernels.compiling.jit import inlined, kernel


@kernel
def called(x: float) -> float:
    return 2.0 * x


@inlined
def calling(x: float) -> float:
    return called(x) + 1.0


@kernel
def whole(x: float) -> float:
    return calling(x) + 1.0
"""


def test_what_an_inlined_kernel_calls_is_not_inlined_for_that(cache, tmp_path):
    """numba lets it inherit that from whoever is compiled: code would go by who is first."""
    module = load(tmp_path / "inlined.py", INLINED)
    assert module.whole(1.0) == 4.0
    forced = {}
    for name in ("called", "calling"):
        (piece,) = getattr(module, name).piece.overloads.values()
        own = piece.library.code.get_function(piece.fndesc.mangled_name)
        forced[name] = any(b"alwaysinline" in attribute for attribute in own.attributes)
    assert forced == {"called": False, "calling": True}


def test_a_piece_is_compiled_once_whatever_constants_it_is_called_with(cache, tmp_path):
    module = load(tmp_path / "constants.py", CONSTANTS)
    assert module.whole(np.array([1.0, 2.0, 3.0, 4.0])) == 1.0 + 20.0 + 300.0 + 4.0
    assert len(module.entry.piece.overloads) == 1


def test_caches_of_two_processes_agree_in_a_third(tmp_path):
    """Closures of one factory have the same symbol in both: numba counts them by process."""
    (tmp_path / "closures.py").write_text(FACTORY)
    (tmp_path / "first.py").write_text(CALLER.format(factor=2.0, name="one"))
    (tmp_path / "second.py").write_text(CALLER.format(factor=5.0, name="two"))
    cache = tmp_path / "cache"
    in_process(tmp_path, "import first; first.one(0.5)", cache)
    in_process(tmp_path, "import second; second.two(0.5)", cache)
    code = (
        "import first, second; print(first.one(0.5), second.two(0.5), "
        "sum(first.one.stats.cache_hits.values()), sum(second.two.stats.cache_hits.values()))"
    )
    one, two = (sum(factor * (0.5 + i) + i for i in range(3)) for factor in (2.0, 5.0))
    assert in_process(tmp_path, code, cache) == f"{one} {two} 1 1"


def test_two_processes_that_save_at_once_do_not_take_each_others_code(tmp_path, monkeypatch):
    """Both have read an empty index; one saves while the other one does."""
    one, other = (_CheckedData(str(tmp_path), "kernel", "stamp") for _ in range(2))
    save_data = one._save_data

    def save_data_late(name, data):
        other.save(("float64",), ("code for float64",))
        save_data(name, data)

    monkeypatch.setattr(one, "_save_data", save_data_late)
    monkeypatch.setattr(other, "_load_index", dict)
    one.save(("int64",), ("code for int64",))
    reader = _CheckedData(str(tmp_path), "kernel", "stamp")
    assert reader.load(("int64",)) in {("code for int64",), None}
    assert reader.load(("float64",)) in {("code for float64",), None}


@pytest.mark.skipif(os.name == "nt", reason="modes of POSIX")
def test_kernels_are_found_again_whatever_the_umask(cache):
    """What others can write is not loaded."""
    files = KernelFiles(in_process)
    before = os.umask(0)
    try:
        files.locator.ensure_cache_path()
        _CheckedData(files.locator.get_cache_path(), "kernel", "stamp").save(("int64",), ("code",))
    finally:
        os.umask(before)
    reader = _CheckedData(files.locator.get_cache_path(), "kernel", "stamp")
    assert reader.load(("int64",)) == ("code",)
    assert {place.stat().st_mode & 0o077 for place in cache.rglob("*")} == {0}


def test_what_a_factory_makes_is_kept_by_what_it_was_given(tmp_path):
    """In another process, too; there is no other kernel of the same name beside it."""
    (tmp_path / "kept.py").write_text(KEPT)
    code = (
        "from kept import factory\n"
        "made = [factory(2.0), factory(3.0)]\n"
        "print([kernel(1.0) for kernel in made], factory(3.0) is made[1],\n"
        "      [sum(kernel.stats.cache_hits.values()) for kernel in made])"
    )
    found = [in_process(tmp_path, code, tmp_path / "cache") for _ in range(2)]
    assert found == ["[6.0, 12.0] True [0, 0]", "[6.0, 12.0] True [1, 1]"]
