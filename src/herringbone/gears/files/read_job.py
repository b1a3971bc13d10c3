"""A gear job from a file of any kind."""

from pathlib import Path

from herringbone.core import ParameterError
from herringbone.core.places.files import is_file
from herringbone.gears.files.gear_file import read_gear_file
from herringbone.gears.files.rexs import STAGE_MARK, read_rexs_job
from herringbone.gears.job import GearJob

_READERS = (".toml", ".rexs", ".xml")


def read_job(file: Path, *, stage: str | None = None, halves: int | None = None) -> GearJob:
    """Read a gear file (.toml) or a REXS file (.rexs, .xml).

    Args:
        file: the file.
        stage: of a REXS file of several.
        halves: of a REXS stage; 1 if None.

    Raises:
        ParameterError: another kind of file, an option that its kind does not have, or an
            impossible value.
        ResourceError: it cannot be read.
    """
    suffix = file.suffix.lower()
    if suffix not in _READERS:
        raise ParameterError(f"{file}: a gear file ends with one of {', '.join(_READERS)}")
    if suffix != ".toml":
        return read_rexs_job(file, stage=stage, halves=1 if halves is None else halves)
    for option, value in (("stage", stage), ("halves", halves)):
        if value is not None:
            raise ParameterError(f"{file}: --{option} is of REXS files only")
    return read_gear_file(file)


def _is_rexs(file: Path) -> bool:
    """True for a file of the kind that has no number of halves."""
    return file.suffix.lower() != ".toml"


def read_mounted_job(file: Path) -> GearJob:
    """As `read_job`, of a pair that is mounted in a gearbox: a REXS stage stands for both halves.

    A stage of REXS has one face width, here that of one half. Of a file of several stages one is
    chosen by its id or name behind the file's: unit.rexs#2.
    """
    if not _is_rexs(file):
        return read_job(file)
    name, chosen, stage = file.name.rpartition(STAGE_MARK)
    if chosen and name and not is_file(file):
        return read_job(file.with_name(name), stage=stage, halves=2)
    return read_job(file, halves=2)
