"""Base class of the Python FMUs: FMI 2.0 calls on one instance of a component."""

import hashlib
import math
from collections.abc import Callable
from enum import IntEnum
from operator import itemgetter
from pathlib import Path
from typing import cast
from xml.etree.ElementTree import Element

from pythonfmu.enums import Fmi2Status

from herringbone.components.registry import component
from herringbone.core import FmuError, Instance
from herringbone.core.caching.keys import sources_key
from herringbone.core.declaring.units import quantity
from herringbone.core.declaring.variable import Causality
from herringbone.core.instance import check_value
from herringbone.fmi import interface
from herringbone.fmi.description.common import LOG_CATEGORIES
from herringbone.fmi.description.fmi2 import model_description
from herringbone.fmi.python import state
from herringbone.fmi.python.guarded_slave import GuardedSlave
from herringbone.fmi.python.state import FmuState
from herringbone.fmi.python.variables import has_same_variables

_SLACK = 1e-9
"""Relative difference of times that are one: of sums of a million steps."""


class _Phase(IntEnum):
    INSTANTIATED = 0
    INITIALISATION = 1
    STEPPING = 2


class ComponentSlave(GuardedSlave):
    """One instance of the component that has the name of the class.

    The script of an FMU derives from it and binds `do_step` to `advance` and `terminate` to `end`.
    """

    log_categories = LOG_CATEGORIES

    def __init__(self, **kwargs: object) -> None:
        super().__init__(**kwargs)
        self._component = component(type(self).__name__)
        declaration = self._component.declaration
        folder = Path(self.resources) if self.resources else None
        self._instance = Instance(self._component, self.instance_name, folder)
        block = self._instance.block
        self._values = cast("memoryview[float]", block.data)
        self._saved = block[: declaration.first_table].data.cast("B")
        self._first_parameter = declaration.mutable_size * block.itemsize
        self._reals = interface.reals(declaration)
        self._texts = interface.texts(declaration)
        self._references = frozenset(self._reals)
        self._inputs = frozenset(
            reference for reference, v in self._reals.items() if v.causality is Causality.INPUT
        )
        self._owner = f"{self._component.name} {sources_key()}"
        self._tables = ""
        self._phase = _Phase.INSTANTIATED
        self._outdated = True
        self._stop = math.inf
        self._moved = slice(declaration.mutable_size)
        self._kernel = self._component.kernels.step
        self._read: tuple[list[int], Callable] = ([-1], tuple)
        self._written: list[int] = []
        self._unfit = ""
        self._check_sources()

    def _check_sources(self) -> None:
        """Look whether the FMU was built from the sources of the package that computes it.

        Other ones are warned of. If their variables differ, too, the host's values would reach
        others than it means: the instance cannot be initialised then.
        """
        script = Path(self.resources or "", "slavemodule.txt")
        built = script.read_text().strip().rpartition("_")[2] if script.is_file() else ""
        if not built or built == sources_key():
            return
        told = (
            f"{self.instance_name}: this FMU was built from sources {built}, but the installed "
            f"package herringbone has {sources_key()}"
        )
        if has_same_variables(script.parents[1], self.to_xml()):
            self._say(f"{told}; build the FMU again", Fmi2Status.warning)
        else:
            self._unfit = f"{told}, whose variables are others; build the FMU again"
            self._fail(self._unfit)

    def to_xml(self, model_options: object = None) -> Element:
        """modelDescription.xml, made from the declaration."""
        del model_options
        return model_description(self._component)

    def setup_experiment(
        self, start_time: float, stop_time: float | None, tolerance: float | None
    ) -> None:
        """Take start and stop time [s]."""
        del tolerance
        self._time = start_time
        self._stop = math.inf if stop_time is None else stop_time

    def enter_initialization_mode(self) -> None:
        """From now on, until `exit_initialization_mode`, outputs follow inputs and parameters."""
        self._phase = _Phase.INITIALISATION
        self._outdated = True

    def exit_initialization_mode(self) -> None:
        """Check parameters, read resources, compute states and outputs.

        Raises:
            FmuError: there was an error since the instantiation.
        """
        if not self._failure:
            self._attempt(self._initialise)
        if self._failure:
            self._raise()
        self._phase = _Phase.STEPPING
        self._outdated = False

    def _initialise(self) -> None:
        self._read_resources()
        self._instance.initialise(self._time)

    def _read_resources(self) -> None:
        if not self._tables:
            self._instance.load_resources()
            tables = self._instance.block[self._component.declaration.first_table :]
            self._tables = hashlib.sha256(tables.tobytes()).hexdigest()[:16]

    def _refresh(self) -> None:
        """Compute states and outputs in initialisation mode."""
        self._outdated = False
        self._read_resources()
        self._component.start(self._instance.block)
        self._component.kernels.out(self._instance.block, self._time)

    def advance(self, time: float, step_size: float) -> bool:
        """Step from `time` to `time + step_size` [s]; False discards the step.

        One that cannot be computed leaves everything as it was: others may follow.
        """
        self._time = time
        if self._failure:
            return self._discarded()
        instance, end = self._instance, time + step_size
        stepping = self._phase is _Phase.STEPPING and 0.0 <= step_size < math.inf
        if not stepping or end > self._stop + _SLACK * (1.0 + abs(self._stop)):
            self._attempt(self._refuse_step, step_size)
            return self._discarded()
        before = instance.block[self._moved].copy()
        if self._kernel(instance.block, instance.work, time, step_size) == 0:
            self._time = end
            return True
        self._attempt(self._explain, step_size)
        instance.block[self._moved] = before
        return self._discarded()

    def _discarded(self) -> bool:
        """False: errors are told by this step, but for those before the end of initialisation."""
        if self._phase is _Phase.STEPPING:
            self._failure = ""
        return False

    def _refuse_step(self, step_size: float) -> None:
        if self._phase is not _Phase.STEPPING:
            self._fail(f"{self.instance_name}: doStep before the end of initialisation")
        elif not 0.0 <= step_size < math.inf:
            self._fail(f"{self.instance_name}: step size {step_size} s; it must be 0 or positive")
        else:
            self._fail(
                f"{self.instance_name}: a step from {self._time:g} s by {step_size:g} s ends after "
                f"the stop time of {self._stop:g} s"
            )

    def _explain(self, step_size: float) -> None:
        """Say why a step failed."""
        if step_size > (longest := self._instance.longest_step()):
            self._fail(
                f"{self.instance_name}: step size {step_size:g} s; one call takes at most "
                f"{longest:g} s"
            )
        else:
            name, value = self._instance.first_not_finite() or ("result", math.nan)
            unit = next((f" {v.unit}" for v in self._reals.values() if v.name == name), "")
            self._fail(
                f"{self.instance_name}.{name} = {value}{unit} after a step of {step_size:g} s; "
                "reduce the communication step size, or check the inputs"
            )

    def end(self) -> None:
        """Nothing is left to do at fmi2Terminate."""

    def get_real(self, vrs: list[int]) -> list[float]:
        """Values of real variables, in their units."""
        if self._phase is _Phase.INSTANTIATED:
            return [self._start_value(vr) for vr in vrs]
        if self._outdated:
            self._attempt(self._refresh)
        values = self._values
        known, getter = self._read
        if vrs == known:
            return list(getter(values))
        if self._references.issuperset(vrs) and len(vrs) > 1:
            self._read = (vrs, itemgetter(*vrs))
        if self._references.issuperset(vrs):
            return [values[vr] for vr in vrs]
        self._unknown("Real", vrs, self._references)
        return [values[vr] if vr in self._references else math.nan for vr in vrs]

    def _start_value(self, vr: int) -> float:
        """Value before initialisation; NaN, and an error, of what is computed there."""
        if vr not in self._references:
            self._unknown("Real", [vr])
        elif interface.settable(self._reals[vr], initialised=False):
            return self._values[vr]
        else:
            name = self._reals[vr].name
            self._fail(f"{self.instance_name}.{name}: it has no value before initialisation")
        return math.nan

    def set_real(self, vrs: list[int], values: list[float]) -> None:
        """Set inputs, parameters and, until initialisation ends, states."""
        if (vrs == self._written or self._inputs.issuperset(vrs)) and math.isfinite(sum(values)):
            self._written = vrs
            target = self._values
            for vr, value in zip(vrs, values):  # noqa: B905 (a host gives as many of both)
                target[vr] = value
        else:
            for vr, value in zip(vrs, values, strict=True):
                self._attempt(self._set_checked, vr, value)
        self._outdated = self._phase is not _Phase.STEPPING

    def _set_checked(self, vr: int, value: float) -> None:
        if vr not in self._references:
            self._unknown("Real", [vr])
            return
        variable = self._reals[vr]
        check_value(self.instance_name, variable, value)
        if interface.settable(variable, initialised=self._phase is _Phase.STEPPING):
            self._values[vr] = value
        else:
            self._fail(
                f"{self.instance_name}.{variable.name} = {quantity(value, variable.unit)}: "
                f"a {variable.variability} {variable.causality} cannot be set now"
            )

    def get_string(self, vrs: list[int]) -> list[str]:
        """Resource file names."""
        if self._texts.keys() >= set(vrs):
            return [self._instance.texts[self._texts[vr].name] for vr in vrs]
        return super().get_string(vrs)

    def set_string(self, vrs: list[int], values: list[str]) -> None:
        """Name resource files; they are read when an output is first needed."""
        for vr, value in zip(vrs, values, strict=True):
            if vr not in self._texts:
                self._unknown("String", [vr])
            elif self._phase is _Phase.STEPPING:
                name = self._texts[vr].name
                self._fail(f"{self.instance_name}.{name} = '{value}': it cannot be set now")
            else:
                self._instance.set(self._texts[vr].name, value)
                self._tables = ""
        self._outdated = self._phase is not _Phase.STEPPING

    def _get_fmu_state(self) -> FmuState:
        texts = dict(self._instance.texts)
        data = self._saved.tobytes()
        return FmuState(self._owner, data, texts, self._tables, int(self._phase), self._time)

    def _set_fmu_state(self, saved: FmuState | None) -> None:
        """Restore a state.

        Raises:
            FmuError: it is damaged, or belongs to another component, version or resource, or this
                FMU does.
        """
        self._failure = ""
        self._attempt(self._restore, saved)
        if self._failure:
            self._raise()

    def _restore(self, saved: FmuState | None) -> None:
        if self._unfit:
            raise FmuError(self._unfit)
        if saved is None or saved.owner != self._owner:
            raise FmuError(
                f"{self.instance_name}: the FMU state belongs to "
                f"'{saved.owner if saved else 'something else'}', not to '{self._owner}'; "
                "restore states of the same component and version only"
            )
        if len(saved.data) != self._saved.nbytes:
            raise FmuError(f"{self.instance_name}: the serialised FMU state is damaged")
        if saved.tables != self._tables:
            self._restore_resources(saved)
        if saved.data[self._first_parameter :] != self._saved[self._first_parameter :]:
            self._instance.work[:] = 0.0
        self._saved[:] = saved.data
        self._phase = _Phase(saved.phase)
        self._time = saved.time
        self._outdated = self._phase is not _Phase.STEPPING

    def _restore_resources(self, saved: FmuState) -> None:
        """Read the state's resources if none are read yet; otherwise they must be the same."""
        if not (saved.tables and self._tables):
            for name, text in saved.texts.items():
                self._instance.set(name, text)
            self._tables = ""
            if saved.tables:
                self._read_resources()
        if saved.tables != self._tables:
            files = ", ".join(f"{name} = '{text}'" for name, text in saved.texts.items())
            raise FmuError(
                f"{self.instance_name}: the FMU state was saved over other contents of {files}; "
                "restore it over the same resource files"
            )

    @staticmethod
    def _fmu_state_to_bytes(saved: FmuState | None) -> bytes:
        return state.to_bytes(saved) if saved else b""

    @staticmethod
    def _fmu_state_from_bytes(serialised: bytes) -> FmuState | None:
        return state.from_bytes(serialised)
