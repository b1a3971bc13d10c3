"""An FMU 2.0 or 3.0 in model exchange, called function by function."""

import ctypes
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Model, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Model
from fmpy.model_description import ModelVariable


def _elements(variable: ModelVariable) -> list[str]:
    """Names of a variable's elements, as FMI 2.0 calls them."""
    if not variable.dimensions:
        return [variable.name]
    head = variable.name.rstrip(")0123456789").removesuffix(",")
    tail = variable.name[len(head) :]
    return [f"{head}[{k + 1}]{tail}" for k in range(int(np.prod(variable.shape)))]


class ExchangeHost:
    """One instance; states and derivatives have the names of FMI 2.0, also in FMI 3.0."""

    def __init__(self, fmu: Path, folder: Path) -> None:
        self.model = fmpy.read_model_description(str(fmu))
        self.third = self.model.fmiVersion.startswith("3")
        self.messages: list[str] = []
        rates = [d.variable for d in self.model.derivatives]
        self.states = [name for v in rates for name in _elements(v.derivative)]
        self.rates = [name for v in rates for name in _elements(v)]
        self.reference = {v.name: v.valueReference for v in self.model.modelVariables}
        for v in (*rates, *(v.derivative for v in rates)):
            first = v.valueReference
            self.reference |= {name: first + k for k, name in enumerate(_elements(v))}
        self.fmu = (FMU3Model if self.third else FMU2Model)(
            guid=self.model.guid,
            unzipDirectory=fmpy.extract(str(fmu), str(folder)),
            modelIdentifier=self.model.modelExchange.modelIdentifier,
            instanceName="part",
        )
        if self.third:
            self.fmu.instantiate(logMessage=lambda e, s, c, text: self._told(text))
        else:
            self._callbacks = fmi2CallbackFunctions()
            self._callbacks.logger = fmi2CallbackLoggerTYPE(
                lambda e, n, s, c, text: self._told(text)
            )
            self.fmu.instantiate(callbacks=self._callbacks)

    def _told(self, text: bytes) -> None:
        self.messages.append(text.decode())

    def close(self) -> None:
        self.fmu.terminate()
        self.fmu.freeInstance()

    def initialise(self, **texts: str) -> None:
        """To continuous-time mode."""
        for name, value in texts.items():
            self.fmu.setString([self.reference[name]], [value])
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.fmu.enterContinuousTimeMode()

    def set(self, **values: float) -> None:
        for name, value in values.items():
            setter = self.fmu.setFloat64 if self.third else self.fmu.setReal
            setter([self.reference[name]], [value])

    def _read(self, function: str, count: int) -> np.ndarray:
        values = (ctypes.c_double * count)()
        getattr(self.fmu, function)(values, count)
        return np.array(values)

    @property
    def x(self) -> np.ndarray:
        return self._read("getContinuousStates", len(self.states))

    @x.setter
    def x(self, values: np.ndarray) -> None:
        count = len(self.states)
        self.fmu.setContinuousStates((ctypes.c_double * count)(*values), count)

    @property
    def dx(self) -> np.ndarray:
        name = "getContinuousStateDerivatives" if self.third else "getDerivatives"
        return self._read(name, len(self.states))

    @property
    def nominals(self) -> np.ndarray:
        return self._read("getNominalsOfContinuousStates", len(self.states))

    @property
    def indicators(self) -> np.ndarray:
        return self._read("getEventIndicators", self.model.numberOfEventIndicators)

    def outputs(self) -> np.ndarray:
        """All outputs without their nodes."""
        getter = self.fmu.getFloat64 if self.third else self.fmu.getReal
        return np.array(getter([self.reference[name] for name in self.output_names]))

    def value(self, name: str, extent: int) -> np.ndarray:
        """A variable, all elements of an array."""
        if self.third:
            return np.array(self.fmu.getFloat64([self.reference[name]], extent))
        return np.array(self.fmu.getReal([self.reference[name]]))

    def derivatives(self, of: list[int], by: ModelVariable, count: int) -> np.ndarray:
        """Derivatives of `count` numbers by a variable; by all elements of an array at once."""
        if not self.third:
            return np.array(self.fmu.getDirectionalDerivative(of, [by.valueReference], [1.0]))
        seed = [1.0] * len(_elements(by))
        return np.array(self.fmu.getDirectionalDerivative(of, [by.valueReference], seed, count))

    @property
    def output_names(self) -> list[str]:
        found = (v.name for v in self.model.modelVariables if v.causality == "output")
        return [name for name in found if ".node" not in name]

    def tangent(self, known: str) -> np.ndarray:
        """Derivatives of the states' derivatives, then of the outputs, by a state or input.

        FMI 3.0 asks for whole arrays.
        """
        if not self.third:
            unknowns = [self.reference[name] for name in (*self.rates, *self.output_names)]
            knowns = [self.reference[known]]
            return np.array(self.fmu.getDirectionalDerivative(unknowns, knowns, [1.0]))
        rates = [d.variable for d in self.model.derivatives]
        shown = {d.variable.derivative.name: d.variable.derivative for d in self.model.derivatives}
        array = next((v for v in shown.values() if known in _elements(v)), None)
        names = _elements(array) if array else [known]
        of = [*(v.valueReference for v in rates), *map(self.reference.get, self.output_names)]
        by = array.valueReference if array else self.reference[known]
        seed = [float(name == known) for name in names]
        count = len(self.rates) + len(self.output_names)
        return np.array(self.fmu.getDirectionalDerivative(of, [by], seed, count))
