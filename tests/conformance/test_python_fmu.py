"""What is special about Python FMUs: errors come with the next step.

The defects of pythonfmu 0.7 and where they are dealt with ("here" is also the suite of all FMUs):

1. Thin scripts crash at the second instantiation: two methods in each script; tested here.
2. A script is executed at every instantiation: the scripts only import; tested with 1.
3. Cached kernels inside a script crash: kernels lie in the package; no script imports numba.
4. FMUs with one script name share code: names hold component and sources; tested here.
5. A process that builds runs the old script: FMUs are built in a process of their own.
6. Exit of the process can abort: `finalizePythonInterpreter` is called before; tested here.
7. Threads without Python state are slow: concerns hosts in C only.
8. Exceptions are fatal, silent, and crash at the third one: errors are remembered; tested here.
"""

import subprocess
import sys
import zipfile

import pytest
from fmpy.fmi1 import FMICallException
from support.fmus import NAMES, STEPS, H, run

from herringbone.components.registry import COMPONENTS
from herringbone.core import FmuError
from herringbone.fmi.host import Host

WITH_INPUTS = [name for name in NAMES if COMPONENTS[name].declaration.inputs]


@pytest.fixture
def fmus(python_fmus):
    return python_fmus


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
@pytest.mark.parametrize("name", WITH_INPUTS)
def test_value_that_is_not_finite_gives_one_message_and_no_crash(name, value, started):
    host = started(name)
    signal = COMPONENTS[name].declaration.inputs[0]
    host.step(0.0, H)
    for _ in range(5):
        host.slave.setReal([host.variables[signal.name].reference], [value])
        with pytest.raises(FMICallException):
            host.slave.doStep(H, H)
    said = f"part.{signal.name} = {value} {signal.unit}: it must be finite (t = 2e-05 s)"
    assert host.messages() == [said]
    host.step(H, H)


def test_state_from_before_an_error_makes_the_instance_usable_again(started):
    host = started("drive_motor")
    run(host, "drive_motor")
    saved = host.slave.getFMUstate()
    wanted = run(host, "drive_motor", 3, STEPS)
    host.slave.setReal([host.variables["flange.tau"].reference], [float("nan")])
    with pytest.raises(FmuError, match=r"flange\.tau = nan"):
        host.step(1.0, H)
    host.slave.setFMUstate(saved)
    assert run(host, "drive_motor", 3, STEPS) == wanted
    host.slave.freeFMUstate(saved)


def test_fixed_parameter_is_refused_after_initialisation(started):
    host = started("drive_motor")
    host.set("inertia", 1.0)
    with pytest.raises(FmuError, match=r"inertia = 1 kg\.m2: a fixed parameter cannot be set"):
        host.step(0.0, H)
    assert host.values("inertia") == [0.08]


@pytest.mark.parametrize("call", ["Real", "Integer", "Boolean", "String"])
def test_unknown_value_reference(call, started):
    host = started("drive_motor")
    for reference in (10**6, 2**32 - 1):
        getattr(host.slave, f"get{call}")([reference])
        getattr(host.slave, f"set{call}")([reference], ["x" if call == "String" else 1])
    with pytest.raises(FmuError, match=f"there is no {call} with value reference 1000000"):
        host.step(0.0, H)


def test_script_survives_many_instantiations(python_fmus):
    with Host("part", python_fmus["shaft_coupling"]) as host:
        others = []
        for _ in range(200):
            host.slave.instantiate(callbacks=host._callbacks, loggingOn=True)
            others.append(host.slave.component)
        for component in others[:-1]:
            host.slave.fmi2FreeInstance(component)
        host.initialise({"flange_a.phi": 1e-3})
        assert host.values("torque") == [60.0]


def built_before(fmu, file, before=b"", after=b""):
    """The FMU of a load motor as other sources had built it, with something else described."""
    with zipfile.ZipFile(fmu) as source, zipfile.ZipFile(file, "w") as copy:
        module = source.read("resources/slavemodule.txt").decode()
        for entry in source.namelist():
            data = source.read(entry)
            if entry == "resources/slavemodule.txt":
                data = b"herringbone_load_motor_0123"
            if entry == "modelDescription.xml":
                assert before in data
                data = data.replace(before, after)
            copy.writestr(entry.replace(module, "herringbone_load_motor_0123"), data)
    return file


def test_other_sources_give_a_warning(python_fmus, tmp_path):
    old = built_before(python_fmus["load_motor"], tmp_path / "old.fmu")
    with Host("part", old) as host:
        host.initialise()
        assert "part: this FMU was built from sources 0123" in host.messages()[0]
        host.step(0.0, H)


@pytest.mark.parametrize(
    ("before", "after"),
    [(b'name="inertia"', b'name="moment"'), (b'unit="kg.m2"', b'unit="g.m2"')],
)
def test_sources_with_other_variables_are_refused(before, after, python_fmus, tmp_path):
    """What the host sets would reach others; a state of another FMU does not heal it."""
    with Host("other", python_fmus["load_motor"]) as host:
        host.initialise()
        saved = host.slave.serializeFMUstate(host.slave.getFMUstate())
    old = built_before(python_fmus["load_motor"], tmp_path / "old.fmu", before, after)
    said = r"built from sources 0123, .*, whose variables are others; build the FMU again"
    with Host("part", old) as host, pytest.raises(FmuError, match=said):
        host.initialise()
    with Host("part", old) as host:
        state = host.slave.deSerializeFMUstate(saved)
        with pytest.raises(FMICallException):
            host.slave.setFMUstate(state)
        with pytest.raises(FMICallException):
            host.slave.doStep(0.0, H)


EXIT = """
from herringbone.fmi import build_python_fmus
from herringbone.fmi.host import Host
hosts = [Host(name, fmu) for name, fmu in build_python_fmus().items()]
for host in hosts:
    host.initialise()
    host.step(0.0, 1e-5)
for host in hosts:
    host.close()
"""


def test_process_ends_cleanly(python_fmus):
    for _ in range(10):
        end = subprocess.run(
            [sys.executable, "-c", EXIT], check=False, capture_output=True, text=True
        )
        assert end.returncode == 0, end.stderr
