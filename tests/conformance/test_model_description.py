"""modelDescription.xml of every component."""

import fmpy
import pytest

from herringbone.components.registry import COMPONENTS
from herringbone.core.declaring.units import base_exponents
from herringbone.fmi.validation import validation_problems

NAMES = list(COMPONENTS)
BODIES = {
    "gear_mesh": ("s_y", "v_y", "s_z", "v_z", "phi", "w"),
    "modal_housing": ("s_x", "s_y", "s_z", "v_x", "v_y", "v_z"),
    "drive_motor": ("phi", "w"),
    "load_motor": ("phi", "w"),
}


@pytest.fixture(params=NAMES)
def name(request):
    return request.param


@pytest.fixture
def description(name, python_fmus):
    return fmpy.read_model_description(str(python_fmus[name]))


def by_name(description):
    return {v.name: v for v in description.modelVariables}


def names(variables):
    return {v.name for v in variables}


def test_no_problem_is_found(name, python_fmus):
    assert validation_problems(python_fmus[name]) == []


def test_variables_are_those_of_the_block(name, description):
    declaration = COMPONENTS[name].declaration
    reals = {v.name: v.valueReference for v in description.modelVariables if v.type == "Real"}
    assert reals == declaration.index
    strings = {v.name: v.valueReference for v in description.modelVariables if v.type == "String"}
    assert strings == {t.name: declaration.size + k for k, t in enumerate(declaration.texts)}


def test_every_real_has_a_defined_unit(description):
    units = {u.name: u.baseUnit for u in description.unitDefinitions}
    for variable in description.modelVariables:
        if variable.type == "Real":
            base = units[variable.unit]
            exponents = {b: getattr(base, b) for b in ("kg", "m", "s", "rad") if getattr(base, b)}
            assert exponents == base_exponents(variable.unit), variable.name


def test_start_values_and_ranges(name, description):
    shown = by_name(description)
    for v in COMPONENTS[name].declaration.variables:
        real = shown[v.name]
        if v.causality == "output" or (v.causality == "local" and not v.state):
            assert (real.initial, real.start) == ("calculated", None)
        else:
            assert (real.initial, float(real.start)) == ("exact", v.start)
        assert float(real.min or "-inf") == v.minimum
        assert float(real.max or "inf") == v.maximum


def test_capabilities(description):
    cs = description.coSimulation
    assert cs.canGetAndSetFMUstate
    assert cs.canSerializeFMUstate
    assert cs.canHandleVariableCommunicationStepSize
    assert not cs.needsExecutionTool
    assert not cs.canBeInstantiatedOnlyOncePerProcess
    assert description.generationDateAndTime is None


@pytest.mark.parametrize("body", BODIES)
def test_motion_of_bodies_depends_on_no_input(body, python_fmus):
    description = fmpy.read_model_description(str(python_fmus[body]))
    found = 0
    for unknown in (*description.outputs, *description.initialUnknowns):
        quantity = unknown.variable.name.removesuffix(".node1").rpartition(".")[2]
        if quantity in BODIES[body]:
            found += 1
            assert not [v for v in unknown.dependencies if v.causality == "input"]
    assert found > 0


@pytest.mark.parametrize("element", ["bearing_supports", "shaft_coupling"])
def test_forces_of_elements_depend_on_motions_and_their_nodes(element, python_fmus):
    description = fmpy.read_model_description(str(python_fmus[element]))
    declared = {v.name: v for v in COMPONENTS[element].declaration.outputs}
    for unknown in description.outputs:
        output = declared[unknown.variable.name.partition(".node")[0]]
        wanted = {
            n + s for n in output.feedthrough for s in ("", *(f".node{k}" for k in range(1, 5)))
        }
        assert names(unknown.dependencies) == wanted
        assert not unknown.dependenciesKind  # dependent: FMI 2.0.4, section 2.2.8


def test_initial_unknowns_depend_on_all_start_values(name, description):
    exact = {v.name for v in description.modelVariables if v.initial == "exact"}
    exact -= {v.name for v in description.modelVariables if v.causality == "input"}
    for unknown in description.initialUnknowns:
        assert exact <= names(unknown.dependencies)
