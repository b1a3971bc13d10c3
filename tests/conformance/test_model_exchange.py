"""Model exchange of components with state vectors, built for one data set."""

import re
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from support.hosts.exchange import ExchangeHost

from herringbone.components.registry import COMPONENTS
from herringbone.components.resources.modal_data import read_mode_table
from herringbone.core import HerringboneError, Instance
from herringbone.core.places.paths import component_folder
from herringbone.fmi.host import open_host
from herringbone.fmi.native import build_native_fmus

HOUSING = "modal_housing"
RESOURCES = component_folder(HOUSING) / "resources"
COUNT = read_mode_table(RESOURCES / "modes.csv")[1].size
OTHER_DATA = {"modes": "thesis_modes.csv", "shapes": "thesis_shapes.csv"}
OTHER_COUNT = read_mode_table(RESOURCES / "thesis_modes.csv")[1].size


@pytest.fixture(params=[2, 3])
def fmu(request, native_fmus, fmi3_fmus):
    """The housing's native FMU of either version."""
    return (native_fmus if request.param == 2 else fmi3_fmus)[HOUSING]


@pytest.fixture
def housing(fmu, tmp_path):
    host = ExchangeHost(fmu, tmp_path)
    host.initialise()
    yield host
    host.close()


def test_states_are_the_modal_coordinates_of_the_shipped_data(housing):
    numbers = range(1, COUNT + 1)
    assert OTHER_COUNT < COUNT == 60
    assert housing.model.numberOfContinuousStates == 2 * COUNT
    assert housing.states == [*(f"q[{k}]" for k in numbers), *(f"der(q[{k}])" for k in numbers)]
    seconds = [f"der(q[{k}],2)" for k in numbers]
    assert housing.rates == [*(f"der(q[{k}])" for k in numbers), *seconds]
    shown = {v.name: v for v in housing.model.modelVariables}
    for v in (d.variable for d in housing.model.derivatives):
        assert (v.causality, v.initial, v.start) == ("local", "calculated", None)
    names = ("q", "der(q)", "der(q,2)")
    names = names if housing.third else ("q[1]", "der(q[1])", "der(q[1],2)")
    assert [shown[n].unit for n in names] == ["kg^1/2.m", "kg^1/2.m/s", "kg^1/2.m/s2"]


def test_unknowns_of_the_initialisation_are_in_order(housing):
    """FMI 2.0.4, section 2.2.8: ordered according to their ScalarVariable index."""
    unknown = {u.variable.name for u in housing.model.initialUnknowns}
    shown = housing.model.derivatives
    assert unknown >= {d.variable.name for d in shown} | {d.variable.derivative.name for d in shown}
    if not housing.third:
        position = {v.name: i for i, v in enumerate(housing.model.modelVariables)}
        order = [position[u.variable.name] for u in housing.model.initialUnknowns]
        assert order == sorted(set(order))


def test_oscillators_in_the_order_of_the_states(housing):
    """q'' = -w^2 q - 2 zeta w q' + force on the mode, for states and derivatives that belong."""
    _, frequency, damping = read_mode_table(RESOURCES / "modes.csv")
    omega = 2.0 * np.pi * frequency
    q, v = 1e-6 * np.arange(1, COUNT + 1), 1e-3 * np.arange(COUNT, 0, -1)
    housing.x = np.concatenate([q, v])
    assert (housing.x == np.concatenate([q, v])).all()
    assert (housing.dx[:COUNT] == v).all()
    np.testing.assert_allclose(
        housing.dx[COUNT:], -omega * (omega * q + 2.0 * damping * v), rtol=1e-12
    )


def test_nominal_values_are_a_deflection_under_the_usual_force(housing):
    """Root of the sum of squares of the deflections under 1 kN along each degree of freedom."""
    nominals = housing.nominals
    _, frequency, _ = read_mode_table(RESOURCES / "modes.csv")
    deflections = []
    for signal in (n for n in housing.reference if n.startswith("start.")):
        housing.fmu.reset()
        housing.set(**{signal: 1e3})
        housing.initialise()
        deflections.append(np.abs(housing.x[:COUNT]))
    assert len(deflections) == 12
    total = np.linalg.norm(deflections, axis=0)
    np.testing.assert_allclose(nominals[:COUNT], total, rtol=0.05)  # two digits are kept
    np.testing.assert_allclose(nominals[COUNT:], 2 * np.pi * frequency * total, rtol=0.05)
    if not housing.third:
        shown = {v.name: float(v.nominal) for v in housing.model.modelVariables if v.nominal}
        assert [shown[name] for name in housing.states] == nominals.tolist()


def test_directional_derivatives_are_the_differences(housing):
    """The equations are linear, so that differences are exact but for rounding."""
    at = housing.nominals * np.cos(np.arange(2 * COUNT))
    known = [*housing.states, "wheel_left.f_y", "pinion_right.f_z"]
    sizes = [*housing.nominals, 1e3, 1e3]

    def values(name, size):
        x = at.copy()
        if name in housing.states:
            x[housing.states.index(name)] += size
        else:
            housing.set(**{name: size})
        housing.x = x
        found = np.concatenate([housing.dx, housing.outputs()])
        housing.set(**{name: 0.0 for name in known[2 * COUNT :]})
        return found

    centre = values(known[0], 0.0)
    some = 0
    for name, size in zip(known, sizes, strict=True):
        difference = (values(name, size) - values(name, -size)) / (2.0 * size)
        exact = housing.tangent(name)
        rounding = 1e-13 * (np.abs(centre).max() / size + np.abs(exact).max())
        np.testing.assert_allclose(exact, difference, rtol=1e-9, atol=rounding)
        some += np.count_nonzero(exact)
    assert some > 2 * COUNT * 3


def test_data_with_another_number_of_modes_are_refused(fmu, tmp_path):
    host = ExchangeHost(fmu, tmp_path)
    with pytest.raises(FMICallException):
        host.initialise(**OTHER_DATA)
    (message,) = host.messages
    assert message.endswith(
        f"resources/thesis_modes.csv: {OTHER_COUNT} modes, but this FMU was built for {COUNT} in "
        "model exchange; build it again with this file, or use co-simulation (t = 0 s)"
    )
    host.fmu.reset()
    host.initialise()
    assert len(host.x) == 2 * COUNT
    host.close()


def test_fmu_that_is_built_with_other_data(native_fmus, tmp_path):
    """It has their states, carries them alone, and gives the bits of an instance with them."""
    files = {name: RESOURCES / file for name, file in OTHER_DATA.items()}
    given = {f"{HOUSING}.{name}": file for name, file in files.items()}
    fmu = build_native_fmus([HOUSING], files=given)[HOUSING]
    guids = {fmpy.read_model_description(str(f)).guid for f in (fmu, native_fmus[HOUSING])}
    assert len(guids) == 2  # an .ssp file with it must not be taken for the shipped component
    with zipfile.ZipFile(fmu) as archive:
        carried = [n for n in archive.namelist() if n.startswith("resources/")]
    assert carried == ["resources/modes.csv", "resources/shapes.csv"]
    host = ExchangeHost(fmu, tmp_path)
    host.initialise()
    numbers = range(1, OTHER_COUNT + 1)
    assert host.states == [*(f"q[{k}]" for k in numbers), *(f"der(q[{k}])" for k in numbers)]
    host.close()
    part = Instance(COMPONENTS[HOUSING], "part")
    for name, file in files.items():
        part.set(name, str(file))
    part.set("wheel_left.f_y", 1e3)
    part.initialise()
    outputs = [v.name for v in part.component.declaration.outputs]
    with open_host("part", fmu) as steps:
        steps.initialise({"wheel_left.f_y": 1e3})
        steps.step(0.0, 1e-4)
        part.step(0.0, 1e-4)
        assert steps.values(*outputs) == [part[name] for name in outputs]
        assert part["wheel_left.s_y"] > 0.0


@pytest.mark.parametrize(
    ("files", "message"),
    [
        (
            {"modal_housing.mode": "x"},
            "modal_housing has no resource file 'mode'; it has modes, sh",
        ),
        ({"drive_motor.modes": "x"}, "drive_motor has no resource file 'modes'; it has none"),
        ({"gear_mesh.modes": "x"}, "a file is given for gear_mesh, which is not built"),
        ({"modal_housing.modes": "x.csv"}, "cannot read x.csv"),
        ({"modal_housing.modes": RESOURCES / "thesis_modes.csv"}, "shapes.csv has 60 modes, the"),
    ],
)
def test_files_that_an_fmu_cannot_be_built_with(files, message):
    with pytest.raises(HerringboneError, match=re.escape(message)):
        build_native_fmus([HOUSING, "drive_motor"], files={k: Path(f) for k, f in files.items()})


def test_co_simulation_takes_data_with_any_number_of_modes(fmu):
    with open_host("part", fmu) as host:
        host.initialise({**OTHER_DATA, "start.wheel_left.f_y": 1e3})
        host.step(0.0, 1e-5)
        assert host.values("wheel_left.s_y")[0] > 0.0


def test_components_without_continuous_equations_offer_none(native_fmus):
    offered = {
        name: fmpy.read_model_description(str(file)).modelExchange is not None
        for name, file in native_fmus.items()
    }
    stateless = {n for n, c in COMPONENTS.items() if not c.declaration.state_count}
    assert {name for name, offers in offered.items() if not offers} == {
        *stateless,
        "velocity_sensor",
    }
