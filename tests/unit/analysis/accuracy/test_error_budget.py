"""The error budget of a run: its rows, what they are of, their order; numbers by hand."""

import json
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from support.gearing.gear_mesh import write_table
from support.result import make_result

import herringbone as hb
from herringbone.analysis.accuracy import beyond
from herringbone.analysis.accuracy.error_budget import by_size, coupling_row, error_budget
from herringbone.analysis.stability.recommendation import contact_floor, separation_floor
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.result.budget import BudgetRow, Known

ALGORITHM = "li:degree=3"
LOADS, MEAN = (10.0, 2250.0, 1e5), 8e8
HARMONICS = {10.0: (0.05, 0.02), 2250.0: (0.03, 0.01), 1e5: (0.02, 0.005)}
"""Amplitudes of mesh harmonics 1 and 2 over the mean, by load [N]."""
BOUNDS = (0.02, 0.004, 0.002, 0.001, 0.001)
"""What the table states: of the mean, of harmonics 1 to 4, over the mean."""
TABLE, MESH = "stiffness table of gear_mesh", "gear_mesh.mesh_left.force"


def secant(phase, load):
    first, second = HARMONICS[load]
    turn = 2.0 * math.pi * phase
    return MEAN * (1.0 + first * math.cos(turn) + second * math.cos(2.0 * turn))


@pytest.fixture
def table(tmp_path):
    """A table that states its uncertainty."""
    file = write_table(tmp_path / "table.csv", secant, LOADS, phases=16)
    stated = f"# uncertainty: {' '.join(map(str, BOUNDS))}\n"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("side,load", f"{stated}side,load", 1), encoding="utf-8")
    return file


def result_with(table, **info):
    resources = {
        "gear_mesh.stiffness_table": str(table),
        "gear_mesh.tooth_errors": "perfect_teeth.csv",
        "modal_housing.modes": "modes.csv",
        "modal_housing.shapes": "shapes.csv",
    }
    return make_result("gearbox", algorithm=ALGORITHM, resources=resources, **info)


def row(rows, source):
    (found,) = (row for row in rows if row.source == source)
    return found


def test_rows_of_a_gearbox_the_largest_first(table):
    rows = error_budget(result_with(table), 2e4)
    assert {row.source for row in rows} == {
        TABLE, "coupling", "inner steps of gear_mesh", "reduction of modal_housing",
        "tooth errors of gear_mesh", "dampings",
    }  # fmt: skip
    sizes = [row.value for row in rows if row.value is not None]
    assert sizes == sorted(sizes, reverse=True)
    assert len(sizes) == 4
    assert all(row.value is None for row in rows[len(sizes) :])
    for found in rows:
        assert (found.known is Known.UNKNOWN) == (found.value is None)
        assert found.quantity
        assert found.how


@pytest.mark.parametrize(
    ("errors", "deviations", "how"),
    [
        ("perfect_teeth.csv", "ideal_teeth.csv", "none are given: perfect teeth"),
        ("/e.csv", "ideal_teeth.csv", "as a whole: where teeth differ, harmonics may be wrong"),
        ("perfect_teeth.csv", "/teeth.csv", None),
        ("/e.csv", "/teeth.csv", None),
    ],
)
def test_what_is_known_of_the_teeth(table, errors, deviations, how):
    """Deviations of every tooth are all that there is to know."""
    result = result_with(table)
    result.info.resources["gear_mesh.tooth_errors"] = errors
    result.info.resources["gear_mesh.tooth_deviations"] = deviations
    found = [r.how for r in error_budget(result, 2e4) if r.source == "tooth errors of gear_mesh"]
    assert len(found) == (how is not None)
    assert all(said.startswith(how) for said in found)


def hand_calculation(harmonics):
    """Lines of the bearing forces are 1 and 0.4 at harmonics 1 and 2; see support.result."""
    shares = [bound / amplitude for bound, amplitude in zip(BOUNDS[1:], harmonics, strict=False)]
    return math.hypot(shares[0], 0.4 * shares[1]) / math.hypot(1.0, 0.4)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_table_by_hand(table, sign):
    """At the row nearest to the mean force, 2262 N, on either flank; slow parts leak by 1 %."""
    result = result_with(table)
    result.data[MESH] *= sign
    found = row(error_budget(result), TABLE)
    assert found.value == pytest.approx(hand_calculation(HARMONICS[2250.0]), rel=1e-2)
    assert found.known is Known.ESTIMATED
    assert found.quantity == "bearing force, alternating part"
    result.data[MESH] *= 50.0
    wanted = hand_calculation(HARMONICS[1e5])
    assert row(error_budget(result), TABLE).value == pytest.approx(wanted, rel=1e-2)


def test_a_harmonic_below_its_bound_errs_by_all_of_it(table):
    """Bound 0.1 of a harmonic of 0.03: the line may be there or not, no more."""
    text = table.read_text(encoding="utf-8")
    table.write_text(text.replace("0.02 0.004 0.002", "0.02 0.1 0.1"), encoding="utf-8")
    assert row(error_budget(result_with(table)), TABLE).value == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ("change", "why"),
    [
        (lambda text: text.replace("# uncertainty", "# certainty"), "states no uncertainty"),
        (None, "too few mesh periods"),
    ],
)
def test_tables_that_nothing_is_known_of(table, change, why):
    """Less than four mesh periods of 2.2 ms, or a table that states nothing."""
    if change:
        table.write_text(change(table.read_text(encoding="utf-8")), encoding="utf-8")
    result = result_with(table) if change else result_with(table, t_end=8e-3)
    result = result if change else replace(result, data=result.data.iloc[:401])
    found = row(error_budget(result), TABLE)
    assert found.value is None
    assert why in found.how


@pytest.mark.parametrize(
    ("left_out", "why"),
    [
        ("gear_mesh.pinion.w", "no mesh frequency, as gear_mesh.pinion.w is not recorded, to"),
        ("bearing_supports.shaft.", "no bearing forces, to"),
    ],
)
def test_what_is_missing_of_the_run_is_named(table, left_out, why):
    result = result_with(table)
    data = result.data.drop(columns=[c for c in result.data if c.startswith(left_out)])
    assert row(error_budget(replace(result, data=data)), TABLE).how.startswith(why)


# -- coupling, inner steps, housing ---------------------------------------------------------------


def test_coupling_by_its_rule(table):
    """0.1 % at H w = accurate_step, and on with the order of convergence."""
    algorithm, bond = parse_algorithm(ALGORITHM), 2e4
    step = 0.5 * algorithm.accurate_step / bond
    found = coupling_row(result_with(table, communication_step=step), bond)
    assert found.value == pytest.approx(1e-3 * 0.5**algorithm.convergence_order, rel=1e-12)
    assert found.known is Known.ESTIMATED
    for unknown in (
        coupling_row(result_with(table), 0.0),
        coupling_row(result_with(table, slow={"gear_mesh": 2}), bond),
    ):
        assert unknown.value is None
        assert "reference=True measures" in unknown.how
    strange = coupling_row(result_with(table, model={"gear_mesh": "/some/file.fmu"}), 0.0)
    assert "verify=True measures" in strange.how  # a foreign FMU has no twin


def test_coupling_that_adapts_is_as_good_as_its_steps_tell(table):
    result = result_with(table)
    estimate = {"asked": 1e-3, "coupling": 4e-4, "inner_steps": 2e-4}
    info = replace(result.info, algorithm="li:tolerance=1e-3", estimate=estimate)
    found = coupling_row(replace(result, info=info), 2e4)
    assert (found.value, found.known) == (4e-4, Known.ESTIMATED)


def test_coupling_measured_is_the_worst_group(table):
    result = replace(result_with(table), error={"bearing_force": 1e-5, "seat_velocity": 3e-5})
    found = coupling_row(result, 2e4)
    assert (found.value, found.known) == (3e-5, Known.MEASURED)
    assert found.quantity == "seat velocity, alternating part"


def test_inner_steps_err_more_where_teeth_separate(table):
    result = result_with(table, micro_steps={"gear_mesh": 5e-6, "modal_housing": 1e-5})
    found = row(error_budget(result), "inner steps of gear_mesh")
    assert found.value == contact_floor(5e-6)
    assert "5 us in contact" in found.how
    result.data.loc[10, MESH] = 0.0
    found = row(error_budget(result), "inner steps of gear_mesh")
    assert found.value == separation_floor(5e-6) > contact_floor(5e-6)


def test_housing_without_a_certificate_is_unknown(table):
    certified = row(error_budget(result_with(table)), "reduction of modal_housing")
    assert 0.001 < certified.value < 0.1
    assert "certified bound up to 2000 Hz" in certified.how
    result = result_with(table)
    resources = result.info.resources | {"modal_housing.modes": "thesis_modes.csv"}
    resources["modal_housing.shapes"] = "thesis_shapes.csv"
    other = replace(result, info=replace(result.info, resources=resources))
    assert row(error_budget(other), "reduction of modal_housing").value is None


def test_order():
    """The largest first, those without a value last, in the order they came."""
    rows = [
        BudgetRow(name, "", value, Known.UNKNOWN, "")
        for name, value in (("a", None), ("b", 0.1), ("c", 0.3), ("d", None), ("e", 0.0))
    ]
    assert "".join(row.source for row in by_size(rows)) == "cbead"


def test_json_and_summary_of_a_measured_run():
    result = hb.run("gearbox", t_end=2e-3, fmu="in-process", reference=True)
    found = json.loads(result.to_json())["error_budget"]
    assert found == [
        {"source": r.source, "quantity": r.quantity, "value": r.value, "known": r.known.value,
         "how": r.how} for r in result.budget
    ]  # fmt: skip
    (coupling,) = (r for r in found if r["source"] == "coupling")
    assert coupling["known"] == "measured"
    assert coupling["value"] == max(result.error.values())
    values = [r["value"] for r in found if r["value"] is not None]
    assert values == sorted(values, reverse=True)
    assert np.all(np.array(values) > 0.0)


@pytest.mark.parametrize(("band", "share"), [(400.0, 1.0), (600.0, 0.6), (1400.0, 0.0)])
def test_share_beyond_a_band_is_that_of_its_lines(monkeypatch, band, share):
    """Lines of 0.8 and 0.6 at 500 and 1000 Hz, of which the window spreads 30 Hz."""
    time = np.arange(2000) * 1e-4
    force = 0.8 * np.sin(2 * np.pi * 500 * time) + 0.6 * np.sin(2 * np.pi * 1000 * time)
    monkeypatch.setattr(beyond, "group", lambda result, channel: ["f"])
    monkeypatch.setattr(beyond, "steady_part", lambda result: SimpleNamespace(rows=slice(None)))
    result = SimpleNamespace(data=pd.DataFrame({"time": time, "f": 5.0 + force}))
    assert beyond.share_beyond(result, "bearing_force", band) == pytest.approx(share, abs=1e-3)
