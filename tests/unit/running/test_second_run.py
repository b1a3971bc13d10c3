"""The second run in a process parses nothing, unpacks nothing and linearises nothing."""

import pytest

import herringbone as hb
from herringbone.analysis.twin import monolithic
from herringbone.analysis.twin.condensed import modes
from herringbone.analysis.twin.fused import core
from herringbone.components.resources import flat_csv
from herringbone.cosim.fmu import unpacked
from herringbone.running import coupling_choice, remembered_answers
from herringbone.running.fused import fused
from herringbone.running.steps import linear_gearbox

ONCE = [
    (flat_csv, "_read"),
    (unpacked, "read_fmu"),
    (unpacked, "extract_fmu"),
    (remembered_answers, "loaded_start"),
    (remembered_answers, "fastest_bond"),
    (coupling_choice, "warn_if_unstable"),
    (linear_gearbox, "linear_network"),
    (monolithic, "build_network"),
    (core, "take_apart"),
    (modes, "_eigen"),
    (fused, "suited"),
]


@pytest.fixture
def calls(monkeypatch):
    """Names of what was called."""
    found = []

    def counted(module, name):
        function = getattr(module, name)

        def call(*arguments, **options):
            found.append(name)
            return function(*arguments, **options)

        monkeypatch.setattr(module, name, call)

    for module, name in ONCE:
        counted(module, name)
    return found


@pytest.mark.parametrize(
    ("algorithm", "deviation", "asked_again"),
    [
        ("li:degree=3", 1.2e-5, {"loaded_start", "fastest_bond", "warn_if_unstable"}),
        ("auto", 1.3e-5, {"loaded_start", "fastest_bond", "linear_network"}),
    ],
)
def test_second_run(calls, algorithm, deviation, asked_again):
    """An adaptive step, as of the default, is asked for no limit."""
    asked = {"algorithm": algorithm, "t_end": 2e-4, "fmu": "native"}
    first = hb.run("test_rig", **asked)
    calls.clear()
    second = hb.run("test_rig", **asked)
    assert calls == []
    assert second.data.equals(first.data)
    assert second.info.notes == first.info.notes
    hb.run("test_rig", **asked, values={"gear_mesh.symmetry_deviation": deviation})
    assert set(calls) == asked_again


def test_second_fused_run(calls):
    """What is found is that of the values; eigenvectors are those of the matrix."""
    asked = {"fuse": True, "t_end": 2e-4}
    values = {"gear_mesh.symmetry_deviation": 1.4e-5}
    first = hb.run("test_rig", **asked, values=values)
    other = hb.run("test_rig", **asked, values={"gear_mesh.symmetry_deviation": 1.5e-5})
    assert not other.data.equals(first.data)
    calls.clear()
    second = hb.run("test_rig", **asked, values=values)
    assert calls == []
    assert second.data.equals(first.data)
    assert second.info.notes == first.info.notes
    hb.run("test_rig", **asked, values={"drive_motor.inertia": 0.0801})
    assert {"take_apart", "_eigen", "suited"} <= set(calls)
    assert "build_network" not in calls  # what is wired how does not go by values
