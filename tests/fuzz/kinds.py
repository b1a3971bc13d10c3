"""Kinds of files of strangers: good ones, and what reads them."""

import io
import json
import tempfile
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import (
    NODES,
    SEATS,
    dmig_text,
    frd_text,
    grid_text,
    op4_text,
    text_2414,
)
from support.housing import small_housing

from fuzz.records import csv_record, read_wav, universal_record, wav_record
from herringbone.analysis.measured.record import read_measured
from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.flat_csv import read_flat_csv
from herringbone.components.resources.stiffness_table import read_stiffness_table
from herringbone.core import HerringboneError, Instance
from herringbone.core.places import temporary
from herringbone.core.places.paths import component_folder, systems_folder
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.cosim.fmu.file import extract_fmu, read_fmu
from herringbone.cosim.fmu.variables import read_variables
from herringbone.cosim.ssp.read import read_ssp, read_stop_time
from herringbone.cosim.structure.system_file import read_system
from herringbone.gears.accuracy.deviation_file import read_deviations, write_deviations
from herringbone.gears.accuracy.deviations import deviations
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.rexs import read_rexs_job
from herringbone.housing import read_housing, write_housing
from herringbone.housing.files.file_format import HEAD, digest
from herringbone.housing.importers import import_housing
from herringbone.housing.importers.seat_file import read_seats
from herringbone.housing.welded.design import read_design
from herringbone.scenes.scene import read_scene

HERE = Path(__file__).resolve().parent
_GEAR_FILE = component_folder("gear_mesh") / "gear_pair.toml"
_STAGE = HERE.parent / "gear_stage.rexs"


@dataclass(frozen=True)
class Kind:
    """A kind of file.

    Attributes:
        name: also of the test.
        content: of a good file.
        read: reads what is in a folder, into which the damaged content is put first.
        weight: how often it is tried, against others.
    """

    name: str
    content: bytes
    read: Callable[[bytes, Path], object]
    weight: int = 4


def _file(name: str, read: Callable[[Path], object]) -> Callable[[bytes, Path], object]:
    def put(content: bytes, folder: Path) -> object:
        (folder / name).write_bytes(content)
        return read(folder / name)

    return put


def _zip(entries: dict[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as archive:
        for name, content in entries.items():
            archive.writestr(name, content)
    return packed.getvalue()


@contextmanager
def temporary_folders() -> Iterator[None]:
    """Remove what would otherwise stay until the process ends."""
    before = set(temporary._locks)
    try:
        yield
    finally:
        for folder in set(temporary._locks) - before:
            remove_temporary_folder(folder)


# FMUs and systems of them; no binary is ever loaded, and there is none.


def _fmu(description: bytes, identifier: str = "part", version: int = 2) -> bytes:
    platform = fmpy.platform if version == 2 else fmpy.platform_tuple
    library = f"binaries/{platform}/{identifier}{fmpy.sharedLibraryExtension}"
    return _zip({"modelDescription.xml": description, library: b"no library"})


def _read_fmu(file: Path) -> object:
    model = read_fmu(file)
    folder = extract_fmu(file)
    remove_temporary_folder(folder)
    return read_variables(model)


def _read_chain(file: Path) -> object:
    with temporary_folders():
        return read_ssp(file), read_stop_time(file)


def _packed(part: str, entries: dict[str, bytes]) -> Callable[[bytes, Path], object]:
    """Reads an .ssp file with another content of one of its entries."""

    def put(content: bytes, folder: Path) -> object:
        (folder / "x.ssp").write_bytes(_zip({**entries, part: content}))
        return _read_chain(folder / "x.ssp")

    return put


def _fmus() -> list[Kind]:
    two, three = ((HERE / f"description_{n}.xml").read_bytes() for n in (2, 3))
    entries = {
        "SystemStructure.ssd": (HERE / "system.ssd").read_bytes(),
        "values.ssv": (HERE / "values.ssv").read_bytes(),
        "resources/part.fmu": _fmu(two),
    }
    inside = _file("x.fmu", _read_fmu)
    return [
        Kind("fmi2_description", two, lambda c, f: inside(_fmu(c), f), 8),
        Kind("fmi3_description", three, lambda c, f: inside(_fmu(c, version=3), f), 8),
        Kind("fmu_archive", _fmu(two), inside, 8),
        Kind("ssd", entries["SystemStructure.ssd"], _packed("SystemStructure.ssd", entries)),
        Kind("ssv", entries["values.ssv"], _packed("values.ssv", entries), 2),
        Kind("ssp_archive", _zip(entries, zipfile.ZIP_DEFLATED), _file("x.ssp", _read_chain)),
    ]


# Systems, scenes, gears.


def _read_own_system(file: Path) -> object:
    return read_system(file.parent)


def _gears() -> list[Kind]:
    pair = read_gear_file(_GEAR_FILE).pair
    teeth = _written(lambda file: write_deviations(deviations(pair, 6, 0), file))
    return [
        Kind("system", (systems_folder() / "gearbox/system.toml").read_bytes(),
             _file("system.toml", _read_own_system)),
        Kind("scene", (systems_folder() / "test_rig/scenes/loaded.toml").read_bytes(),
             _file("scene.toml", read_scene)),
        Kind("gear_file", _GEAR_FILE.read_bytes(), _file("x.toml", read_gear_file)),
        Kind("rexs", _STAGE.read_bytes(), _file("x.rexs", read_rexs_job)),
        Kind("deviations", teeth, _file("x.csv", lambda file: read_deviations(file, pair)), 1),
        Kind("dimensions", (component_folder("modal_housing") / "welded_housing.toml").read_bytes(),
             _file("x.toml", read_design)),
    ]  # fmt: skip


def _written(write: Callable[[Path], object]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / "x")
        return (Path(folder) / "x").read_bytes()


# Housings.


def _with_hashes(name: str, entries: dict[str, bytes]) -> Callable[[bytes, Path], object]:
    """Reads a housing with another content of one file, and its hash."""

    def put(content: bytes, folder: Path) -> object:
        for other, text in {**entries, name: content}.items():
            (folder / other).write_bytes(text)
        if name != HEAD:
            head = json.loads(entries[HEAD])
            head["sha256"][name] = digest(content)
            (folder / HEAD).write_text(json.dumps(head))
        return read_housing(folder)

    return put


def _housings() -> list[Kind]:
    with tempfile.TemporaryDirectory() as folder:
        write_housing(small_housing(modes=4), Path(folder) / "x")
        written = sorted((Path(folder) / "x").iterdir())
        entries = {file.name: file.read_bytes() for file in written}
    whole = Kind(
        "housing_archive", _zip(entries, zipfile.ZIP_DEFLATED), _file("x.zip", read_housing)
    )
    return [
        whole, *(Kind(f"housing_{n}", c, _with_hashes(n, entries), 2) for n, c in entries.items()),
    ]  # fmt: skip


# Finite element programs.


def _small_model() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Stiffness, mass, node positions; frequencies follow. A chain, so that files are short."""
    size = 3 * NODES
    stiffness = 1e3 * (np.diag(np.full(size, 40.0)) - np.eye(size, k=3) - np.eye(size, k=-3))
    mass = np.diag(np.repeat(np.linspace(1e-3, 3e-3, NODES), 3))
    random = np.random.default_rng(5)
    return stiffness, mass, 100.0 * random.standard_normal((NODES, 3)), np.array([100.0, 220.0])


def _imported(name: str, seats: str) -> Callable[[bytes, Path], object]:
    def put(content: bytes, folder: Path) -> object:
        (folder / name).write_bytes(content)
        (folder / "seats.toml").write_text(seats)
        return import_housing(
            [folder / name], folder / "seats.toml", band_hz=200.0, tolerance=0.9, most_modes=30
        )

    return put


def _matrices(mass: np.ndarray) -> Callable[[bytes, Path], object]:
    other = _market(mass)

    def put(content: bytes, folder: Path) -> object:
        (folder / "K.mtx").write_bytes(content)
        (folder / "M.mtx").write_bytes(other)
        (folder / "seats.toml").write_text(_PLACED)
        files = [folder / "K.mtx", folder / "M.mtx"]
        return import_housing(
            files, folder / "seats.toml", band_hz=200.0, tolerance=0.9, most_modes=30
        )

    return put


def _market(matrix: np.ndarray) -> bytes:
    buffer = io.BytesIO()
    scipy.io.mmwrite(buffer, sp.coo_array(matrix), symmetry="symmetric")
    return buffer.getvalue()


_FLAT = b'# units: a N, b m\na,b\n1,2\n3e-5,"4"\n# x\n-.5,+6.\n'
_PLACED = SEATS.replace("] }", "], position = [200, 30, 7] }")


def _models() -> list[Kind]:
    stiffness, mass, places, frequency = _small_model()
    shapes = np.random.default_rng(1).standard_normal((NODES, 3, 2))
    frd = frd_text(frequency, shapes, places)
    universal = "\n".join([*_nodes_2411(places), *text_2414(frequency, shapes), ""])
    dmig = [*grid_text(places), *dmig_text("KAAX", stiffness), *dmig_text("MAAX", mass)]
    op4 = [*op4_text("KAA", stiffness, "sparse"), *op4_text("MAA", mass)]
    return [
        Kind("seats", SEATS.encode(), _file("x.toml", read_seats)),
        Kind("frd", frd.encode(), _imported("x.frd", SEATS)),
        Kind("universal", universal.encode(), _imported("x.unv", SEATS), 2),
        Kind("dmig", "\n".join(dmig).encode(), _imported("x.pch", SEATS), 1),
        Kind("op4", "\n".join(op4).encode(), _imported("x.op4", _PLACED), 1),
        Kind("matrix_market", _market(stiffness), _matrices(mass), 1),
        Kind(
            "flat_csv",
            b'# units: a N, b m\na,b\n1,2\n3e-5,"4"\n# x\n-.5,+6.\n',
            _file("x.csv", _flat),
            8,
        ),
    ]


def _flat(file: Path) -> object:
    return read_flat_csv(file, (), {"a": ("N",)}, more="b")


def _nodes_2411(places: np.ndarray) -> list[str]:
    lines = ["    -1", "  2411"]
    for label, place in enumerate(places, 1):
        lines += [f"{label:10d}{1:10d}{1:10d}{1:10d}", "".join(f"{x:25.16E}" for x in place)]
    return [*lines, "    -1"]


# What FMUs read: the component's own refusals, in Python.


def _resource(component: str, text: str) -> Callable[[bytes, Path], object]:
    def put(content: bytes, folder: Path) -> object:
        (folder / "x.csv").write_bytes(content)
        instance = Instance(COMPONENTS[component], "part")
        resources = component_folder(component) / "resources"
        for other in COMPONENTS[component].declaration.texts:
            instance.set(other.name, str(resources / other.start))
        instance.set(text, str(folder / "x.csv"))
        return instance.initialise()

    return put


def _resources() -> list[Kind]:
    kinds = []
    for component in COMPONENTS.values():
        for text in component.declaration.texts:
            content = (component_folder(component.name) / "resources" / text.start).read_bytes()
            kinds.append(
                Kind(
                    f"{component.name}_{text.name}",
                    content,
                    _resource(component.name, text.name),
                    1,
                )
            )
    loads = b"\n".join(
        f"{side},{load},{phase},{8e8 + 1e7 * load}".encode()
        for side in ("left", "right")
        for load in (10.0, 20.0)
        for phase in (0.0, 0.25, 0.5, 0.75)
    )
    head = b"# units: load N, phase 1, stiffness N/m\nside,load,phase,stiffness\n"
    small = Kind("stiffness_table", head + loads, _file("x.csv", read_stiffness_table))
    return [small, *kinds]


def _records() -> list[Kind]:
    """Measured velocities."""
    return [
        Kind("record_csv", csv_record(), _file("x.csv", read_measured), 1),
        Kind("record_wav", wav_record(), _file("x.wav", read_wav), 1),
        Kind("record_universal", universal_record(), _file("x.uff", read_measured), 1),
    ]


def all_kinds() -> list[Kind]:
    """All of them; each good file is read without a complaint."""
    return [*_fmus(), *_gears(), *_housings(), *_models(), *_resources(), *_records()]


def refused(kind: Kind, content: bytes, folder: Path) -> bool:
    """Read a content; True if it was refused, in one line."""
    try:
        kind.read(content, folder)
    except HerringboneError as error:
        assert "\n" not in str(error)
        assert str(error).isprintable()
        return True
    return False
