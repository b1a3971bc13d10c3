"""Room on the disk for the rows of a run."""

import shutil
from pathlib import Path

from herringbone.core import ParameterError
from herringbone.core.wording import option

_GIB = 2.0**30
_TEXT = 2.5
"""Size of a table as text over that of its doubles, as measured on the test rig."""


def check_room(folder: Path, rows: int, columns: int) -> None:
    """Refuse before a run what cannot be written in the end.

    Args:
        folder: where the rows go; it need not be there.
        rows: of the run; 0 if that is not known.
        columns: of doubles.

    Raises:
        ParameterError: the rows, and the table that is made of them, take more than is free.
    """
    there = next(f for f in (folder, *folder.absolute().parents) if f.exists())
    needed, free = 8.0 * (1.0 + _TEXT) * rows * (columns + 1), shutil.disk_usage(there).free
    if needed > free:
        raise ParameterError(
            f"{rows} records of {columns} outputs take {needed / _GIB:.3g} GiB as doubles and as "
            f"text, but there are {free / _GIB:.3g} GiB free in {there}; use a longer "
            f"{option('record_step')} or a shorter {option('t_end')}"
        )
