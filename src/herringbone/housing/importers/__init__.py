"""Importers of housings, one file each; the kind of a file follows from its suffix."""

from collections.abc import Callable, Sequence
from pathlib import Path

from herringbone.core import ResourceError
from herringbone.core.process.telling import Tell, untold
from herringbone.core.reduction import BAND, TOLERANCE
from herringbone.housing.files.reader import read_compliance
from herringbone.housing.importers.dmig import read_dmig
from herringbone.housing.importers.frd import read_frd
from herringbone.housing.importers.matrix_market import read_matrix_market
from herringbone.housing.importers.matrix_model import MatrixModel, housing_from_matrices
from herringbone.housing.importers.mode_set import housing_from_modes
from herringbone.housing.importers.op4 import read_op4
from herringbone.housing.importers.seat_file import SeatFile, read_seats
from herringbone.housing.importers.uff import read_uff
from herringbone.housing.modal_model import ModalHousing
from herringbone.housing.reduction.reduced_housing import with_static_compliance

_MATRICES: dict[str, Callable[[Path], MatrixModel]] = {
    ".op4": read_op4,
    ".bdf": read_dmig,
    ".dat": read_dmig,
    ".nas": read_dmig,
    ".pch": read_dmig,
}
_ADVICE = {
    ".op2": "export DMIG cards (.pch) or matrices by ASCII OUTPUT4 (.op4)",
    ".rst": "export modes as a universal file (.unv) or matrices (HBMAT) as Matrix Market",
    ".odb": "export modes as a universal file (.unv), or matrices as Matrix Market (.mtx)",
    ".fil": "export modes as a universal file (.unv), or matrices as Matrix Market (.mtx)",
}


def import_housing(
    files: Sequence[str | Path],
    seats: str | Path | None,
    *,
    most_modes: int,
    band_hz: float | None = None,
    tolerance: float | None = None,
    progress: Tell = untold,
) -> ModalHousing:
    """Import a housing.

    Args:
        files: one file; for Matrix Market stiffness, mass and perhaps the seat input.
        seats: file of seats, see `seat_file`; needed but for Matrix Market with seat input.
        most_modes: of the reduction of matrices, see `reduce_model`.
        band_hz, tolerance: likewise, those of `core.reduction` if not given. Modes are taken as
            they are, whatever these say.
        progress: called with what begins.

    Raises:
        HerringboneError: unknown kind of file, or see the importers.
    """
    paths = [Path(file) for file in files]
    suffix = paths[0].suffix.lower()
    where = read_seats(seats) if seats is not None else None
    if is_matrix(paths[0]):
        read = _MATRICES.get(suffix)
        model = read(_only(paths)) if read else read_matrix_market(paths)
        if where is not None and where.static is not None:
            raise ResourceError(
                f"{where.path}: static = {where.static}: of modes; the static compliance of "
                "matrices follows from them: leave it out"
            )
        return housing_from_matrices(
            model,
            where,
            band_hz=BAND if band_hz is None else band_hz,
            tolerance=TOLERANCE if tolerance is None else tolerance,
            most_modes=most_modes,
            progress=progress,
        )
    if suffix not in {".frd", ".uff", ".unv"}:
        known = ", ".join([".mtx", ".frd", ".uff", ".unv", *_MATRICES])
        kind = f"'{suffix}'" if suffix else "a file without suffix"
        raise ResourceError(
            f"{paths[0]}: {kind} cannot be imported; " + _ADVICE.get(suffix, f"it takes {known}")
        )
    if where is None:
        raise ResourceError(f"{paths[0]}: where are the seats? Give --seats SEATS.toml")
    return _from_modes(_only(paths), suffix, where)


def is_matrix(file: Path) -> bool:
    """True if a file holds matrices, which are reduced; False of modes."""
    return file.suffix.lower() in {".mtx", *_MATRICES}


def _only(paths: Sequence[Path]) -> Path:
    if len(paths) > 1:
        raise ResourceError(f"{paths[0]} and {paths[1]}: only Matrix Market takes several files")
    return paths[0]


def _from_modes(path: Path, suffix: str, seats: SeatFile) -> ModalHousing:
    if not seats.valid_to_hz > 0.0:
        raise ResourceError(
            f"{seats.path}: valid_to_hz is missing: up to where are the modes good?"
        )
    modes = read_frd(path) if suffix == ".frd" else read_uff(path, seats)
    housing = housing_from_modes(modes, seats)
    if seats.static is None:
        return housing
    return with_static_compliance(housing, read_compliance(seats.static))
