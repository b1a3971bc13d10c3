"""What a run says of values and ends that have no effect, before it begins."""

import pytest

import herringbone as hb
from herringbone.core import ParameterError, StructureError
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.prepared import Wishes, prepared

ROTOR_AND_SHAFT = """
[parts]
rotor = { component = "rotating_inertia" }
shaft = { component = "shaft_coupling" }
"""
CONNECTED = 'connections = [["rotor.flange_a", "shaft.flange_a"]]\n'


def test_a_value_of_a_connected_input_is_not_used():
    values = {"gearbox.gear_mesh.pinion.tau": 5.0, "gearbox.gear_mesh.wheel.tau": 1.0}
    notes = prepared("test_rig", None, Wishes(values=values)).notes
    told = ", ".join(values)
    assert f"not used: {told}: what is connected there gives other values" in notes
    alone = prepared("gearbox", None, Wishes(values={"gear_mesh.pinion.tau": 150.0})).notes
    assert not [note for note in alone if "gives other values" in note]


def test_offsets_are_of_states():
    with pytest.raises(ParameterError, match=r"start_offset: gear_mesh\.backlash: .* is no state"):
        prepared("test_rig", None, Wishes(start_offset={"gear_mesh.backlash": 1e-3}))


def test_an_end_that_nothing_is_joined_to_is_held(tmp_path):
    (tmp_path / "system.toml").write_text(CONNECTED + ROTOR_AND_SHAFT)
    values = {"rotor.flange_a.tau": 5.0}
    run = hb.run(tmp_path, start="rest", t_end=1e-3, fmu="in-process", values=values)
    notes = run.info.notes
    held = "shaft: nothing is joined to flange_b, which stands still, as if it were held"
    assert notes[0] == held
    assert notes[1].startswith("not used: rotor.flange_a.tau")
    assert not [note for note in notes if note.startswith("rotor: nothing is joined")]


def test_a_system_without_parts_is_refused(tmp_path):
    (tmp_path / "system.toml").write_text('name = "empty"\n')
    with pytest.raises(StructureError, match="it has no parts"):
        read_system(tmp_path)
