"""Sound and sensors as questions: what a run's results say of them, from lines alone."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.figures.radiated_power import radiated_power
from herringbone.analysis.figures.sensing.sensors import sensor_figures
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.core import ParameterError
from herringbone.running.operating.questions import answers, questions_of
from herringbone.scenes import Ask

_STILL = {"gear_mesh.symmetry_deviation": 0.0}
_FINE = {f"{name}.sampling_hz": 5000.0 for name in "ABC"}
_ASKS = (Ask(("radiated power",), Form.LEVEL), Ask(("sensor",)), Ask(("sensor B",)))


@pytest.fixture(scope="module")
def state():
    return hb.steady("test_rig", values={**_STILL, **_FINE}, tolerance=1e-4)


@pytest.fixture(scope="module")
def run():
    values = {**_STILL, **_FINE}
    return hb.run("test_rig", values=values, t_end=0.5, record_step=1e-5, fuse=True, tolerance=1e-4)


def _questions(state) -> list[Question]:
    return questions_of(state.structure.core, _ASKS)


def test_power_is_that_of_a_run_that_has_settled(state, run):
    power = lines_of(state, _questions(state)[0])
    total = power.coefficients[0, 1:].real.sum()
    # what rings from the start, in the lowest mode (1 % at 249 Hz), has 4 % of the power there, and
    # over the steady part, from 0.1 s on, 3.5e-3 of that
    assert total == pytest.approx(radiated_power(run).total, rel=2e-4)
    (line, *_) = answers(state, _ASKS)
    assert f"{10.0 * math.log10(total / 1e-12):.1f} dB" in line


def test_sensors_are_those_of_a_run_that_has_settled(state, run):
    lines = lines_of(state, _questions(state)[1])
    sizes = math.sqrt(2.0) * np.linalg.norm(lines.coefficients[:, 1:], axis=1)
    seen, _ = sensor_figures(run)
    # samples every 0.2 ms of whole mesh periods; filters in discrete time against continuous ones
    for name, size in zip("ABC", sizes, strict=True):
        assert size == pytest.approx(seen[name].rms, rel=5e-3)
    (alone,) = lines_of(state, _questions(state)[2]).coefficients
    assert alone == pytest.approx(lines.coefficients[1], rel=1e-12)


def test_a_power_counts_as_a_power_and_not_as_an_amplitude(state):
    question = _questions(state)[0]
    lines = lines_of(state, question)
    louder = lines._replace(coefficients=1.1 * lines.coefficients)
    assert apart(question, louder, lines).error == pytest.approx(0.1, rel=1e-12)


def test_what_is_asked_together_is_answered_apart(state):
    ask = Ask(("bearing force", "sensor A", "radiated_power", "sensor_C"))
    found = questions_of(state.structure.core, (ask,))
    assert [question.outputs for question in found[1:]] == [
        ("A", "C"),
        ("gearbox.modal_housing",),
    ]


@pytest.mark.parametrize(
    ("what", "names"),
    [
        (("sensor input_shaft",), ("input_shaft",)),
        (("Sensor_input_shaft", "sensor C"), ("input_shaft", "C")),
        (("sensor C", "sensors"), ("input_shaft", "B", "C")),
    ],
)
def test_sensors_are_meant_by_their_own_names(state, what, names):
    system = state.structure.core.twin.system
    own = {"input_shaft" if name == "A" else name: spec for name, spec in system.sensors.items()}
    core = SimpleNamespace(twin=SimpleNamespace(system=replace(system, sensors=own)))
    (question,) = questions_of(core, (Ask(what),))
    assert question.outputs == names


@pytest.mark.parametrize(
    ("system", "ask", "message"),
    [
        ("test_rig", Ask(("sensor D",)), "no sensor 'D'; there are: A, B, C"),
        ("gearbox", Ask(("sensors",)), "no sensors"),
        ("test_rig", Ask(("radiated power",), Form.SIGNAL), "ask for it as level"),
    ],
)
def test_what_is_not_there_is_refused(system, ask, message):
    with pytest.raises(ParameterError, match=message):
        hb.plan(system, scene=hb.Scene("asking", asks=(ask,)))
