"""Variables of all types: recorded as fmpy does, set, refused, connected."""

import json
import os
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pandas as pd
import pytest
from support.foreign.all_types import KINDS
from support.foreign.all_types_runs import alone, refused, run, two

from herringbone.commands.main import main
from herringbone.core import OutcomeKind
from herringbone.cosim.structure.system import System

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
def selector(tmp_path_factory):
    """The FMU 2.0 of pythonfmu."""
    folder = tmp_path_factory.mktemp("selector")
    command = [sys.executable, "-m", "pythonfmu", "build", "-f", str(SELECTOR), "-d", str(folder)]
    subprocess.run([*command, "--no-external-tool"], check=True, capture_output=True)
    return folder / "Selector.fmu"


@pytest.mark.parametrize("name", ["plain", "events"])
def test_all_types_are_recorded_without_loss(all_types, name, tmp_path):
    values = {f"{kind}_in": value for kind, value in LARGE.items()}
    result = run(alone(all_types[name]), values)
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
def test_same_bits_as_fmpy(all_types, name, every):
    """With equal event settings; fmpy has further rows, at the events.

    The step is a power of two: fmpy takes the difference of two times as a step.
    """
    events = name == "events"
    start = {f"{kind}_in": v for kind, v in LARGE.items() if kind not in {"String", "Binary"}}
    start |= {"every": every, "u": [1.0, 0.7], "pair": [5, 6], "d": 0.3}
    theirs = fmpy.simulate_fmu(
        str(all_types[name]), start_values=start, stop_time=1.0, output_interval=0.125,
        use_event_mode=events, early_return_allowed=events,
    )  # fmt: skip
    ours = run(alone(all_types[name]), start, record_step=0.125)
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


def test_structural_parameter_resizes_arrays(all_types):
    """y is the integral of u; what is set first or last does not matter."""
    result = run(alone(all_types["plain"]), {"u": [1, 2, 3, 4], "u[2]": 5, "n": 4, "m": "1 2 3 5"})
    found = [result.data[f"p.y[{k}]"].iloc[-1] for k in (1, 2, 3, 4)]
    np.testing.assert_allclose(found, [1.0, 5.0, 3.0, 4.0], rtol=1e-14)
    turned = [result.data[f"p.turned[{i},{k}]"][0] for i in (1, 2) for k in (1, 2)]
    assert turned == [1.0, 3.0, 2.0, 5.0]
    assert "p.y[3]" not in run(alone(all_types["plain"]), {}).data


def test_elements_leave_the_others_as_the_fmu_has_them(all_types):
    """The size that is set makes start values that are not declared, u = 0, 0, 3, 4 here."""
    for values, expected in (
        ({"u[2]": 9.5}, [0.0, 9.5, 3.0, 4.0]),
        ({"u[2]": 9.5, "u": "1 2 3 5", "u[1]": 7.0}, [7.0, 2.0, 3.0, 5.0]),
    ):
        result = run(alone(all_types["plain"]), {"n": 4, **values}, record_step=0.5)
        found = [result.data[f"p.y[{k}]"].iloc[-1] for k in (1, 2, 3, 4)]
        np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_values_of_toml_and_command_line(all_types, tmp_path, capsys):
    (tmp_path / "system.toml").write_text(
        f'[parts.p]\nfmu = "{all_types["plain"]}"\n'
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
def test_wrong_values_are_refused(all_types, values, said):
    refused(said, alone(all_types["plain"]), values)


ALL = [(f"a.{kind}_out", f"b.{kind}_in") for kind in KINDS]


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "jacobi:order=2", "li", "fixed_point"])
@pytest.mark.parametrize("name", ["plain", "events"])
def test_connected_types_hold_over_a_step(all_types, name, algorithm):
    """a counts events every 35 ms; b shows a step later what a showed, in steps of 10 ms."""
    system = two(all_types[name], *ALL[:4], *ALL[5:], ("a.events", "b.Int32_in"), ("a.y", "b.u"))
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


@pytest.mark.parametrize("name", ["plain", "events"])
def test_what_shows_after_initialisation_acts_in_the_first_step(all_types, name):
    """a gives 7 when its initialisation has ended, not before; b shows it a step later."""
    system = two(all_types[name], ("a.Int8_out", "b.Int8_in"), ("a.Int8_out", "b.u[1]"))
    result = run(system, {"a.Int8_in": 7}, t_end=0.3, record_step=0.1, step=0.1)
    assert result.data["a.Int8_out"].tolist() == [7] * 4
    assert result.data["b.Int8_out"].tolist() == [0, 7, 7, 7]
    assert result.data["b.y[1]"].tolist() == pytest.approx([0.0, 0.7, 1.4, 2.1], rel=1e-14)


def test_integers_reach_wider_types_and_reals(all_types):
    """A real input takes them at communication points, also beside those of the loop; as SI."""
    wide = [("a.events", "b.Int64_in"), ("a.events", "b.d"), ("a.Int16_out", "b.Float32_in")]
    values = {"a.every": 0.1, "a.Int16_in": -7}
    result = run(two(all_types["plain"], *wide), values, t_end=1.0, step=0.05)
    assert result.data["b.Int64_out"].iloc[-1] == 9
    assert result.data["b.d_out"].iloc[-1] == 9.0
    assert result.data["b.Float32_out"].iloc[-1] == np.float32(-7e3)  # mm


def test_doubles_reach_single_precision_rounded(all_types):
    """With a line; what is too large is refused. The input is in mm, the output without unit."""
    rounded = two(all_types["plain"], ("a.d_out", "b.Float32_in"))
    result = run(rounded, {"a.d": 0.1}, step=0.05)
    assert result.data["b.Float32_out"].iloc[-1] == np.float32(100.0)
    said = "connection 'a.d_out' -> 'b.Float32_in': Float64 values are rounded to the 24 bits of a"
    assert f"{said} Float32" in result.info.notes
    said = "b.Float32_in = 7e+38: it is too large for a Float32"
    refused(said, rounded, {"a.d": 7e35}, step=0.05)


@pytest.mark.parametrize("name", ["plain", "events"])
def test_value_that_is_refused_ends_the_run_with_its_results(all_types, name):
    """By way of b, which shows it a step later."""
    around = [("a.UInt32_out", "b.UInt32_in"), ("b.UInt32_out", "a.UInt64_in")]
    system = two(all_types[name], *around, ("a.y", "b.u"))
    values = {"a.UInt32_in": 13, "a.u": [1.0, 2.0]}
    result = run(system, values, t_end=1.0, step=0.1, algorithm="li")
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.PART_FAILED, "a")
    assert result.outcome.message == "a.UInt64_in = 13: 13 is refused, at 0.1 s"
    assert result.data["a.y[2]"].tolist() == pytest.approx([0.0, 0.2], rel=1e-12)


@pytest.mark.parametrize("t_end", [0.5, 1.0])
@pytest.mark.parametrize("input_", ["Float32_in", "d"])
def test_nan_in_single_precision_ends_the_run(all_types, input_, t_end):
    """As in doubles; in the last step, too."""
    system = two(all_types["plain"], ("a.Float32_out", f"b.{input_}"))
    result = run(system, {"a.Float32_in": 13}, t_end=t_end, step=0.1)
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.PART_FAILED, "a")
    assert result.outcome.message == "a.Float32_out is not finite (nan), at 0.5 s"


def test_nan_in_single_precision_that_no_part_takes_is_told(all_types, tmp_path, capsys):
    """Of rows in memory, and of those that leave it."""
    said = "p.Float32_out is NaN from 0.5 s on; no part takes it, and all else is complete"
    result = run(alone(all_types["plain"]), {"Float32_in": 13})
    assert (result.outcome.kind, result.outcome.message) == (OutcomeKind.WITH_NAN, said)
    (tmp_path / "system.toml").write_text(f'[parts.p]\nfmu = "{all_types["plain"]}"\n')
    options = ["--set", "p.Float32_in=13", "--t-end", "1", "--record-step", "0.1"]
    assert main(["run", str(tmp_path), *options, "-o", str(tmp_path / "out")]) == 1
    assert f"completed_with_nan: {said}" in capsys.readouterr().err


def test_adaptive_step_exchanges_at_its_own_points(all_types):
    system = two(all_types["plain"], ("a.y", "b.u"), ("b.y", "a.u"), ("a.events", "b.Int32_in"))
    options = {"algorithm": "li", "tolerance": 1e-3, "step": 0.01, "record_step": 1e-4}
    result = run(system, {"a.every": 0.035}, t_end=0.2, **options)
    counted = result.data["a.events"].to_numpy()
    assert counted[-1] == 5
    assert result.data["b.Int32_out"].tolist() == [0, *counted[:-1]]


@pytest.mark.parametrize(
    ("connection", "said"),
    [
        (("a.Int64_out", "b.Int32_in"), "Int64 does not fit into Int32 without loss"),
        (("a.y", "b.pair"), "'a.y[1]' -> 'b.pair[1]': Float64 does not fit into Int32"),
        (("a.turned", "b.u"), "'a.turned' has 4 elements and 'b.u' has 2 elements"),
        (("a.Boolean_out", "b.Int8_in"), "Boolean does not fit into Int8 without loss"),
    ],
)
def test_what_does_not_fit_is_refused(all_types, connection, said):
    refused(said, two(all_types["plain"], connection), {})


@pytest.mark.parametrize(
    ("connection", "given"),
    [(("a.Int8_out", "b.Int8_in"), {"b.Int8_in": 3}), (("a.y", "b.u"), {"b.u": [1.0, 2.0]})],
)
def test_a_start_value_of_a_connected_input_is_told(all_types, connection, given):
    result = run(two(all_types["plain"], connection), given, t_end=0.2)
    (name,) = given
    said = f"b: the start value of {name.removeprefix('b.')} has no effect"
    assert any(note.startswith(said) for note in result.info.notes)


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


def test_values_for_the_test_of_a_role_are_of_all_types(all_types, capsys):
    """And those that make arrays larger come first, as in a run."""
    values = ["u=1 2 3", "n=3", "UInt8_in=2", "Boolean_in=true", "Enumeration_in=second"]
    command = ["check", str(all_types["plain"]), "--as", "load"]
    assert main([*command, *(word for value in values for word in ("--set", value))]) == 1
    assert "0 found" in capsys.readouterr().out  # it has no flange, and its values are taken
    assert main([*command, "--set", "UInt8_in=2.5"]) == 2
    assert "UInt8_in = 2.5: its type is UInt8, it takes a whole number" in capsys.readouterr().err
