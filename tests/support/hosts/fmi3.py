"""A hand-written FMI 3.0 host: what any tool does with an FMU, and nothing else."""

from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi3 import FMU3Slave


class Fmi3Host:
    """An instance for co-simulation, in step mode.

    Args:
        fmu: file.
        folder: where it is unzipped.
        degree: of the signals at the nodes of its inputs; None: it has no nodes.
        values: set in initialisation mode.
        options: of fmpy's instantiate.
    """

    def __init__(self, fmu: Path, folder: Path, degree=0.0, values=None, **options):
        description = read_model_description(str(fmu))
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.slave = FMU3Slave(
            guid=description.guid,
            unzipDirectory=extract(str(fmu), str(folder)),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="part",
        )
        self.slave.instantiate(**options)
        if degree is not None:
            self.set({"interface_degree": degree})
        self.slave.enterInitializationMode()
        self.set(values or {})
        self.slave.exitInitializationMode()

    def set(self, values):
        """Numbers, or lists of them for arrays, by name."""
        for name, value in values.items():
            self.slave.setFloat64([self.reference[name]], np.atleast_1d(value).tolist())

    def get(self, name, count=1):
        return list(self.slave.getFloat64([self.reference[name]], nValues=count))

    def step(self, time, size):
        self.slave.doStep(time, size)

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()
