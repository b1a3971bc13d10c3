"""Opening an FMU of any FMI version that the master knows."""

from pathlib import Path

from herringbone.cosim.fmu.file import is_fmi3, read_fmu
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
