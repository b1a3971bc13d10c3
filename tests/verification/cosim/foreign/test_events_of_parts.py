"""FMUs that have events or end the simulation, and descriptions that are refused."""

import json
import os
import zipfile

import numpy as np
import pandas as pd
import pytest
from support.foreign.all_types_runs import alone, refused, run, two

from herringbone.commands.main import main
from herringbone.core import OutcomeKind
from herringbone.cosim.structure.system_file import read_system

pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")


@pytest.mark.parametrize("name", ["plain", "events"])
@pytest.mark.parametrize("end", [0.5, 0.45])
def test_part_that_ends_the_simulation(all_types, name, end):
    """Alone it is recorded where it ends; its last step is the last. Without event mode it may not
    return early, and tells by its last time alone where it is."""
    result = run(alone(all_types[name]), {"end": end, "u": [1.0, 0.0]})
    assert result.outcome.kind is OutcomeKind.ENDED
    assert result.outcome.message == f"p ended the simulation at {end:g} s"
    assert result.data["time"].iloc[-1] == pytest.approx(end, rel=1e-12)
    assert result.data["p.y[1]"].iloc[-1] == pytest.approx(end, rel=1e-12)
    assert len(result.data) == 6


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "li"])
def test_one_of_two_parts_ends(all_types, algorithm, tmp_path, capsys):
    """Results up to there are kept, and the command succeeds: that end was wanted."""
    (tmp_path / "system.toml").write_text(
        'connections = [["a.y", "b.u"]]\n[parts]\n'
        + "".join(f'{part} = {{ fmu = "{all_types["plain"]}" }}\n' for part in "ab")
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


def test_events_that_never_settle(all_types):
    refused("its discrete states do not settle", alone(all_types["events"]), {"restless": 1.0})


def test_events_inside_a_step_do_not_change_what_is_integrated(all_types):
    """13 events in steps of 0.1 s: early returns and the rests of the steps make whole steps."""
    result = run(alone(all_types["events"]), {"every": 0.073, "u": [1.0, 2.0]})
    assert result.data["p.events"].iloc[-1] == 13
    assert result.data["p.y[2]"].iloc[-1] == pytest.approx(2.0, rel=1e-12)


def test_an_event_whose_time_is_told_before_is_met(all_types):
    """FMI 3.0, nextEventTime: it counts events that begin at their times alone, of which 12 lie
    inside of a step; by itself it stops for none."""
    values = {"every": 0.073, "told": 1.0, "u": [1.0, 2.0]}
    result = run(alone(all_types["events"]), values)
    assert result.data["p.events"].iloc[-1] == 13
    assert result.data["p.y[2]"].iloc[-1] == pytest.approx(2.0, rel=1e-12)


def edited_copy(file, folder, old, new):
    """The FMU alone, with another description."""
    with zipfile.ZipFile(file) as whole, zipfile.ZipFile(folder / "x.fmu", "w") as copy:
        for name in whole.namelist():
            data = whole.read(name)
            copy.writestr(name, data.replace(old, new) if name.endswith(".xml") else data)
    return alone(folder / "x.fmu")


def test_event_mode_that_is_declared_and_refused_is_not_used(all_types, tmp_path):
    system = edited_copy(all_types["events"], tmp_path, b'Token="t"', b'Token="no events"')
    result = run(system, {"every": 0.13})
    assert result.outcome.completed
    assert result.data["p.events"].iloc[-1] == 7


def test_adaptive_run_ends_where_a_part_ends(all_types):
    system = two(all_types["plain"], ("a.y", "b.u"), ("b.y", "a.u"))
    options = {"algorithm": "li", "tolerance": 1e-3, "step": 0.01, "record_step": 1e-3}
    result = run(system, {"b.end": 0.1}, t_end=0.2, **options)
    assert (result.outcome.kind, result.outcome.culprit) == (OutcomeKind.ENDED, "b")
    assert result.outcome.time == pytest.approx(0.1, rel=1e-9)


def test_descriptions_that_are_refused(all_types, tmp_path):
    def edited(old, new):
        return edited_copy(all_types["plain"], tmp_path, old, new)

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


def test_exported_structure_has_no_place_for_the_types_of_fmi3(all_types, tmp_path):
    (tmp_path / "system.toml").write_text(
        'connections = [["a.Int8_out", "b.Int8_in"]]\n[parts]\n'
        + "".join(f'{part} = {{ fmu = "{all_types["plain"]}" }}\n' for part in "ab")
    )
    assert len(read_system(tmp_path).connections) == 1
    assert main(["export", str(tmp_path), "-o", str(tmp_path / "x.ssp")]) == 2
