"""FMUs of this installation, unpacked once in a process: its instances share folder and library."""

import atexit
import ctypes
from pathlib import Path

from herringbone.core.caching.remembered import Remembered, content_key
from herringbone.core.places.temporary import remove_temporary_folder
from herringbone.cosim.fmu.file import extract_fmu, read_fmu
from herringbone.cosim.fmu.instance import new_part
from herringbone.cosim.fmu.part import FmuPart

_unpacked: "Remembered[Unpacked]" = Remembered(256)
"""By content; there are far fewer components."""


class Unpacked:
    """An FMU whose files and library are there until the process ends.

    Args:
        file: the FMU, of FMI 2.0.

    Raises:
        FmuError: it cannot be used.
    """

    def __init__(self, file: Path) -> None:
        self._file, self._model = file, read_fmu(file)
        self._folder = extract_fmu(file)
        atexit.register(remove_temporary_folder, self._folder)
        self._first: FmuPart | None = None

    def instance(self, name: str) -> FmuPart:
        """An instance; raises FmuError."""
        part = new_part(name, self._file, self._folder, self._model, self._first)
        if self._first is None:
            self._library = ctypes.CDLL(part.slave.dll._name)
            self._first = part
        return part


def unpacked(file: Path) -> Unpacked:
    """An FMU of this installation, unpacked now or before; raises FmuError."""
    return _unpacked((str(file), content_key(file)), lambda: Unpacked(file))
