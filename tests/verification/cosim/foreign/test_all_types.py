"""FMUs with variables of all types: recorded as fmpy does, set, connected, ended, with events."""

import json
import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd
import pytest
from support.foreign.all_types import EVENTS, KINDS, build_all_types

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import HerringboneError, OutcomeKind
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import read_system

SELECTOR = Path(__file__).parents[3] / "fmus" / "selector.py"
pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")

LARGE = {
    "Int8": -(2**7), "UInt8": 2**8 - 1, "Int16": -(2**15), "UInt16": 2**16 - 1,
    "Int32": -(2**31), "UInt32": 2**32 - 1, "Int64": -(2**63), "UInt64": 2**64 - 1,
    "Boolean": True, "String": 'ä, "quoted"', "Binary": "00ff7f", "Enumeration": 2,
    "Float32": 0.1,
}  # fmt: skip
"""Values that a double or a narrower type would not keep."""
TYPES = {
    **{kind: kind.lower() for kind in KINDS if "Int" in kind},
    "Boolean": "bool", "Enumeration": "int64", "Float32": "float32",
}  # fmt: skip


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The FMU 3.0 without and with event mode."""
    folders = {name: tmp_path_factory.mktemp(name) for name in ("plain", "events")}
    abilities = {"plain": "", "events": EVENTS}
    return {name: build_all_types(folder, abilities[name]) for name, folder in folders.items()}


@pytest.fixture(scope="module")
def selector(tmp_path_factory):
    """The FMU 2.0 of pythonfmu."""
    folder = tmp_path_factory.mktemp("selector")
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(SELECTOR), "-d", str(folder)]
    subprocess.run([*command, "--no-external-tool"], check=True, capture_output=True)
    return folder / "Selector.fmu"


def alone(file):
    return System("one", "", (PartSpec("p", fmu=file),), ())


def two(file, *connections):
    return System("two", "", (PartSpec("a", fmu=file), PartSpec("b", fmu=file)), connections)


def run(system, values, t_end=1.0, record_step=0.1, **options):
    named = {name if "." in name else f"p.{name}": value for name, value in values.items()}
    return hb.run(system, values=named, t_end=t_end, record_step=record_step, **options)


def refused(said, *arguments, **options):
    with pytest.raises(HerringboneError, match=re.escape(said)) as error:
        run(*arguments, **options)
    assert "\n" not in str(error.value)


# -- records and start values ---------------------------------------------------------------------


@pytest.mark.parametrize("name", ["plain", "events"])
def test_all_types_are_recorded_without_loss(files, name, tmp_path):
    values = {f"{kind}_in": value for kind, value in LARGE.items()}
    result = run(alone(files[name]), values)
    for kind, value in LARGE.items():
        column = result.data[f"p.{kind}_out"]
        expected = np.float32(value) if kind == "Float32" else value
        assert (column == expected).all()
        assert str(column.dtype) == TYPES.get(kind, str(column.dtype))
    assert (result.units["p.Float32_out"], result.units["p.Int8_out"]) == ("mm", "")
    result.to_csv(tmp_path / "r.csv")
    kinds = {f"p.{kind}_out": found for kind, found in TYPES.items()}
    again = pd.read_csv(tmp_path / "r.csv", comment="#", dtype={**kinds, "p.Binary_out": str})
    for column in result.data:
        assert (again[column] == result.data[column]).all()


@pytest.mark.parametrize("every", [0.0, 0.125, 0.1625])
@pytest.mark.parametrize("name", ["plain", "events"])
def test_same_bits_as_fmpy(files, name, every):
    """With equal event settings; fmpy has further rows, at the events.

    The step is a power of two: fmpy takes the difference of two times as a step.
    """
    events = name == "events"
    start = {f"{kind}_in": v for kind, v in LARGE.items() if kind not in {"String", "Binary"}}
    start |= {"every": every, "u": [1.0, 0.7], "pair": [5, 6], "d": 0.3}
    theirs = fmpy.simulate_fmu(
        str(files[name]), start_values=start, stop_time=1.0, output_interval=0.125,
        use_event_mode=events, early_return_allowed=events,
    )  # fmt: skip
    ours = run(alone(files[name]), start, record_step=0.125)
    last = {round(t, 9): k for k, t in enumerate(theirs["time"])}
    rows = [last[round(t, 9)] for t in ours.data["time"]]
    compared = 0
    for column in theirs.dtype.names[1:]:
        values = np.asarray(theirs[column])[rows].reshape(len(rows), -1)
        names = [c for c in ours.data if c == f"p.{column}" or c.startswith(f"p.{column}[")]
        found = np.column_stack([ours.data[c].to_numpy() for c in names])
        assert found.tobytes() == values.astype(found.dtype).tobytes(), column
        compared += len(names)
    assert compared == ours.data.shape[1] - 3  # fmpy records neither time so, nor texts, nor bytes
    assert ours.data["p.events"].iloc[-1] == (0 if every == 0.0 else int(1.0 / every + 1e-9))


def test_structural_parameter_resizes_arrays(files):
    """y is the integral of u; what is set first or last does not matter."""
    result = run(alone(files["plain"]), {"u": [1, 2, 3, 4], "u[2]": 5, "n": 4, "m": "1 2 3 5"})
    found = [result.data[f"p.y[{k}]"].iloc[-1] for k in (1, 2, 3, 4)]
    np.testing.assert_allclose(found, [1.0, 5.0, 3.0, 4.0], rtol=1e-14)
    turned = [result.data[f"p.turned[{i},{k}]"][0] for i in (1, 2) for k in (1, 2)]
    assert turned == [1.0, 3.0, 2.0, 5.0]
    assert "p.y[3]" not in run(alone(files["plain"]), {}).data


def test_values_of_toml_and_command_line(files, tmp_path, capsys):
    (tmp_path / "system.toml").write_text(
        f'[parts.p]\nfmu = "{files["plain"]}"\n'
        'set = { n = 3, u = [1.0, 2.0, 3.0], Boolean_in = true, Enumeration_in = "second",'
        " Int64_in = 9007199254740993 }\n"
    )
    options = ["--set", "p.UInt64_in=18446744073709551615", "--set", 'p.String_in="5"']
    ends = ["--t-end", "1", "--record-step", "0.5", "-o", str(tmp_path / "out"), "--json"]
    assert main(["run", str(tmp_path), *options, *ends]) == 0
    assert json.loads(capsys.readouterr().out)["outcome"] == "completed"
    last = pd.read_csv(tmp_path / "out" / "results.csv", comment="#", dtype=str).iloc[-1]
    expected = {
        "Int64": "9007199254740993", "UInt64": "18446744073709551615", "String": "5",
        "Boolean": "True", "Enumeration": "2",
    }  # fmt: skip
    assert {kind: last[f"p.{kind}_out"] for kind in expected} == expected
    assert float(last["p.y[3]"]) == pytest.approx(3.0, rel=1e-14)
    assert "columns of integers, truth values, texts or bytes" in (
        tmp_path / "out" / "summary.txt"
    ).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"Int8_in": 128}, "p.Int8_in = 128: the type Int8 goes from -128 to 127"),
        ({"UInt64_in": -1}, "the type UInt64 goes from 0 to 18446744073709551615"),
        ({"Int32_in": 0.5}, "p.Int32_in = 0.5: its type is Int32, it takes a whole number"),
        ({"Boolean_in": 2}, "p.Boolean_in = 2: it takes a Boolean, true or false"),
        ({"Enumeration_in": 3}, "it takes an Enumeration, one of 1 ('first'), 2 ('second')"),
        ({"Binary_in": "0g"}, "it takes a Binary, as hexadecimal digits"),
        ({"String_in": 1.0}, "p.String_in = 1.0: it takes a String"),
        ({"Float32_in": 1e39}, "p.Float32_in = 1e+39: it is too large for a Float32"),
        ({"u": [1.0]}, "p.u = [1.0]: it takes 2 values of type Float64, not 1"),
        ({"u": "1 x"}, "'x' is no number"),
        ({"u[3]": 1.0}, "has no variable 'u[3]'"),
        ({"Int8_in": [1]}, "p.Int8_in = [1]: it takes one Int8"),
        ({"n": 5}, "p.n = 5: n is at most 4"),
    ],
)
def test_wrong_values_are_refused(files, values, said):
    refused(said, alone(files["plain"]), values)


# -- connections ----------------------------------------------------------------------------------

ALL = [(f"a.{kind}_out", f"b.{kind}_in") for kind in KINDS]


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "jacobi:order=2", "li", "fixed_point"])
@pytest.mark.parametrize("name", ["plain", "events"])
def test_connected_types_hold_over_a_step(files, name, algorithm):
    """a counts events every 35 ms; b shows a step later what a showed, in steps of 10 ms."""
    system = two(files[name], *ALL[:4], *ALL[5:], ("a.events", "b.Int32_in"), ("a.y", "b.u"))
    system = System("t", "", system.parts, (*system.connections, ("a.swapped", "b.pair")))
    values = {f"a.{kind}_in": value for kind, value in LARGE.items()}
    values |= {"a.every": 0.035, "a.u": [1.0, 2.0], "a.pair": [3, 4]}
    result = run(system, values, t_end=0.2, record_step=0.01, step=0.01, algorithm=algorithm)
    assert result.outcome.completed
    counted = np.floor(result.data["time"] / 0.035 + 1e-6).astype(int)
    assert result.data["a.events"].tolist() == counted.tolist()
    assert result.data["b.Int32_out"].tolist() == [0, *counted[:-1]]
    for kind in KINDS:
        if kind != "Int32":
            assert result.data[f"b.{kind}_out"].iloc[-1] == result.data[f"a.{kind}_out"].iloc[-1]
    assert [result.data[f"b.swapped[{k}]"].iloc[-1] for k in (1, 2)] == [3, 4]
    assert any("held over the step" in note for note in result.info.notes)


def test_integers_reach_wider_types_and_reals(files):
    """A real input takes them at communication points, also beside those of the loop."""
    wide = [("a.events", "b.Int64_in"), ("a.events", "b.d"), ("a.Int16_out", "b.Float32_in")]
    values = {"a.every": 0.1, "a.Int16_in": -7}
    result = run(two(files["plain"], *wide), values, t_end=1.0, step=0.05)
    assert result.data["b.Int64_out"].iloc[-1] == 9
    assert result.data["b.d_out"].iloc[-1] == 9.0
    assert result.data["b.Float32_out"].iloc[-1] == np.float32(-7.0)


@pytest.mark.parametrize("name", ["plain", "events"])
def test_value_that_is_refused_ends_the_run_with_its_results(files, name):
    system = two(files[name], ("a.UInt64_out", "b.UInt64_in"), ("a.y", "b.u"))
    values = {"a.UInt64_in": 13, "a.u": [1.0, 2.0]}
    result = run(system, values, t_end=1.0, step=0.1, algorithm="li")
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.PART_FAILED, "b")
    assert result.outcome.message == "b.UInt64_in = 13: 13 is refused, at 0.1 s"
    assert result.data["a.y[2]"].tolist() == pytest.approx([0.0, 0.2], rel=1e-12)


def test_adaptive_step_exchanges_at_its_own_points(files):
    system = two(files["plain"], ("a.y", "b.u"), ("b.y", "a.u"), ("a.events", "b.Int32_in"))
    options = {"algorithm": "li", "tolerance": 1e-3, "step": 0.01, "record_step": 1e-4}
    result = run(system, {"a.every": 0.035}, t_end=0.2, **options)
    counted = result.data["a.events"].to_numpy()
    assert counted[-1] == 5
    assert result.data["b.Int32_out"].tolist() == [0, *counted[:-1]]


@pytest.mark.parametrize(
    ("connection", "said"),
    [
        (("a.Int64_out", "b.Int32_in"), "a Int64 does not fit into a Int32 without loss"),
        (("a.y", "b.pair"), "'a.y[1]' -> 'b.pair[1]': a Float64 does not fit into a Int32"),
        (("a.turned", "b.u"), "'a.turned' has 4 elements and 'b.u' has 2 elements"),
        (("a.Boolean_out", "b.Int8_in"), "a Boolean does not fit into a Int8 without loss"),
    ],
)
def test_what_does_not_fit_is_refused(files, connection, said):
    refused(said, two(files["plain"], connection), {})


# -- FMI 2.0 --------------------------------------------------------------------------------------


def test_types_of_fmi2(selector):
    pairs = [(f"a.{n}_shown", f"b.{n}") for n in ("gear", "engaged", "label")]
    values = {"a.gear": 3, "a.engaged": True, "a.label": "drei, ä"}
    result = run(two(selector, *pairs), values, t_end=0.5, record_step=0.1, step=0.1)
    assert result.data["b.gear_shown"].tolist() == [1, 1, 3, 3, 3, 3]
    assert result.data["b.engaged_shown"].tolist() == [False, False, True, True, True, True]
    assert result.data["b.label_shown"].tolist() == ["", "", *["drei, ä"] * 4]
    assert result.data["b.torque"].tolist() == [0.0, 0.0, 30.0, 30.0, 30.0, 30.0]
    assert [str(result.data[f"a.{n}"].dtype) for n in ("steps", "engaged_shown")] == [
        "int32", "bool"
    ]  # fmt: skip


# -- the end, and events --------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["plain", "events"])
@pytest.mark.parametrize("end", [0.5, 0.45])
def test_part_that_ends_the_simulation(files, name, end):
    """Alone it is recorded where it ends; its last step is the last."""
    result = run(alone(files[name]), {"end": end, "u": [1.0, 0.0]})
    assert result.outcome.kind is OutcomeKind.ENDED
    assert result.outcome.message == f"p ended the simulation at {end:g} s"
    assert result.data["time"].iloc[-1] == pytest.approx(end, rel=1e-12)
    assert result.data["p.y[1]"].iloc[-1] == pytest.approx(end, rel=1e-12)
    assert len(result.data) == 6


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "li"])
def test_one_of_two_parts_ends(files, algorithm, tmp_path, capsys):
    """Results up to there are kept, and the command succeeds: that end was wanted."""
    (tmp_path / "system.toml").write_text(
        'connections = [["a.y", "b.u"]]\n[parts]\n'
        + "".join(f'{part} = {{ fmu = "{files["plain"]}" }}\n' for part in "ab")
    )
    options = ["--algorithm", algorithm, "--step", "0.01", "--t-end", "1", "--record-step", "0.1"]
    values = ["--set", "b.end=0.5", "--set", "a.u=1 2"]
    output = ["--json", "-o", str(tmp_path / "out")]
    assert main(["run", str(tmp_path), *options, *values, *output]) == 0
    found, said = capsys.readouterr()
    summary = json.loads(found)
    assert (summary["outcome"], summary["culprit"]) == ("ended_by_part", "b")
    assert "ended_by_part: b ended the simulation at 0.5 s" in said
    rows = pd.read_csv(tmp_path / "out" / "results.csv", comment="#")
    np.testing.assert_allclose(rows["time"], np.arange(6) * 0.1, rtol=1e-12)
    np.testing.assert_allclose(rows["a.y[2]"], np.arange(6) * 0.2, rtol=1e-12)


def test_events_that_never_settle(files):
    refused("its discrete states do not settle", alone(files["events"]), {"restless": 1.0})


def test_events_inside_a_step_do_not_change_what_is_integrated(files):
    """13 events in steps of 0.1 s: early returns and the rests of the steps make whole steps."""
    result = run(alone(files["events"]), {"every": 0.073, "u": [1.0, 2.0]})
    assert result.data["p.events"].iloc[-1] == 13
    assert result.data["p.y[2]"].iloc[-1] == pytest.approx(2.0, rel=1e-12)


def edited_copy(file, folder, old, new):
    """The FMU alone, with another description."""
    with zipfile.ZipFile(file) as whole, zipfile.ZipFile(folder / "x.fmu", "w") as copy:
        for name in whole.namelist():
            data = whole.read(name)
            copy.writestr(name, data.replace(old, new) if name.endswith(".xml") else data)
    return alone(folder / "x.fmu")


def test_event_mode_that_is_declared_and_refused_is_not_used(files, tmp_path):
    system = edited_copy(files["events"], tmp_path, b'Token="t"', b'Token="no events"')
    result = run(system, {"every": 0.13})
    assert result.outcome.completed
    assert result.data["p.events"].iloc[-1] == 7


def test_adaptive_run_ends_where_a_part_ends(files):
    system = two(files["plain"], ("a.y", "b.u"), ("b.y", "a.u"))
    options = {"algorithm": "li", "tolerance": 1e-3, "step": 0.01, "record_step": 1e-3}
    result = run(system, {"b.end": 0.1}, t_end=0.2, **options)
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.ENDED, "b")
    assert result.outcome.time == pytest.approx(0.1, rel=1e-9)


def test_descriptions_that_are_refused(files, tmp_path):
    def edited(old, new):
        return edited_copy(files["plain"], tmp_path, old, new)

    clock = b'<Clock name="tick" valueReference="300" causality="input"'
    clock += b' intervalVariability="triggered"/></ModelVariables>'
    refused("has Clock variables, which are not supported: tick",
            edited(b"</ModelVariables>", clock), {})  # fmt: skip
    refused("array 'm' has 10000000000 elements; 100000 are possible at the most",
            edited(b'<Dimension start="2"/><Dimension start="2"/>',
                   b'<Dimension start="100000"/><Dimension start="100000"/>'), {})  # fmt: skip
    refused("variable 'Enumeration_in': an item of 'Gear' has no whole number",
            edited(b'name="second" value="2"', b'name="second" value="two"'), {})  # fmt: skip
    start = b'valueReference="10" causality="input" variability="discrete" start="0"'
    refused("variable 'Int8_in': its start value 'x' is no Int8",
            edited(start, start.replace(b'"0"', b'"x"')), {"Int8_in": 1})  # fmt: skip
    refused("is for scheduled execution only; co-simulation is needed",
            edited(b"<CoSimulation", b"<ScheduledExecution"), {})  # fmt: skip


def test_exported_structure_has_no_place_for_the_types_of_fmi3(files, tmp_path):
    (tmp_path / "system.toml").write_text(
        'connections = [["a.Int8_out", "b.Int8_in"]]\n[parts]\n'
        + "".join(f'{part} = {{ fmu = "{files["plain"]}" }}\n' for part in "ab")
    )
    assert len(read_system(tmp_path).connections) == 1
    assert main(["export", str(tmp_path), "-o", str(tmp_path / "x.ssp")]) == 2


def test_values_for_the_test_of_a_role_are_of_all_types(files, capsys):
    """And those that make arrays larger come first, as in a run."""
    values = ["u=1 2 3", "n=3", "UInt8_in=2", "Boolean_in=true", "Enumeration_in=second"]
    command = ["check", str(files["plain"]), "--as", "load"]
    assert main([*command, *(word for value in values for word in ("--set", value))]) == 1
    assert "0 found" in capsys.readouterr().out  # it has no flange, and its values are taken
    assert main([*command, "--set", "UInt8_in=2.5"]) == 2
    assert "UInt8_in = 2.5: its type is UInt8, it takes a whole number" in capsys.readouterr().err
