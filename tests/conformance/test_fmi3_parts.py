"""FMUs 3.0 as parts: the bits of FMI 2.0, mixed systems, and the checks of a single FMU."""

import zipfile

import numpy as np
import pytest
from support.fmus import NAMES

import herringbone
from herringbone.commands import main as cli
from herringbone.core import ParameterError
from herringbone.cosim.fmu.opening import open_fmu
from herringbone.cosim.loops.calls import do_step, exchange_derivatives
from herringbone.fmi import check_fmu, without_unit
from herringbone.running.loading import load_scene, load_system

GEAR = "gear_mesh.mesh_left.force"


def run(fmus, algorithm, fmu="native"):
    """The test rig with FMUs by instance, other parts of the given kind."""
    system, folder = load_system("test_rig")
    for part in system.parts:
        if part.component in fmus:
            system = system.with_fmu(part.name, fmus[part.component])
    scene = load_scene(folder, None)
    return herringbone.run(
        system, scene=scene, algorithm=algorithm, fmu=fmu, start="rest", step=4e-5, t_end=8e-3,
        record_step=4e-5,
    )  # fmt: skip


def assert_equal(result, expected):
    assert np.ptp(expected[GEAR]) > 1.0  # [N]
    assert list(result.data) == list(expected.data)
    assert result.units == expected.units
    np.testing.assert_array_equal(result.data.to_numpy(), expected.data.to_numpy())


@pytest.mark.parametrize("algorithm", ["jacobi:order=0", "gauss_seidel:order=1", "li:degree=3"])
def test_fmi3_gives_the_bits_of_fmi2(algorithm, native_fmus, fmi3_fmus):
    """Held inputs, nodes inside the step, and steps repeated from saved states."""
    assert_equal(run(fmi3_fmus, algorithm), run(native_fmus, algorithm))


def test_mixed_system_gives_the_same_bits(native_fmus, fmi3_fmus):
    """An FMU 3.0, an FMU 2.0 and in-process parts."""
    both = {name: native_fmus[name] for name in ("gear_mesh", "modal_housing")}
    mixed = both | {"gear_mesh": fmi3_fmus["gear_mesh"]}
    assert_equal(run(mixed, "li:degree=3", "in-process"), run(both, "li:degree=3"))


def output_derivatives(file, inputs):
    """Names of the outputs of a part, and their derivatives by its C function after a step."""
    part = open_fmu("part", file)
    try:
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()
        for name, value in inputs.items():
            part.set(name, value)
        at = part.addresses
        assert do_step(at.do_step, at.component, 0.0, 1e-4) == 0
        names = [
            n for n, v in part.variables.items() if v.causality == "output" and ".node" not in n
        ]
        references = np.array([part.variables[n].reference for n in names], np.uint32)
        orders, values = np.ones(len(names), np.int32), np.full(len(names), np.nan)
        status = exchange_derivatives(
            at.get_derivatives, at.component, references.ctypes.data, len(names),
            orders.ctypes.data, values.ctypes.data,
        )  # fmt: skip
        assert (status, at.set_derivatives > 0) == (0, part.model.fmiVersion == "2.0")
    finally:
        part.close()
    return names, values


@pytest.mark.parametrize(
    ("name", "inputs"), [("drive_motor", {"flange.tau": 5.0}), ("bench_controller", {})]
)
def test_output_derivatives_are_those_of_fmi2(name, inputs, native_fmus, fmi3_fmus):
    """FMI 3.0 has them, but no input derivatives: they serve sources, such as the controller."""
    names, wanted = output_derivatives(native_fmus[name], inputs)
    found, values = output_derivatives(fmi3_fmus[name], inputs)
    assert found == names
    assert np.isfinite(wanted).all()
    np.testing.assert_array_equal(values, wanted)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_found_wrong(name, fmi3_fmus):
    assert check_fmu(fmi3_fmus[name]) == without_unit(fmi3_fmus[name]) == []


def test_variable_without_unit_is_found(fmi3_fmus, tmp_path):
    file = tmp_path / "bare.fmu"
    with zipfile.ZipFile(fmi3_fmus["load_motor"]) as good, zipfile.ZipFile(file, "w") as bare:
        for name in good.namelist():
            data = good.read(name)
            if name == "modelDescription.xml":
                data = data.replace(b'unit="N.m"', b"", 1)
            bare.writestr(name, data)
    (problem,) = without_unit(file)
    assert problem.endswith("a Float64 without unit")


def test_housing_holds_the_contract(fmi3_fmus, capsys):
    assert cli.main(["check", str(fmi3_fmus["modal_housing"]), "--as", "housing"]) == 0
    assert "all tests hold" in capsys.readouterr().out


def test_refused_values(fmi3_fmus):
    part = open_fmu("motor", fmi3_fmus["drive_motor"])
    try:
        with pytest.raises(ParameterError, match=r"motor.inertia = -1.0: .*inertia = -1 kg\.m2"):
            part.set("inertia", -1.0)
            part.enter_initialization(0.0, 1.0)
        with pytest.raises(ParameterError, match=r"motor.inertia = 'x': it takes a Float64"):
            part.set("inertia", "x")
        with pytest.raises(ParameterError, match=r"has no variable 'mass'"):
            part.set("mass", 1.0)
    finally:
        part.close()
