"""How a gearbox FMU starts is an Enumeration, for every host that knows FMI."""

from xml.etree.ElementTree import fromstring

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host

import herringbone as hb
from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Wanted
from herringbone.fmi.validation import validation_problems
from herringbone.running.exporting.export import export_ssp
from herringbone.running.exporting.system_fmu import export_fmu

LOAD = {"initial_speed": 100.0, "pinion.tau": 200.0, "wheel.tau": -600.0}
PATH = "transmission_error"
ITEMS = {"as_set": 0, "equilibrium": 1, "periodic": 2}

pytestmark = needs_compiler


@pytest.fixture(scope="module", params=[2, 3])
def fmu(request, tmp_path_factory):
    file = tmp_path_factory.mktemp("start") / f"gearbox_{request.param}.fmu"
    return export_fmu("gearbox", file, fmi=request.param, wanted=Wanted())


def first(fmu, mode):
    """Transmission errors [m] of the first steps."""
    values = LOAD | ({} if mode is None else {"start_mode": mode})
    rows = simulate_fmu(str(fmu), start_values=values, stop_time=2e-3, output=[PATH])
    return rows[PATH]


def test_it_is_declared(fmu):
    assert validation_problems(fmu) == []
    model = read_model_description(str(fmu))
    (mode,) = [v for v in model.modelVariables if v.name == "start_mode"]
    assert (mode.type, mode.start, mode.causality) == ("Enumeration", "2", "parameter")
    assert {item.name: int(item.value) for item in mode.declaredType.items} == ITEMS


def test_a_host_sets_it_as_an_integer(fmu):
    """Undeformed, at rest in its motion, vibrating: fmpy knows no more than the description."""
    found = {item: first(fmu, number) for item, number in ITEMS.items()}
    assert found["as_set"][0] == 0.0
    assert found["equilibrium"][0] != found["periodic"][0] != 0.0
    assert np.array_equal(first(fmu, None), found["periodic"])


@pytest.mark.parametrize("item", ["as_set", "equilibrium", "periodic"])
def test_our_master_takes_its_items(item, fmu, tmp_path):
    """In a system file, and on the way through an .ssp file: the same start as with fmpy."""
    (tmp_path / "system.toml").write_text(
        f'description = "gearbox"\n[parts.box]\nfmu = "{fmu}"\nset = {{ start_mode = "{item}", '
        + ", ".join(f'"{name}" = {value}' for name, value in LOAD.items())
        + " }\n"
    )
    options = {"t_end": 1e-3, "step": 1e-3, "in_process": True}
    run = hb.run(tmp_path, **options)
    assert run[f"box.{PATH}"][0] == pytest.approx(first(fmu, ITEMS[item])[0], rel=1e-12)
    other = "equilibrium" if item == "periodic" else "periodic"
    changed = hb.run(tmp_path, values={"box.start_mode": other}, **options)
    assert changed[f"box.{PATH}"][0] != run[f"box.{PATH}"][0]
    if read_model_description(str(fmu)).fmiVersion == "3.0":
        return  # SSP 1.0 takes FMI 2.0
    file = export_ssp(tmp_path, tmp_path / "box.ssp", step=1e-3)
    assert np.array_equal(hb.run(file, **options)[f"box.{PATH}"], run[f"box.{PATH}"])


@pytest.mark.parametrize(("mode", "told"), [(0, 0), (1, 1), (2, 1)])
def test_states_that_do_not_count_are_told(mode, told, tmp_path_factory):
    """A search overwrites them; as_set keeps them."""
    folder = tmp_path_factory.mktemp("set")
    wanted = Wanted(exchange=True, internals=True)
    file = export_fmu("gearbox", folder / "gearbox.fmu", wanted=wanted)
    values = {**LOAD, "gear_mesh.angle": 1.0, "start_mode": mode}
    host = Fmi2Host(file, folder / "fmu", values=values)
    (angle,) = host.get("gear_mesh.angle")
    lines = [m for m in host.messages if "start_mode is not as_set" in m]
    assert angle == pytest.approx(0.0 if told else 1.0, abs=1e-4)  # rad: it vibrates around it
    assert len(lines) == told
    assert all("gear_mesh.angle = 1 is dropped" in line for line in lines)
    host.slave.reset()
    host.initialise(values=LOAD)
    assert len([m for m in host.messages if "start_mode is not as_set" in m]) == told


def test_what_is_no_item_is_refused(fmu, tmp_path):
    if read_model_description(str(fmu)).fmiVersion == "2.0":
        host = Fmi2Host(fmu, tmp_path, values=LOAD)
        host.slave.reset()
        mode, other = ([host.reference[n]] for n in ("start_mode", PATH))
        with pytest.raises(FMICallException):
            host.slave.setInteger(mode, [3])
        assert "start_mode = 3: it must lie between 0 and 2" in host.messages[-1]
        for call in (lambda: host.slave.setReal(mode, [1.0]),
                     lambda: host.slave.setInteger(other, [1])):  # fmt: skip
            with pytest.raises(FMICallException):
                call()
            assert "with value reference" in host.messages[-1]
        host.initialise(values=LOAD)
        assert host.slave.getInteger(mode) == [2]
        with pytest.raises(FMICallException):
            host.slave.setInteger(mode, [1])
        assert "a fixed parameter cannot be set now" in host.messages[-1]
    (tmp_path / "system.toml").write_text(
        f'description = "gearbox"\n[parts.box]\nfmu = "{fmu}"\nset = {{ start_mode = "at_rest" }}\n'
    )
    with pytest.raises(ParameterError, match="it takes an Enumeration, one of 0"):
        hb.run(tmp_path, t_end=1e-3, step=1e-3, in_process=True)


def test_a_parameter_file_moves_the_operating_point(fmu, tmp_path):
    """FMU of one operating point, .ssv of another: it runs as the FMU that was exported there."""
    there = {"gear_mesh.pinion.tau": -150.0, "gear_mesh.der(angle)": 150.0}
    other, values = (
        export_fmu("gearbox", tmp_path / f"there.{end}", values=there, wanted=Wanted())
        for end in ("fmu", "ssv")
    )
    parameters = fromstring(values.read_bytes()).iter()
    found = {p.get("name"): p[0].get("value") for p in parameters if p.tag.endswith("}Parameter")}
    assert found.pop("start_mode") == "periodic"
    assert float(found["initial_speed"]) == 150.0
    assert float(found["pinion.tau"]) == -150.0
    assert float(found["wheel.tau"]) == pytest.approx(450.0)  # 81 teeth over 27
    forces = ["mesh_left.force", "bearing.wheel_right.f_y"]
    here, moved, right = (
        simulate_fmu(str(file), start_values=start, stop_time=5e-3, output=forces)
        for file, start in ((fmu, {}), (fmu, found), (other, {}))
    )
    for name in forces:
        size = np.abs(right[name]).max()
        assert np.abs(moved[name] - right[name]).max() < 1e-6 * size  # searched from elsewhere
        assert np.abs(here[name] - right[name]).max() > 0.5 * size
