"""Instances of FMUs of any FMI version that the master knows, in this process."""

from pathlib import Path

from fmpy.model_description import ModelDescription

from herringbone.cosim.fmu.file import is_fmi3, read_fmu
from herringbone.cosim.fmu.fmi2_part import Fmu2Part
from herringbone.cosim.fmu.part import FmuPart


def new_part(
    name: str,
    file: Path,
    folder: Path | None = None,
    model: ModelDescription | None = None,
    alike: FmuPart | None = None,
) -> FmuPart:
    """Instantiate an FMU 2.0 or 3.0 for co-simulation.

    Args:
        name: instance name.
        file: the FMU.
        folder: where it is extracted already, and stays; None: to a folder of its own.
        model: its model description, if it has been read.
        alike: see `FmuPart`; of FMI 2.0.

    Raises:
        FmuError: the file cannot be used, or does not instantiate.
    """
    model = model or read_fmu(file)
    if not is_fmi3(model):
        return Fmu2Part(name, file, model, folder, alike)
    from herringbone.cosim.fmu.fmi3.part import Fmu3Part  # noqa: PLC0415 (compiled adapters)

    return Fmu3Part(name, file, model, folder)
