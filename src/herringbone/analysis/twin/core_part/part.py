"""Own parts of a system as one participant of a co-simulation, by their condensed core."""

import ctypes
import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from herringbone.analysis.twin.condensed.march import BENDS, EVALUATIONS, STEPS
from herringbone.analysis.twin.condensed.march import HALVINGS as HALVED
from herringbone.analysis.twin.condensed.march_arrays import Samples
from herringbone.analysis.twin.condensed.rungs import Rungs
from herringbone.analysis.twin.core_part import answers, calls, stepping
from herringbone.analysis.twin.core_part.memory import SIZE, Signals, write
from herringbone.analysis.twin.core_part.variables import part_variables
from herringbone.analysis.twin.fused.core import Core, Steps
from herringbone.core import HerringboneError, ParameterError
from herringbone.core.declaring.declaration import INTERFACE_DEGREE
from herringbone.core.part import (
    Addresses,
    PartVariable,
    Value,
    ValueOrArray,
    is_signal_node,
)
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.cosim.rows.recording import CoreStatistics
from herringbone.kernels.signals import STRIDE

_INSIDE = STRIDE - 2
"""Nodes inside of a macro step, at the most."""
_MOST_LENGTHS = 64
"""Macro steps whose matrices are kept."""
_ASKED = ctypes.CFUNCTYPE(ctypes.c_int32, ctypes.c_int64, ctypes.c_double)


class CorePart:
    """The parts of a system as one part.

    Args:
        name: of the part.
        core: of the parts, with open inputs.
        inputs: its open inputs, `instance.variable`.
        sent: outputs that others take.
        others: further outputs that are recorded.
        steps: the longest base step, degree, and how close the laws are solved.

    Raises:
        StructureError: outputs do not follow from states and inputs alone.
    """

    of_parts = True
    """Its variables have the names of their parts."""

    def __init__(
        self,
        name: str,
        core: Core,
        inputs: Sequence[str],
        sent: Sequence[str],
        others: Sequence[str],
        steps: Steps,
    ) -> None:
        self.name, self._core = name, core
        self._names = {"inputs": tuple(inputs), "sent": tuple(sent), "others": tuple(others)}
        self.has_states: bool | None = True
        self.once = self.one_step = False
        self.variables: Mapping[str, PartVariable] = part_variables(core, inputs, sent, others)
        self._memory = np.zeros(SIZE, np.int64)
        self._kept: dict[str, object] = {}
        self._asked = _ASKED(self._answer)
        self._degree, self._why = 0, ""
        self._states: list[np.ndarray] = []
        self._matrices: dict[tuple[float, int], tuple[Rungs, Signals, Samples, int]] = {}
        self._initialising = False
        self.take(steps)

    def take(self, steps: Steps) -> None:
        """March with other steps; before the part is initialised."""
        self.steps, core = steps, self._core
        self._sent = core.outputs(self._names["sent"], steps, inside=True)
        self._others = core.outputs(self._names["others"], steps, inside=False)
        self._begin()

    def _begin(self) -> None:
        """Lay the memory out, at the start values of states and inputs."""
        core, names = self._core, self._names
        self._matrices, self._kept = {}, {}
        self._run = run = core.solution(self.steps)
        run.enter(0.0, 0.0)
        arrays, condensed = run.arrays, core.condensed
        n, size = len(names["inputs"]), arrays.state.q.size
        channels = condensed.equations.channels
        first = channels - 1 - n
        direct = np.ascontiguousarray(condensed.modes.of_channels[:, first : first + n])
        start = np.array([core.twin.block[core.twin.index(x)] for x in names["inputs"]])
        values = {k: self._observed(names[k]) for k in ("sent", "others")}
        ends = {
            k: _only_ends(o.rows_at(1.0, 0.0), size, channels)
            for k, o in (("sent", self._sent), ("others", self._others))
        }
        rows = max(e.shape[1] for e in ends.values())
        flags = np.zeros(9, np.int64)
        flags[[stepping.ENDS_KNOWN, stepping.INNER_KNOWN, stepping.REST_KNOWN]] = 1
        flags[stepping.DIRECT] = bool(direct.any())
        flags[stepping.ASK] = ctypes.cast(self._asked, ctypes.c_void_p).value or 0
        held = size + arrays.state.u.size
        self._signals = Signals(
            np.repeat(start, STRIDE), np.zeros(STRIDE), direct, start.copy(),
            np.repeat(values["sent"], STRIDE), values["others"],
            np.zeros((0, stepping.RUNGS, held, rows)), np.zeros((0, stepping.RUNGS), np.int64),
            ends["sent"], ends["others"], np.zeros(rows), np.zeros(channels),
            np.zeros(len(names["sent"])),
            np.full(6, np.nan), flags,
        )  # fmt: skip
        for key, tuple_ in arrays._asdict().items():
            write(self._memory, key, tuple_, self._kept)
        write(self._memory, "sent", self._sent.shown, self._kept)
        write(self._memory, "others", self._others.shown, self._kept)
        write(self._memory, "signals", self._signals, self._kept)
        saved = np.zeros(
            8
            + held
            + sum(a.size for a in (*arrays.nodes, *arrays.table))
            + n
            + self._signals.values.size
        )
        self._saved_size = calls.save(self._memory, saved)

    def _observed(self, names: Sequence[str]) -> np.ndarray:
        """Outputs at the start values."""
        twin = self._core.twin
        return twin.observe(np.zeros(1), twin.state[:, None], list(names))[0]

    def _answer(self, what: int, value: float) -> int:
        """What the compiled functions ask for, see `calls`; ANSWERED if it was made."""
        try:
            with one_blas_thread():
                if what == stepping.FOR_STEP:
                    self._lay_out(value)
                elif what == stepping.FOR_RUNG:
                    self._run.matrices.make(self._current[0], int(value))
                else:
                    self._make_rows(*divmod(int(value), stepping.RUNGS))
        except HerringboneError as error:
            self._why = str(error)
            return 0
        return stepping.ANSWERED

    def _lay_out(self, h: float) -> None:
        """Matrices for macro steps of a length [s]."""
        key = (h, self._degree)
        if key not in self._matrices:
            if len(self._matrices) >= _MOST_LENGTHS:
                self._matrices.clear()
            self._matrices[key] = self._made(h)
        rungs, signals, samples, per_step = self._current = self._matrices[key]
        signals.flags[[stepping.MADE_DEGREE, stepping.PER_STEP]] = self._degree, per_step
        signals.clock[[stepping.MADE_FOR, stepping.BASE_STEP]] = h, rungs.lengths[0]
        for name, held in (("rungs", rungs), ("samples", samples), ("signals", signals)):
            self._kept[name] = []
            write(self._memory, name, held, self._kept)

    def _made(self, h: float) -> tuple[Rungs, Signals, Samples, int]:
        per_step = max(1, math.ceil(h / self.steps.length * (1.0 - 1e-9)))
        inside = max(self._degree - 1, 0)
        state = self._run.state
        held = state.q.size + state.u.size
        samples = Samples(
            np.zeros(inside + 1), np.zeros((inside + 1, held)), *np.zeros((2, inside + 1))
        )
        signals = self._signals._replace(
            inner=np.zeros((inside, stepping.RUNGS, held, self._sent.shown.still.size)),
            made=np.zeros((inside, stepping.RUNGS), np.int64),
        )
        return self._run.matrices.of(h / per_step), signals, samples, per_step

    def _make_rows(self, node: int, rung: int) -> None:
        """Rows of the sent outputs at a node inside, in a step of a rung around it."""
        rungs, signals, _, per_step = self._current
        place = Fraction((node + 1) * per_step, self._degree) * 2**rung
        share = float(place - math.floor(place))
        signals.inner[node, rung] = self._sent.rows_at(float(rungs.lengths[rung]), share)
        signals.made[node, rung] = 1

    @property
    def addresses(self) -> Addresses:
        """Addresses of the compiled FMI functions; the component is the memory."""
        functions = (
            calls.set_real, calls.get_real, calls.do_step, calls.get_state, calls.set_state,
            calls.free_state,
        )  # fmt: skip
        return Addresses(self._memory.ctypes.data, *(f.address for f in functions))

    @property
    def statistics(self) -> CoreStatistics:
        """Of all steps, repeated ones too."""
        counted = self._run.state.counted
        length = float(self._signals.clock[stepping.BASE_STEP])
        found = (int(counted[k]) for k in (STEPS, HALVED, EVALUATIONS, BENDS))
        return CoreStatistics(self.steps.degree, length, *found)

    def new_state(self) -> int:
        """Memory for a saved state."""
        self._states.append(np.zeros(self._saved_size))
        return self._states[-1].ctypes.data

    def set(self, name: str, value: ValueOrArray) -> None:
        """Set an input before or during initialisation, or the degree of the signals."""
        number = float(value)  # type: ignore[arg-type]  # a number
        if name == INTERFACE_DEGREE:
            self._degree = int(number)
            self._signals.flags[stepping.DEGREE] = self._degree
        elif name in self._names["inputs"]:
            self._core.twin.block[self._core.twin.index(name)] = number

    def get(self, names: Sequence[str]) -> list[float]:
        """Values of inputs and outputs; in initialisation mode they belong to the inputs set."""
        if self._initialising:
            known = [name for name in names if not is_signal_node(self.variables, name)]
            values = dict(zip(known, self._observed(known), strict=True))
            return [float(values.get(name, 0.0)) for name in names]
        references = np.array([self.variables[name].reference for name in names], np.uint32)
        found = np.zeros(references.size)
        answers.read(self._memory, references, references.size, found)
        return found.tolist()

    def put_values(self, values: Mapping[str, Value]) -> None:
        """It has no variables of other types than real; raises ParameterError."""
        raise ParameterError(f"{self.name}: {', '.join(values)}: it takes reals alone")

    def get_values(self, names: Sequence[str]) -> list[Value]:
        """It has no variables of other types than real."""
        del names
        return []

    def enter_initialization(
        self, start_time: float, stop_time: float, tolerance: float | None = None
    ) -> None:
        """Outputs follow inputs from now on."""
        del start_time, stop_time, tolerance
        self._initialising = True

    def exit_initialization(self) -> None:
        """Begin to march; from now on only steps change outputs."""
        self._initialising = False
        degree = self._signals.flags[stepping.DEGREE]
        self._begin()
        self._signals.flags[stepping.DEGREE] = degree

    def failed(self) -> None:
        """Nothing to be told: it has nothing to free."""

    def ended(self) -> None:
        """It never asks to end the simulation."""

    def messages(self) -> list[str]:
        """Why the last step failed."""
        said = stepping.why(int(self._signals.flags[stepping.STATUS]))
        return [text for text in (self._why, said) if text]

    def close(self) -> None:
        """Nothing to free."""


def _only_ends(rows: np.ndarray, size: int, channels: int) -> np.ndarray:
    """Rows at the start of a step, over the state and one value of each channel."""
    nodes = (len(rows) - size) // channels
    return np.ascontiguousarray(np.concatenate([rows[:size], rows[size::nodes]]))
