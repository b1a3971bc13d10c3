"""Each component's wrapper under random calls: no error of memory, and one line where it refuses.

RANDOM_CALLS sets their number.
"""

import os
import shutil
from pathlib import Path

import pytest
from compile_c import COMPILER, HERE, VALGRIND, WRAPPER, compile_c, execute

from herringbone.components.registry import COMPONENTS
from herringbone.core.places.paths import component_folder
from herringbone.fmi.native import build, own_platform
from herringbone.fmi.native.component_source import component_source
from herringbone.fmi.native.model import registered_model

pytestmark = pytest.mark.skipif(not COMPILER, reason="no C compiler")
CALLS = int(os.environ.get("RANDOM_CALLS", "3000"))
SANITIZERS = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")


@pytest.fixture(scope="module")
def wrapper(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The wrapper and the caller as one object, by how errors are found."""
    folder = tmp_path_factory.mktemp("wrapper")
    found = {}
    for way, flags in (("sanitizers", SANITIZERS), ("valgrind", ())):
        found[way] = folder / f"{way}.o"
        files = [*sorted(WRAPPER.rglob("*.c")), HERE / "random_calls.c"]
        compile_c(*flags, "-r", *files, "-o", found[way])
    return found


@pytest.mark.parametrize("way", ["sanitizers", "valgrind"])
@pytest.mark.parametrize("name", list(COMPONENTS))
def test_random_calls(
    name: str, way: str, native_fmus: dict[str, Path], wrapper: dict[str, Path], tmp_path: Path
) -> None:
    if way == "valgrind" and not shutil.which("valgrind"):
        pytest.skip("valgrind is not installed")
    del native_fmus
    model, platform = registered_model(name), own_platform()
    build._make_kernels(model, [platform])
    source = tmp_path / f"{name}.c"
    source.write_text(component_source(model.states), encoding="ascii")
    flags = SANITIZERS if way == "sanitizers" else ()
    program, kernels = tmp_path / name, build._kernels(model, platform)
    compile_c(*flags, source, wrapper[way], kernels, "-o", program, "-lm")
    guard, calls = (VALGRIND, CALLS // 10) if way == "valgrind" else ((), CALLS)
    execute(*guard, program, component_folder(name) / "resources", str(calls))
