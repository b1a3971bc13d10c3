"""Built libraries take any resource file: an instance starts, or is refused with one line."""

import shutil
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest
from compile_c import COMPILER, HERE, VALGRIND, compile_c, execute

from herringbone.components.registry import COMPONENTS
from herringbone.core.places.paths import component_folder

pytestmark = pytest.mark.skipif(not COMPILER, reason="no C compiler")

FILES = [(c.name, t.start) for c in COMPONENTS.values() for t in c.declaration.texts]


@pytest.fixture(scope="module")
def fuzzer(tmp_path_factory: pytest.TempPathFactory) -> Path:
    program = tmp_path_factory.mktemp("fuzzer") / "fuzz_component"
    compile_c(HERE / "fuzz_component.c", "-ldl", "-o", program)
    return program


def arguments(fmu: Path, name: str, folder: Path) -> list[str | Path]:
    """Library, guid, number of continuous states and a copy of the resources."""
    with zipfile.ZipFile(fmu) as archive:
        library = next(n for n in archive.namelist() if n.startswith("binaries/"))
        archive.extract(library, folder)
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    states = str(len(root.findall("ModelStructure/Derivatives/Unknown")))
    shutil.copytree(component_folder(name) / "resources", folder / "resources")
    return [folder / library, root.attrib["guid"], states, folder / "resources"]


@pytest.mark.parametrize(("name", "file"), FILES)
def test_mutated_resource(
    name: str, file: str, native_fmus: dict[str, Path], fuzzer: Path, tmp_path: Path
) -> None:
    execute(fuzzer, *arguments(native_fmus[name], name, tmp_path), file, "1000")


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is not installed")
@pytest.mark.parametrize(("name", "file"), FILES)
def test_mutated_resource_under_valgrind(
    name: str, file: str, native_fmus: dict[str, Path], fuzzer: Path, tmp_path: Path
) -> None:
    execute(*VALGRIND, fuzzer, *arguments(native_fmus[name], name, tmp_path), file, "40")
