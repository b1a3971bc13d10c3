"""What parts are for: as declared, as told by what they are joined to, and what stays unknown."""

from dataclasses import replace
from pathlib import Path

import pytest
from support.result import make_foreign_result, make_result

from herringbone.analysis.anatomy import anatomy
from herringbone.analysis.unanswered import unanswered
from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import COMPONENTS, component_for, components_for
from herringbone.core import Declaration, Instance, StructureError, output
from herringbone.core.declaring.anatomy import PartInfo
from herringbone.core.declaring.roles import HALVES, Port, PortKind, Quantity, Role
from herringbone.core.declaring.units import RATES
from herringbone.cosim.structure.rates import rate_of
from herringbone.cosim.structure.system import PartSpec
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.reporting.summary import summary_text

RIG = read_system("test_rig")


def part(role, parts=None):
    (found,) = (parts or anatomy(RIG)).with_role(role)
    return found


def foreign(system, name, *, stands_for=None):
    """The system with an FMU of which nothing is known in the place of a part."""
    strange = PartSpec(name, fmu=Path("strange.fmu"), stands_for=stands_for)
    parts = tuple(strange if spec.name == name else spec for spec in system.parts)
    return replace(system, parts=parts)


def test_every_component_has_a_role():
    for component in COMPONENTS.values():
        assert component.declaration.roles
    for role in Role:
        assert component_for(role) is components_for(role)[0]


def test_joined_parts():
    """As the system wires them: each seat, and the couplings at both shafts."""
    parts = anatomy(RIG)
    gear, housing = part(Role.GEAR_PAIR), part(Role.HOUSING)
    for half in HALVES:
        assert parts.neighbour(housing, PortKind.SEAT, Role.BEARING, half) == part(Role.BEARING)
        assert parts.neighbour(gear, PortKind.JOURNAL, Role.BEARING, half) == part(Role.BEARING)
        assert len(parts.joined(housing, PortKind.SEAT, half)) == 1
    behind = {
        place: parts.neighbour(gear, PortKind.FLANGE, Role.COUPLING, place)
        for place in ("pinion", "wheel")
    }
    assert behind == {"pinion": "drive_coupling", "wheel": "load_coupling"}
    assert parts.neighbour(behind["pinion"], PortKind.FLANGE, Role.DRIVE) == part(Role.DRIVE)
    assert parts.neighbour(behind["pinion"], PortKind.FLANGE, Role.LOAD) is None
    assert parts.neighbour(gear, PortKind.FLANGE, Role.HOUSING) is None


def test_quantities():
    parts, gear = anatomy(RIG), part(Role.GEAR_PAIR)
    assert parts.column(gear, Quantity.SPEED, "wheel") == f"{gear}.wheel.w"
    assert parts.column(gear, Quantity.TORQUE) is None
    assert len(parts.columns(part(Role.BEARING), Quantity.STIFFNESS)) == 4


@pytest.mark.parametrize("role", [Role.HOUSING, Role.BEARING, Role.GEAR_PAIR])
def test_role_of_a_foreign_part_by_its_ports(role):
    """Seats alone, seats and journals, journals and flanges; the ports keep their places."""
    name = part(role)
    found = anatomy(foreign(RIG, name))
    assert found.with_role(role) == (name,)
    assert not found.parts[name].answers
    own = {(p.name, p.kind, p.place) for p in found.parts[name].ports if p.place in HALVES}
    declared = anatomy(RIG).parts[name].ports
    assert own == {(p.name, p.kind, p.place) for p in declared if p.place in HALVES}
    assert {frozenset(j) for j in found.joints} == {frozenset(j) for j in anatomy(RIG).joints}


def test_role_by_single_connections():
    """Wired variable by variable, as an .ssp file has it."""
    wires = []
    for one, other in RIG.connections:
        if "seat." in other:
            wires += [(f"{one}.f_{axis}", f"{other}.f_{axis}") for axis in "xyz"]
            wires += [(f"{one}.{q}_{axis}", f"{other}.{q}_{axis}") for axis in "xyz" for q in "sv"]
        else:
            wires.append((one, other))
    single = replace(RIG, connections=tuple(wires))
    assert set(anatomy(single).joints) == set(anatomy(RIG).joints)
    assert anatomy(foreign(single, part(Role.HOUSING))).with_role(Role.HOUSING)


def test_an_observer_is_no_housing():
    """It reads a motion of the housing and gives no force."""
    watch = PartSpec("watch", fmu=Path("strange.fmu"))
    wire = (f"{part(Role.HOUSING)}.pinion_left.v_z", "watch.in.v_z")
    found = anatomy(replace(RIG, parts=(*RIG.parts, watch), connections=(*RIG.connections, wire)))
    assert found.parts["watch"] == PartInfo()
    assert found.joints == anatomy(RIG).joints


def test_flanges_alone_tell_no_role():
    name = part(Role.DRIVE)
    assert not anatomy(foreign(RIG, name)).parts[name].roles
    replaced = anatomy(RIG.with_fmu(name, Path("strange.fmu")))
    assert replaced.with_role(Role.DRIVE) == (name,)
    assert replaced.parts[name].resources is None


def test_all_is_answered_on_the_rig():
    assert not unanswered(make_result())
    assert "Not known" not in summary_text(make_result())


def test_what_is_not_answered_is_one_line():
    result = make_result("gearbox")
    assert unanswered(result) == {
        "no part is known as drive; no part is known as load": ["power"],
        "no part is known as shaft coupling": ["torque"],
    }
    rows = [row for row in summary_text(result).splitlines() if row.startswith("Not known")]
    assert rows[1].split(maxsplit=2)[2] == "torque: no part is known as shaft coupling"
    assert len(rows) == 2
    # The sections that are there stay.
    assert "Pinion speed" in summary_text(result)


def test_a_stranger_is_named_where_a_role_is_missing():
    """A foreign drive has a flange alone: nothing tells that it drives."""
    result, name = make_result(), part(Role.DRIVE)
    known = anatomy(foreign(RIG, name))
    result = replace(result, info=replace(result.info, anatomy=known))
    assert unanswered(result) == {
        f"no part is known as drive, and nothing is known of {name}": ["electrical power"]
    }


def test_a_source_that_loads_takes_no_electrical_power():
    """What it takes through its flange is told; so nothing about power is missing."""
    result, name = make_result(), part(Role.LOAD)
    parts = dict(result.info.anatomy.parts)
    parts[name] = replace(parts[name], roles=(Role.SOURCE,))
    known = replace(result.info.anatomy, parts=parts)
    result = replace(result, info=replace(result.info, anatomy=known))
    assert f"{name} takes" in summary_text(result)
    assert not unanswered(result)


def test_a_part_that_lacks_a_quantity():
    result = make_result()
    drive = part(Role.DRIVE)
    parts = dict(result.info.anatomy.parts)
    answers = [a for a in parts[drive].answers if a.quantity is not Quantity.ELECTRICAL_POWER]
    parts[drive] = replace(parts[drive], answers=tuple(answers))
    known = replace(result.info.anatomy, parts=parts)
    lacking = replace(result, info=replace(result.info, anatomy=known))
    assert unanswered(lacking) == {
        f"{drive}, a drive, offers no electrical power": ["electrical power"]
    }
    column = f"{part(Role.GEAR_PAIR)}.pinion.w"
    dropped = replace(result, data=result.data.drop(columns=column))
    assert unanswered(dropped)[f"{column} is not recorded"] == ["pinion speed"]


def test_strangers_alone_make_one_line():
    result = make_foreign_result()
    rows = [row for row in summary_text(result).splitlines() if row.startswith("Not known")]
    assert len(rows) == 1
    (what,) = unanswered(result).values()
    assert {"power", "bearing forces", "radiated power"} <= set(what)


def test_declared_relations_are_checked():
    with pytest.raises(StructureError, match="rate 'w' of no output"):
        Declaration("a", "", [output("phi", "rad", "", rate="w")])
    with pytest.raises(StructureError, match="port 'flange' has no variables"):
        Declaration("a", "", [output("phi", "rad", "")], ports=[Port("flange", PortKind.FLANGE)])


def test_rates_are_declared_and_names_tell_those_of_strangers():
    """s -> v -> a and phi -> w -> a of every component; names tell at least the same."""
    count, told = 0, set()
    for component in COMPONENTS.values():
        known = InProcessPart(Instance(component, "part"))
        strange = InProcessPart(Instance(component, "part"))
        strange.variables = {n: replace(v, rate=None) for n, v in known.variables.items()}
        for v in component.declaration.outputs:
            assert rate_of(known, v.name) == (v.rate or None)
            if v.rate:
                assert rate_of(strange, v.name) == v.rate
                assert component.declaration.variable(v.rate).unit == RATES[v.unit]
                count += 1
            elif rate_of(strange, v.name):
                told.add(v.name)
    assert told == {"phi_rel"}  # of an element, whose rates nobody needs
    assert count == 8 * 2 + 12 * 2 + 10 * 2
