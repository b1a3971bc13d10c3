"""FMUs and systems of them; no binary is ever loaded, and there is none."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

from fuzz.kinds.kind import Kind, file_of, temporary_folders, zipped
from herringbone.core.caching.remembered import Remembered
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.cosim.fmu.file import extract_fmu, read_fmu
from herringbone.cosim.fmu.variables import read_variables
from herringbone.cosim.ssp import format as package
from herringbone.cosim.ssp.read import read_ssp, read_stop_time

HERE = Path(__file__).resolve().parents[1]


def _fmu(description: bytes, identifier: str = "part", version: int = 2) -> bytes:
    platform = fmpy.platform if version == 2 else fmpy.platform_tuple
    library = f"binaries/{platform}/{identifier}{fmpy.sharedLibraryExtension}"
    return zipped({"modelDescription.xml": description, library: b"no library"})


def _read_fmu(file: Path) -> object:
    model = read_fmu(file)
    folder = extract_fmu(file)
    remove_temporary_folder(folder)
    return read_variables(model)


def _read_chain(file: Path) -> object:
    with temporary_folders(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(package, "_unpacked", Remembered(1))  # its folders do not stay
        return read_ssp(file), read_stop_time(file)


def _packed(part: str, entries: dict[str, bytes]) -> Callable[[bytes, Path], object]:
    """Reads an .ssp file with another content of one of its entries."""

    def put(content: bytes, folder: Path) -> object:
        (folder / "x.ssp").write_bytes(zipped({**entries, part: content}))
        return _read_chain(folder / "x.ssp")

    return put


def fmu_kinds() -> list[Kind]:
    two, three = ((HERE / f"description_{n}.xml").read_bytes() for n in (2, 3))
    entries = {
        "SystemStructure.ssd": (HERE / "system.ssd").read_bytes(),
        "values.ssv": (HERE / "values.ssv").read_bytes(),
        "resources/part.fmu": _fmu(two),
    }
    inside = file_of("x.fmu", _read_fmu)
    return [
        Kind("fmi2_description", two, lambda c, f: inside(_fmu(c), f), 8),
        Kind("fmi3_description", three, lambda c, f: inside(_fmu(c, version=3), f), 8),
        Kind("fmu_archive", _fmu(two), inside, 8),
        Kind("ssd", entries["SystemStructure.ssd"], _packed("SystemStructure.ssd", entries)),
        Kind("ssv", entries["values.ssv"], _packed("values.ssv", entries), 2),
        Kind("ssp_archive", zipped(entries, zipfile.ZIP_DEFLATED), file_of("x.ssp", _read_chain)),
    ]
