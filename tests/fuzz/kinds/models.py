"""Models of finite element programs, and measured velocities."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import NODES, SEATS, dmig_text, frd_text, grid_text, op4_text, text_2414

from fuzz.kinds.kind import Kind, file_of
from fuzz.records import csv_record, read_wav, universal_record, wav_record
from herringbone.analysis.measured.record import read_measured
from herringbone.housing.importers import import_housing
from herringbone.housing.importers.seat_file import read_seats


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


_PLACED = SEATS.replace("] }", "], position = [200, 30, 7] }")


def model_kinds() -> list[Kind]:
    stiffness, mass, places, frequency = _small_model()
    shapes = np.random.default_rng(1).standard_normal((NODES, 3, 2))
    frd = frd_text(frequency, shapes, places)
    universal = "\n".join([*_nodes_2411(places), *text_2414(frequency, shapes), ""])
    dmig = [*grid_text(places), *dmig_text("KAAX", stiffness), *dmig_text("MAAX", mass)]
    op4 = [*op4_text("KAA", stiffness, "sparse"), *op4_text("MAA", mass)]
    return [
        Kind("seats", SEATS.encode(), file_of("x.toml", read_seats)),
        Kind("frd", frd.encode(), _imported("x.frd", SEATS)),
        Kind("universal", universal.encode(), _imported("x.unv", SEATS), 2),
        Kind("dmig", "\n".join(dmig).encode(), _imported("x.pch", SEATS), 1),
        Kind("op4", "\n".join(op4).encode(), _imported("x.op4", _PLACED), 1),
        Kind("matrix_market", _market(stiffness), _matrices(mass), 1),
    ]


def _nodes_2411(places: np.ndarray) -> list[str]:
    lines = ["    -1", "  2411"]
    for label, place in enumerate(places, 1):
        lines += [f"{label:10d}{1:10d}{1:10d}{1:10d}", "".join(f"{x:25.16E}" for x in place)]
    return [*lines, "    -1"]


def record_kinds() -> list[Kind]:
    """Measured velocities."""
    return [
        Kind("record_csv", csv_record(), file_of("x.csv", read_measured), 1),
        Kind("record_wav", wav_record(), file_of("x.wav", read_wav), 1),
        Kind("record_universal", universal_record(), file_of("x.uff", read_measured), 1),
    ]
