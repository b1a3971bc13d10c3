"""The Reference FMUs of the Modelica Association in this master and in fmpy: same bits.

They are built elsewhere (see `tests/campaigns/README.md`), and found in the folder that the
environment variable REFERENCE_FMUS names: all files `*.fmu` in it, of FMI 2.0 and 3.0.
"""

import os
import re
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi3 import FMU3Slave

import herringbone as hb
from herringbone.core import HerringboneError
from herringbone.cosim.structure.system import PartSpec, System

VARIABLE = "REFERENCE_FMUS"
FOLDER = os.environ.get(VARIABLE, "")
FILES = sorted(Path(FOLDER).rglob("*.fmu")) if FOLDER else []
WHY = f"{VARIABLE} names no folder with FMUs"
ALL = FILES or [pytest.param(None, marks=pytest.mark.skip(reason=WHY))]

STARTS = {
    "Feedthrough": {
        "Float32_continuous_input": 0.1, "Float64_continuous_input": 0.3,
        "Float64_discrete_input": -0.7, "Int8_input": -128, "UInt8_input": 255,
        "Int16_input": -(2**15), "UInt16_input": 2**16 - 1, "Int32_input": -(2**31),
        "UInt32_input": 2**32 - 1, "Int64_input": -(2**63), "UInt64_input": 2**64 - 1,
        "Boolean_input": True, "Enumeration_input": 2,
    },
    "Dahlquist": {"k": 0.7},
    "VanDerPol": {"mu": 1.3},
    "BouncingBall": {"e": 0.6},
}  # fmt: skip
"""Other than those of the description, as far as the FMU has such a variable."""
TEXTS = {"String": str, "Binary": bytes.hex}
"""Types that fmpy does not record, and how a result holds them."""
WITHOUT_EVENTS = {"Robertson Problem"}
"""It declares event mode, and does not instantiate with it; this master then does without."""
BINARY = {"Robertson Problem": 2.0**-10}
"""Steps [s] of those that step as they are told: fmpy tells a difference of two times."""
STEPS = 40


def step_of(model):
    """A communication step [s] that all of them take: a number of inner steps."""
    if model.modelName in BINARY:
        return BINARY[model.modelName]
    inner = model.coSimulation and model.coSimulation.fixedInternalStepSize
    shown = model.defaultExperiment.stepSize if model.defaultExperiment else None
    return float(inner or shown or 0.1)


def by_fmpy(file, model, step, start):
    """Rows of fmpy, and the outputs that these lack, by time."""
    declared = bool(getattr(model.coSimulation, "hasEventMode", False))
    events = declared and model.modelName not in WITHOUT_EVENTS
    texts = [v for v in model.modelVariables if v.causality == "output" and v.type in TEXTS]
    found = []

    def keep(time, recorder):
        slave = recorder.fmu
        if isinstance(slave, FMU3Slave):
            read = {"String": slave.getString, "Binary": slave.getBinary}
        else:
            read = {"String": slave.getString}
        values = (TEXTS[v.type](_text(read[v.type]([v.valueReference])[0], v.type)) for v in texts)
        found.append((time, *values))
        return True

    rows = fmpy.simulate_fmu(
        str(file), start_values=start, start_time=0.0, stop_time=STEPS * step, output_interval=step,
        use_event_mode=events, early_return_allowed=events, step_finished=keep,
        fmi_type="CoSimulation",
    )  # fmt: skip
    return rows, [v.name for v in texts], found


def _text(value, kind):
    return value.decode() if kind == "String" and isinstance(value, bytes) else value


@pytest.mark.parametrize("file", ALL, ids=lambda f: f and f"{f.parent.name}-{f.stem}")
def test_same_bits_as_fmpy(file):
    """All outputs of all types, with equal event settings; Clocks are refused in one line."""
    model = fmpy.read_model_description(str(file))
    system = System("one", "", (PartSpec("p", fmu=file),), ())
    clocks = [v.name for v in model.modelVariables if v.type == "Clock"]
    step = step_of(model)
    names = {v.name for v in model.modelVariables}
    start = {n: v for n, v in STARTS.get(model.modelName, {}).items() if n in names}
    given = {f"p.{name}": value for name, value in start.items()}
    grid = {"t_end": STEPS * step, "step": step, "record_step": step}
    if clocks:
        with pytest.raises(HerringboneError) as error:
            hb.run(system, **grid)
        assert re.search(f"has Clock variables[^:]*: {', '.join(clocks)}$", str(error.value))
        assert "\n" not in str(error.value)
        return
    ours = hb.run(system, values=given, **grid).data
    theirs, texts, later = by_fmpy(file, model, step, start)
    last = {round(t / step, 6): k for k, t in enumerate(theirs["time"])}
    rows = [last[round(t / step, 6)] for t in ours["time"]]
    compared = set()
    for name in theirs.dtype.names[1:]:
        columns = [c for c in ours if c == f"p.{name}" or c.startswith(f"p.{name}[")]
        found = np.column_stack([ours[c].to_numpy() for c in columns])
        expected = np.asarray(theirs[name])[rows].reshape(found.shape)
        assert found.tobytes() == expected.astype(found.dtype).tobytes(), name
        compared |= set(columns)
    for number, name in enumerate(texts, start=1):
        at = {round(row[0] / step, 6): row[number] for row in later}
        for time, value in zip(ours["time"][1:], ours[f"p.{name}"][1:], strict=True):
            assert value == at[round(time / step, 6)], name
        compared.add(f"p.{name}")
    outputs = [v.name for v in model.modelVariables if v.causality == "output"]
    assert {re.sub(r"\[.*", "", c) for c in compared} == {f"p.{name}" for name in outputs}
    assert compared == set(ours) - {"time"}


def test_there_are_all():
    """Those with co-simulation, of both versions of FMI: none was lost on the way."""
    if not FILES:
        pytest.skip(WHY)
    versions = {fmpy.read_model_description(str(file)).fmiVersion[0] for file in FILES}
    assert versions == {"2", "3"}
    assert len(FILES) >= 14
