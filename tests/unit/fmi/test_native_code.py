"""Code of native FMUs: nothing of Python or libm inside, optimised once for a processor's kind."""

import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError
from herringbone.fmi.native import PLATFORMS, build, objects, own_platform, symbols
from herringbone.fmi.native.model import registered_model

OWN = own_platform()


def library(fmu, folder):
    """The own platform's library of an FMU."""
    with zipfile.ZipFile(fmu) as archive:
        name = f"binaries/{OWN.folder}/{fmu.stem}.{OWN.extension}"
        return archive.extract(name, folder)


def test_library_has_the_functions_of_its_version_alone(native_fmus, fmi3_fmus):
    for version, other, fmus in ((2, 3, native_fmus), (3, 2, fmi3_fmus)):
        with zipfile.ZipFile(fmus["drive_motor"]) as archive:
            (name,) = (n for n in archive.namelist() if n.endswith(OWN.extension))
            data = archive.read(name)
        assert f"fmi{version}DoStep".encode() in data
        assert f"fmi{other}DoStep".encode() not in data


@pytest.mark.parametrize("name", COMPONENTS)
def test_library_needs_libc_alone(name, native_fmus, tmp_path):
    file = library(native_fmus[name], tmp_path)
    data = Path(file).read_bytes()
    symbols.check_library(data, OWN, name)
    assert b"PyErr" not in data
    assert b"numba" not in data
    if OWN.extension == "so" and shutil.which("nm"):
        listed = subprocess.run(
            ["nm", "-D", "--undefined-only", "--without-symbol-versions", file],
            capture_output=True, text=True, check=True,
        ).stdout.split()  # fmt: skip
        assert symbols.undefined(data) == {word for word in listed if word not in {"U", "w"}}
        assert max(symbols.glibc_versions(data)) <= (2, 17)


@pytest.fixture
def compiled(tmp_path):
    """Function that compiles C to an object file, or to a library with the given libraries."""
    if not shutil.which("cc") or OWN.extension != "so":
        pytest.skip("needs cc that makes ELF files")

    def make(source, *link):
        file = tmp_path / "part.c"
        file.write_text(source)
        kind = ["-shared", "-fPIC"] if link else ["-c"]
        target = tmp_path / "part.out"
        subprocess.run(["cc", "-O1", *kind, file, "-o", target, *link], check=True)
        return target.read_bytes()

    return make


def test_gate_refuses_functions_of_libm_and_of_python(compiled):
    sine = "double sin(double); double f(double x) { return sin(x); }"
    with pytest.raises(FmuError, match=r"the kernels of part for \S+ would need sin at run time"):
        symbols.check_object(compiled(sine), OWN, "part")
    with pytest.raises(FmuError, match=r"the library of part for .* would need sin"):
        symbols.check_library(compiled(sine, "-lm"), OWN, "part")
    python = "void PyErr_Clear(void); void f(void) { PyErr_Clear(); }"
    with pytest.raises(FmuError, match="PyErr_Clear"):
        symbols.check_object(compiled(python), OWN, "part")
    symbols.check_object(compiled("double f(double x) { return 2.0 * x; }"), OWN, "part")


def test_gate_refuses_a_young_libc(compiled, monkeypatch):
    data = compiled("#include <stdlib.h>\nvoid *f(void) { return malloc(8); }", "-lc")
    symbols.check_library(data, OWN, "part")
    monkeypatch.setattr(symbols, "_NEWEST_GLIBC", (2, 0))
    with pytest.raises(FmuError, match="would need GLIBC_2"):
        symbols.check_library(data, OWN, "part")


def test_a_kind_of_processor_is_optimised_for_once(monkeypatch):
    """Whichever platforms are asked for together, each gets the same code."""
    found, whole = [], objects._whole
    monkeypatch.setattr(objects, "_whole", lambda k, p: found.append(p.name) or whole(k, p))
    part = COMPONENTS["shaft_coupling"]
    together = objects.object_code(part, PLATFORMS.values())
    assert found == ["x86_64-linux", "aarch64-linux", "x86_64-darwin"]
    for platform, code in together.items():
        assert objects.object_code(part, [platform]) == {platform: code}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["gear_mesh", "modal_housing"])
def test_kernels_for_all_platforms_need_no_functions(name):
    """Of the cache, which has them as these sources make them, or makes them.

    They may look at a flag of the wrapper that tells whether there are 256-bit vectors.
    """
    model, platforms = registered_model(name), list(PLATFORMS.values())
    build._make_kernels(model, platforms)
    for platform in platforms:
        code = build._kernels(model, platform).read_bytes()
        symbols.check_object(code, platform, name)
        assert symbols.undefined(code) <= symbols._IN_OBJECTS | symbols._OF_WRAPPER


@pytest.mark.parametrize("needed", [1, 3])
def test_code_is_optimised_until_no_kernel_fails(needed, monkeypatch):
    """Twice at least; systems differ in how soon LLVM sees it."""
    optimise, rounds = objects._optimise, []

    def slow(module, target, **how):
        rounds.append(how)
        if len(rounds) == needed:
            optimise(module, target, **how)
            optimise(module, target, **how)

    monkeypatch.setattr(objects, "_optimise", slow)
    kernels = objects.entry_points(COMPONENTS["shaft_coupling"])
    fast = {symbol: kernel for symbol, kernel in kernels.items() if symbol in objects.FAST}
    module = objects._optimised(fast, OWN, fast=True)
    assert len(rounds) == max(needed, 2)
    assert not objects._may_fail(module)
