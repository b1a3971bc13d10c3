"""Values of an FMU 2.0 that are no reals: types have references of their own; aliases share one."""

import zipfile

import fmpy
import pytest

from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.others import OtherValues

VARIABLES = (
    ("steps", 0, "input", "<Integer start='1'/>"),
    ("on", 0, "input", "<Boolean start='false'/>"),
    ("gear", 5, "output", "<Integer/>"),
    ("same_gear", 5, "output", "<Integer/>"),
    ("locked", 5, "output", "<Boolean/>"),
)


class Slave:
    """Books what is set; gives what is kept."""

    def __init__(self):
        self.calls = []

    def setInteger(self, references, values):
        self.calls.append(("Integer", references, list(values)))

    def setBoolean(self, references, values):
        self.calls.append(("Boolean", references, list(values)))

    def setInt32(self, references, values):
        self.calls.append(("Int32", references, list(values)))

    def getInt32(self, references, count):
        return list(range(7, 7 + count))

    def getInteger(self, references):
        return [10 + reference for reference in references]

    def getBoolean(self, references):
        return [1 for _ in references]


@pytest.fixture
def others(tmp_path):
    scalars = "".join(
        f'<ScalarVariable name="{name}" valueReference="{reference}" causality="{causality}" '
        f'variability="discrete">{kind}</ScalarVariable>'
        for name, reference, causality, kind in VARIABLES
    )
    text = (
        '<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" '
        'modelName="m" guid="g"><CoSimulation modelIdentifier="model"/>'
        f"<ModelVariables>{scalars}</ModelVariables><ModelStructure/></fmiModelDescription>"
    )
    file = tmp_path / "x.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        archive.writestr(f"binaries/{fmpy.platform}/model{fmpy.sharedLibraryExtension}", b"")
    return OtherValues(read_fmu(file))


def test_variables_of_two_types_with_one_reference_are_two(others):
    slave = Slave()
    others.write(slave, {"steps": 3, "on": True})
    assert slave.calls == [("Integer", [0], [3]), ("Boolean", [0], [True])]
    assert (others.last("steps"), others.last("on")) == (3, True)
    others.write(slave, {"steps": 1})
    assert others.changed({"on": False, "steps": 1}) == {"on": False}


def test_start_values_that_are_not_declared_are_those_of_the_fmu(tmp_path):
    """Two are declared of three; one element is set, the others stay."""
    text = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="m" instantiationToken="t">
<CoSimulation modelIdentifier="model"/><ModelVariables>
<Int32 name="k" valueReference="1" causality="parameter" variability="fixed" start="7 8">
<Dimension start="3"/></Int32></ModelVariables><ModelStructure/></fmiModelDescription>"""
    file = tmp_path / "x.fmu"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", text)
        archive.writestr(f"binaries/{fmpy.platform_tuple}/model{fmpy.sharedLibraryExtension}", b"")
    others, slave = OtherValues(read_fmu(file)), Slave()
    others.take_starts(slave)
    others.write(slave, {"k[2]": 77})
    assert slave.calls == [("Int32", [1], [7, 77, 9])]


def test_aliases_are_all_read(others):
    assert others.read(Slave(), ["gear", "locked", "same_gear"]) == [15, True, 15]
