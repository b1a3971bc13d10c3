"""Parts in units of their own: the same run as in SI units, recorded in their units; or refused.

And what parts of FMI 2.0 say of their end, and of angles."""

import math
import os
import re
from pathlib import Path

import numpy as np
import pytest
from support.foreign.c_fmu import compiled_fmu

import herringbone as hb
from herringbone.core import HerringboneError, OutcomeKind

SOURCE = Path(__file__).parents[3] / "fmus" / "turning_mass.c"
pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")

TURN = {"rad": (1.0, 'rad="1"'), "deg": (math.pi / 180.0, 'rad="1"')}
SPEED = {"rad/s": (1.0, 'rad="1" s="-1"'), "r/min": (math.pi / 30.0, 'rad="1" s="-1"')}
TORQUE = {"N.m": (1.0, 'kg="1" m="2" s="-2"'), "N.mm": (1e-3, 'kg="1" m="2" s="-2"')}
NAMES = ["inertia", "angle_unit", "speed_unit", "torque_unit", "wrap", "start"]


def description(units, more=""):
    """Of a mass whose torque, angle and speed have these units, each (name, factor, exponents)."""
    parameters = "\n".join(
        f'<ScalarVariable name="{name}" valueReference="{k}" causality="parameter"'
        f' variability="fixed"><Real start="{0 if k > 3 else 1}"/></ScalarVariable>'
        for k, name in enumerate(NAMES)
    )
    definitions = "\n".join(
        f'<Unit name="{name}">'
        + (f'<BaseUnit {exponents} factor="{factor!r}"/>' if exponents else "")
        + "</Unit>"
        for name, factor, exponents in units
    )
    tau, phi, w = (name for name, _, _ in units)
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="turning_mass" guid="t"
 numberOfEventIndicators="0">
<CoSimulation modelIdentifier="turning_mass" canHandleVariableCommunicationStepSize="true"
 canGetAndSetFMUstate="true"{more}/>
<UnitDefinitions>{definitions}</UnitDefinitions>
<ModelVariables>
{parameters}
<ScalarVariable name="flange.tau" valueReference="6" causality="input">
<Real start="0" unit="{tau}"/></ScalarVariable>
<ScalarVariable name="flange.phi" valueReference="7" causality="output">
<Real unit="{phi}"/></ScalarVariable>
<ScalarVariable name="flange.w" valueReference="8" causality="output">
<Real unit="{w}"/></ScalarVariable>
<ScalarVariable name="end" valueReference="9" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
<ScalarVariable name="refuses" valueReference="10" causality="parameter" variability="fixed">
<Real start="0"/></ScalarVariable>
</ModelVariables>
<ModelStructure><Outputs><Unknown index="8" dependencies=""/><Unknown index="9" dependencies=""/>
</Outputs></ModelStructure>
</fmiModelDescription>
"""


@pytest.fixture(scope="module")
def mass(tmp_path_factory):
    """Function: the FMU with units for torque, angle and speed, and the values that say so."""

    def build(*units):
        folder = tmp_path_factory.mktemp("mass")
        file = compiled_fmu(SOURCE, description(units), folder)
        sizes = zip(("torque_unit", "angle_unit", "speed_unit"), units, strict=True)
        return file, {name: factor for name, (_, factor, _) in sizes}

    return build


def named(torque, angle, speed):
    return (torque, *TORQUE[torque]), (angle, *TURN[angle]), (speed, *SPEED[speed])


def system(folder, first, second):
    """Two masses on a shaft coupling, as a folder."""
    folder.mkdir(exist_ok=True)
    (folder / "system.toml").write_text(
        'connections = [["one.flange", "shaft.flange_a"], ["shaft.flange_b", "two.flange"]]\n'
        "[parts]\n"
        f'one = {{ fmu = "{first}" }}\nshaft = {{ component = "shaft_coupling" }}\n'
        f'two = {{ fmu = "{second}" }}\n',
        encoding="utf-8",
    )
    return folder


def run(folder, sizes, **options):
    values = {f"one.{name}": value for name, value in sizes.items()}
    values |= {"one.inertia": 0.1, "two.inertia": 0.3, "one.start": 100.0, "two.start": 90.0}
    given = {"t_end": 0.02, "step": 1e-4, **options}
    return hb.run(folder, values=values, start="rest", **given)


@pytest.mark.parametrize("algorithm", ["jacobi:order=1", "li", None])
def test_same_run_in_any_units(tmp_path, mass, algorithm):
    """Rounding of the conversions alone: 1e-10 of the values, over 200 steps of a stiff shaft."""
    plain, si = mass(*named("N.m", "rad", "rad/s"))
    own, sizes = mass(*named("N.mm", "deg", "r/min"))
    true = run(system(tmp_path / "si", plain, plain), si, algorithm=algorithm)
    found = run(system(tmp_path / "own", own, plain), sizes, algorithm=algorithm)
    assert np.ptp(true["shaft.flange_a.tau"]) > 1.0
    for column in true.data:
        factor = {"one.flange.phi": TURN["deg"][0], "one.flange.w": SPEED["r/min"][0]}
        values = found.data[column] * factor.get(column, 1.0)
        size = np.abs(true.data[column]).max()
        np.testing.assert_allclose(values, true.data[column], rtol=0.0, atol=1e-10 * size)
    assert (found.units["one.flange.phi"], found.units["one.flange.w"]) == ("deg", "r/min")
    assert found["one.flange.w"][0] == pytest.approx(100.0 * 30.0 / math.pi, rel=1e-14)


@pytest.mark.parametrize(
    ("unit", "said"),
    [
        (("r/min", 1.0, ""), "'r/min' and 'rad/s', and 'r/min' has no definition by base units"),
        (("Hz", 1.0, 's="-1"'), "'shaft.flange_a.w': units differ, 'Hz' and 'rad/s'"),
        (("r/min", 0.0, SPEED["r/min"][1]), "one: unit 'r/min' has the factor 0"),
    ],
)
def test_what_cannot_be_converted_is_refused(tmp_path, mass, unit, said):
    plain, _ = mass(*named("N.m", "rad", "rad/s"))
    own, sizes = mass(*named("N.m", "rad", "rad/s")[:2], unit)
    with pytest.raises(HerringboneError, match=re.escape(said)) as error:
        run(system(tmp_path / "s", own, plain), sizes | {"speed_unit": 1.0}, algorithm="li")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("unit", ["rad", "deg", ""])
def test_wrapped_angle_is_noticed(tmp_path, mass, unit):
    """At 100 rad/s the first turn is complete after 62.8 ms; alone, so that nothing breaks.

    Where no unit is declared its name tells.
    """
    file, sizes = mass(*named("N.m", unit or "rad", "rad/s"))
    if not unit:
        text = description(named("N.m", "rad", "rad/s")).replace('<Real unit="rad"/>', "<Real/>")
        file = compiled_fmu(SOURCE, text, tmp_path)
    (tmp_path / "system.toml").write_text(f'[parts]\none = {{ fmu = "{file}" }}\n')
    values = {f"one.{name}": value for name, value in sizes.items()} | {"one.start": 100.0}
    for wrap in (0.0, 1.0):
        result = hb.run(tmp_path, values={**values, "one.wrap": wrap}, t_end=0.1, record_step=1e-3)
        notes = [note for note in result.info.notes if "wraps its angle" in note]
        assert len(notes) == wrap
    assert notes[0].startswith("one.flange.phi jumps by a turn at 0.063 s: ")
    assert notes[0].endswith("; nothing is connected to it")


@pytest.mark.parametrize(("angle", "speed"), [("rad", "rad/s"), ("deg", "rad/s"), ("rad", "r/min")])
def test_what_a_wrapped_angle_does_to_others(tmp_path, mass, angle, speed):
    """In any units; the two turn at 92.5 rad/s together, once in 67.9 ms."""
    file, sizes = mass(*named("N.m", angle, speed))
    plain, _ = mass(*named("N.m", "rad", "rad/s"))
    folder, values = system(tmp_path / "s", file, plain), {**sizes, "wrap": 1.0}
    result = run(folder, values, t_end=0.068, record_step=1e-3)
    (note,) = (note for note in result.info.notes if "wraps its angle" in note)
    assert note.startswith("one.flange.phi jumps by a turn at 0.068 s: ")
    assert "what is connected to it is twisted by 2 pi" in note


@pytest.mark.parametrize("end", [0.05, 0.0525])
def test_fmi2_part_that_ends_the_simulation(tmp_path, mass, end):
    """By fmi2Discard, fmi2Terminated and fmi2LastSuccessfulTime; alone it is recorded there."""
    file, _ = mass(*named("N.m", "rad", "rad/s"))
    (tmp_path / "system.toml").write_text(f'[parts]\none = {{ fmu = "{file}" }}\n')
    values = {"one.start": 100.0, "one.end": end}
    result = hb.run(tmp_path, values=values, t_end=0.1, record_step=0.01)
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.ENDED, "one")
    assert result.outcome.message == f"one ended the simulation at {end:g} s"
    assert result.data["time"].iloc[-1] == pytest.approx(end, rel=1e-12)
    assert result.data["one.flange.phi"].iloc[-1] == pytest.approx(100.0 * end, rel=1e-12)
    found = hb.run(tmp_path, values={**values, "one.refuses": 1.0}, t_end=0.1, record_step=0.02)
    assert found.outcome.kind is OutcomeKind.PART_FAILED
    assert (
        f"the part came to {end:g} s; if it discarded the step, a smaller one"
        in found.outcome.message
    )


def test_a_step_that_goes_on_behind_do_step_is_told(tmp_path):
    """FMI 2.0's asynchronous steps: the file ends the process if it is asked anything meanwhile."""
    text = description(named("N.m", "rad", "rad/s"), ' canRunAsynchronuously="true"')
    file = compiled_fmu(SOURCE, text, tmp_path)
    (tmp_path / "system.toml").write_text(f'[parts]\none = {{ fmu = "{file.name}" }}\n')
    values = {"one.start": 100.0, "one.end": 0.05, "one.refuses": 2.0}
    result = hb.run(tmp_path, values=values, t_end=0.1, record_step=0.02)
    assert result.outcome.kind is OutcomeKind.PART_FAILED
    assert result.outcome.message.endswith(
        "its step goes on after doStep has returned (canRunAsynchronuously, fmi2Pending), and "
        "nobody waits for that here; let it step before it returns"
    )
    assert result.data["time"].iloc[-1] == pytest.approx(0.04)


@pytest.mark.parametrize("options", [{"step": None, "tolerance": 1e-3}, {"step": 1e-4}])
def test_the_error_of_a_run_that_a_part_ends_is_told(tmp_path, mass, options):
    """As of one that completes, up to there; a tolerance is met."""
    file, _ = mass(*named("N.m", "rad", "rad/s"))
    result = run(system(tmp_path / "s", file, file), {"end": 0.015}, **options)
    assert result.outcome.kind is OutcomeKind.ENDED
    assert result.outcome.time == pytest.approx(0.015, rel=1e-9)
    assert 0.0 < result.verification.error <= 1e-3
    assert result.outcome.message.endswith("ended the simulation at 0.015 s")


def test_an_unknown_error_is_told_beside_the_part_that_ends_the_run(tmp_path, mass, monkeypatch):
    """After one run alone, in the first line."""
    monkeypatch.setattr("herringbone.running.steps.search._RUNS", 1)
    file, _ = mass(*named("N.m", "rad", "rad/s"))
    result = run(system(tmp_path / "s", file, file), {"end": 0.015}, step=None, tolerance=1e-3)
    assert result.outcome.kind is OutcomeKind.ENDED
    assert result.verification.missed
    assert result.outcome.message.startswith(
        "one ended the simulation at 0.015 s; whether tolerance = 0.001 is met is not known: "
    )
