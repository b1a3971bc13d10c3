"""A housing put into a system: modal data, a welded housing's dimensions, or an FMU."""

import logging
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from herringbone.analysis.anatomy import anatomy
from herringbone.core import ParameterError, ResourceError
from herringbone.core.caching.files import all_stored, alone_in, store_all
from herringbone.core.caching.keys import digest_of, kernels_key, versions_of
from herringbone.core.declaring.roles import Quantity
from herringbone.core.places.files import is_file, is_folder
from herringbone.core.places.paths import cache_folder
from herringbone.core.places.temporary import temporary_folder
from herringbone.core.process.activity import activity
from herringbone.core.wording import option
from herringbone.cosim.structure.system import System
from herringbone.housing import read_housing, write_housing
from herringbone.housing.files.file_format import COMPLIANCES, HEAD, MODES, SHAPES

_LOG = logging.getLogger("herringbone")
_FILES = {Quantity.MODES: MODES, Quantity.SHAPES: SHAPES}
_LIBRARIES = "numpy", "scipy"
"""Whose versions may change the last digits."""
_FMU, _DIMENSIONS = ".fmu", ".toml"


def split_housings(
    housings: Mapping[str, str | Path],
) -> tuple[dict[str, Path], dict[str, Path]]:
    """Housings that are data, and those that are FMUs, by the path of their part.

    Raises:
        ResourceError: a file or folder is not there, or none of these.
    """
    data: dict[str, Path] = {}
    fmus: dict[str, Path] = {}
    for part, given in housings.items():
        file, what = Path(given), option("housing", str(given))
        if not is_file(file) and not is_folder(file):
            raise ResourceError(f"{what}: there is no file or folder {file}")
        if file.suffix.lower() == _FMU:
            fmus[part] = file
        elif is_folder(file) or file.suffix.lower() == _DIMENSIONS:
            data[part] = file
        else:
            raise ResourceError(
                f"{what}: it takes a folder with {HEAD}, the dimensions of a welded housing "
                f"({_DIMENSIONS}) or an FMU ({_FMU}); 'herringbone housing import' makes the "
                "folder of another program's modes or matrices; unpack a zip file first"
            )
    return data, fmus


def with_housing_data(system: System, data: Mapping[str, Path]) -> System:
    """The system with modal data in housings; what else is set by name holds.

    Raises:
        ParameterError: the part takes no modal data.
        ResourceError: the data cannot be read, or the housing cannot be made.
    """
    known = anatomy(system)
    for part, given in data.items():
        folder = given if is_folder(given) else _built(given)
        if read_housing(folder).residual is not None:
            _tell_residual(option("housing", str(given)), folder)
        columns = {known.column(part, quantity): file for quantity, file in _FILES.items()}
        if None in columns:
            raise ParameterError(
                f"{option('housing', str(given))}: {part} takes no modal data; give an FMU"
            )
        files = {str(column): str((folder / file).absolute()) for column, file in columns.items()}
        system = system.with_values(files)
    return system


@cache
def _tell_residual(asked: str, folder: Path) -> None:
    """Say once of a folder that what its modes miss of the compliance is left out."""
    _LOG.warning(
        "%s: a run takes the modes alone and is too stiff without %s; 'herringbone housing reduce "
        "%s -o NEW' makes pseudo modes of it: take NEW",
        asked, COMPLIANCES["residual"], folder,
    )  # fmt: skip


def _built(file: Path) -> Path:
    """Folder of the modal data of a welded housing, made of its dimensions once."""
    from herringbone.housing.welded.build import build_housing  # noqa: PLC0415 (sparse matrices)
    from herringbone.housing.welded.design import read_design  # noqa: PLC0415

    design = read_design(file)
    made_by = kernels_key("herringbone.housing.welded.build"), *versions_of(*_LIBRARIES)
    folder = (
        cache_folder("welded-housings") / f"{file.stem}-{digest_of(file.read_bytes(), *made_by)}"
    )
    with alone_in(folder):
        if all_stored(folder):
            return folder
        with (
            activity(f"making the housing of {file.name}", "once for these dimensions"),
            temporary_folder() as scratch,
        ):
            write_housing(build_housing(design).model, scratch)
            contents = {made.name: made.read_bytes() for made in scratch.iterdir()}
        store_all(folder, contents)
    return folder
