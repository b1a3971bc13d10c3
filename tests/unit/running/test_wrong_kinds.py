"""What scripts give of a wrong kind is one line that names it, before anything is computed."""

import pytest

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.core.given import check_called

MOTION, TEETH = "bearing_supports.seat_motion", "gear_mesh.pinion.number_of_teeth"
STEP = "gear_mesh.micro_step"
WRONG = [
    (lambda: hb.run(None), "system = None: it takes a name, a folder"),
    (lambda: hb.run("test_rig", values=[("a.b", 1.0)]), r"values = \[\('a.b', 1.0\)\]: .* by name"),
    (lambda: hb.run("test_rig", replace_parts="M.fmu"), "replace_parts = 'M.fmu': it takes values"),
    (lambda: hb.run("test_rig", algorithm=hb.LI), r"'li:degree=3' or LI\(degree=3\)"),
    (lambda: hb.run("test_rig", progress="yes"), "progress = 'yes': it takes True, False or a"),
    (lambda: hb.run("test_rig", output=3), "output = 3: it takes the path of a folder"),
    (lambda: hb.sweep("test_rig", speed=100.0), r"speed = 100.0: .* give \[100.0\]"),
    (lambda: hb.sweep("test_rig", vary={"a.b": "x.csv"}), r"a.b = 'x.csv': .* give \['x.csv'\]"),
    (lambda: hb.sweep("test_rig", vary=[1.0]), r"vary = \[1.0\]: it takes values by name"),
    (lambda: hb.sweep("test_rig", speed=[1.0], values=[2]), r"values = \[2\]: it takes values by"),
    (lambda: hb.sweep(hb.System, speed=[1.0]), "system = <class .*: it takes a name, a folder"),
    (lambda: hb.run("test_rig", values={MOTION: "a"}), f"gearbox.{MOTION} = 'a': it takes a num"),
    (lambda: hb.run("test_rig", values={MOTION: None}), f"{MOTION} = None: it takes a number"),
    (lambda: hb.run("test_rig", speed=1.0, values={TEETH: "x"}), f"{TEETH} = 'x': it takes a num"),
    (lambda: hb.steady("test_rig", values={MOTION: "a"}), f"{MOTION} = 'a': it takes a number"),
    (lambda: hb.modes("test_rig", values={MOTION: 1j}), f"{MOTION} = 1j: it takes a number"),
    (lambda: hb.modes("test_rig", values={STEP: "a"}), f"{STEP} = 'a': .* number alone, in s"),
    (lambda: hb.sweep("test_rig", vary={MOTION: [1.0, "a"]}), f"{MOTION} = 'a': it takes a number"),
    (lambda: hb.sweep("test_rig", vary={MOTION: [[1.0]]}), rf"{MOTION} = \[1.0\]: it takes a num"),
    (lambda: hb.sweep("test_rig", vary={"speed": ["a"]}), "speed = 'a': .* alone, in rad/s"),
    (lambda: hb.SteadySolver("test_rig"), "system = 'test_rig': it takes a System"),
    (lambda: hb.Ask("seat velocity", tolerance=2.0), "tolerance = 2: it must lie between 0 and 1"),
    (lambda: hb.Ask(()), "ask: what: it takes the names"),
]


@pytest.mark.parametrize(("call", "told"), WRONG, ids=[told[:24] for _, told in WRONG])
def test_is_told(call, told):
    with pytest.raises(ParameterError, match=told):
        call()


def test_one_text_is_one_name():
    assert hb.Ask("seat velocity").what == ("seat velocity",)


def test_a_bar_is_asked_for_by_true():
    check_called("progress", given=True)
    check_called("progress", given=print)


def test_a_table_of_columns():
    result = hb.run("test_rig", fuse=True, t_end=1e-3, record="gear_mesh.pinion.w")
    assert list(result) == ["time", "gearbox.gear_mesh.pinion.w"]
    assert "pinion.w" in result
    assert "pinion.a" not in result
    assert 0 not in result
    with pytest.raises(ParameterError, match=r"\['time'\] is no name of a column; several are"):
        _ = result[["time"]]


def test_a_sweep_shows_facts(capsys):
    found = hb.sweep("test_rig", speed=[100.0, 101.0], workers=1, progress=True)
    assert (
        repr(found)
        == f"Sweep(points 2 (2 steady); over speed; table {found.table.shape[1]} columns)"
    )
    assert "2/2" in capsys.readouterr().err
