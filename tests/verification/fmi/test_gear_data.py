"""The gear data of a gearbox FMU are one file: the same tables, refused with the same words."""

from pathlib import Path

import numpy as np
import pytest
from fmpy import read_model_description
from fmpy.fmi1 import FMICallException
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host

from herringbone.analysis.hosted.component import make_hosted
from herringbone.analysis.twin.monolithic import make_instances
from herringbone.core import Instance, ResourceError
from herringbone.core.declaring.hosting import Wanted
from herringbone.running.exporting.export import ready
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.prepared import Wishes

FILE, GEAR_TEXT = "gear_data.csv", "tooth_deviations"


@pytest.fixture(scope="module")
def composite():
    system, scene = ready("gearbox", None, Wishes())
    return make_hosted(system.with_values(scene.values), Wanted())


def loaded(composite, gear_data):
    """The block with the tables of the files."""
    files = {**composite.resources, FILE: gear_data}
    d = composite.component.declaration
    block = np.zeros(d.size)
    for v in d.variables:
        block[d.index[v.name]] = v.start
    composite.component.load(block, {t.name: files[t.start] for t in d.texts})
    return block


def spoilt(composite, folder, before, after):
    text = composite.resources[FILE].read_text()
    assert text.count(before) >= 1
    file = folder / FILE
    file.write_text(text.replace(before, after, 1))
    return file


def test_each_table_is_that_of_its_own_file(composite):
    """The block has the tables of the pair as the part itself reads them from its files."""
    system, _ = ready("gearbox", None, Wishes())
    component = next(i.component for i in make_instances(system) if GEAR_TEXT in i.texts)
    pair = Instance(component, "pair")
    pair.load_resources()
    tables = pair.block[pair.component.declaration.first_table :]
    assert np.count_nonzero(tables) > 1000
    block = loaded(composite, composite.resources[FILE])
    largest = np.argmax(np.abs(tables))
    starts = np.flatnonzero(block == tables[largest]) - largest
    assert any(np.array_equal(block[k : k + tables.size], tables) for k in starts)


SPOILT = {
    "no section": ("# section: tooth_errors", "# section: errors", "it has no line"),
    "number": (
        "left,drive,pinion,27,0.0,0.0",
        "left,drive,pinion,27,x,0.0",
        "line 1297: amplitude",
    ),
    "word": ("left,drive,pinion,1,0,0,0", "top,drive,pinion,1,0,0,0", "'top' is none of"),
    "no rows": ("\n0,0,0\n", "\n", "it has no rows"),
}


@pytest.mark.parametrize("case", SPOILT)
@needs_compiler
def test_refused_by_both_readers_with_the_same_words(case, composite, tmp_path):
    before, after, part = SPOILT[case]
    file = spoilt(composite, tmp_path, before, after)
    with pytest.raises(ResourceError) as error:
        loaded(composite, file)
    fmu = export_fmu("gearbox", tmp_path / "gearbox.fmu", wanted=Wanted())
    strings = [
        v.name for v in read_model_description(str(fmu)).modelVariables if v.type == "String"
    ]
    assert strings == ["gear_data", "modal_housing.modes", "modal_housing.shapes"]
    host = Fmi2Host(fmu, tmp_path / "fmu", values={"initial_speed": 100.0})
    host.slave.reset()
    host.slave.setString([host.reference["gear_data"]], [str(file)])
    with pytest.raises(FMICallException):
        host.initialise()
    said = str(error.value)
    assert part in said
    assert any(said in line for line in host.messages)
    Path(file).write_bytes(composite.resources[FILE].read_bytes())
    host.slave.reset()
    host.slave.setString([host.reference["gear_data"]], [str(file)])
    host.initialise(values={"initial_speed": 100.0})
