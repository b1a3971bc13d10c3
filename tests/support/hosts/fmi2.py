"""A hand-written FMI 2.0 host: what any tool does with an FMU, and nothing else."""

from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


class Fmi2Host:
    """An instance for co-simulation.

    Args:
        fmu: file.
        folder: where it is unzipped.
        start: start time [s].
        tolerance: that is given; None: not defined.
        values: set in initialisation mode.
        begun: False: it is left as it was instantiated.
    """

    def __init__(
        self, fmu: Path, folder: Path, start=0.0, tolerance=None, values=None, *, begun=True
    ):
        description = read_model_description(str(fmu))
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.choices = {v.name for v in description.modelVariables if v.type == "Enumeration"}
        self.messages: list[str] = []
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=extract(str(fmu), unzipdir=str(folder)),
            modelIdentifier=description.coSimulation.modelIdentifier,
        )
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(
            lambda _, name, status, category, message: self.messages.append(message.decode())
        )
        self._callbacks = callbacks
        self.slave.instantiate(callbacks=callbacks, loggingOn=True)
        if begun:
            self.initialise(start, tolerance, values)

    def initialise(self, start=0.0, tolerance=None, values=None):
        self.slave.setupExperiment(tolerance=tolerance, startTime=start)
        self.slave.enterInitializationMode()
        self.set(values or {})
        self.slave.exitInitializationMode()

    def set(self, values):
        reals = {n: x for n, x in values.items() if n not in self.choices}
        if reals:
            self.slave.setReal([self.reference[n] for n in reals], list(reals.values()))
        for n in values.keys() & self.choices:
            self.slave.setInteger([self.reference[n]], [values[n]])

    def get(self, *names):
        return np.array(self.slave.getReal([self.reference[n] for n in names]))

    def step(self, time, size):
        self.slave.doStep(time, size)
