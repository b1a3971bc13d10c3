"""Opening an FMU of any FMI version that the master knows."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from herringbone.core.temporary import remove_temporary_folder
from herringbone.cosim.fmu.file import extract_fmu, is_fmi3, read_fmu
from herringbone.cosim.fmu.fmi2_part import Fmu2Part
from herringbone.cosim.fmu.fmi3_part import Fmu3Part
from herringbone.cosim.fmu.part import FmuPart


def open_fmu(name: str, file: str | Path) -> FmuPart:
    """Instantiate an FMU 2.0 or 3.0 for co-simulation.

    Args:
        name: instance name.
        file: the FMU.

    Raises:
        FmuError: the file cannot be used, or does not instantiate.
    """
    file = Path(file)
    model = read_fmu(file)
    return (Fmu3Part if is_fmi3(model) else Fmu2Part)(name, file, model)


@contextmanager
def many_of(name: str, file: str | Path) -> Iterator[Callable[[], FmuPart]]:
    """A function that makes instances of an FMU, which is extracted once for all of them.

    All must be closed before the context ends. See `open_fmu` for arguments and errors.
    """
    file = Path(file)
    model = read_fmu(file)
    kind = Fmu3Part if is_fmi3(model) else Fmu2Part
    folder = extract_fmu(file)
    try:
        yield lambda: kind(name, file, model, folder)
    finally:
        remove_temporary_folder(folder)
