"""What is predicted of foreign parts with names of their own, and with signals of other types."""

import os
from dataclasses import replace

import numpy as np
import pytest
from support.foreign.all_types import build_all_types
from support.foreign.kinds import build_kinds

from herringbone.analysis.stability.bonds import bond_table, highest_frequency
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.surrogates.stand_in import StandIn
from herringbone.commands.main import main
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.running.foreign.surrogates import opened_surrogates

pytestmark = pytest.mark.skipif(os.name == "nt", reason="written for POSIX")

STEP = 1e-4
INERTIAS, STIFFNESS = (0.5, 0.3), 1e5
WIRES = (
    ("coupling.flange_a.tau", "wheel.f"),
    ("wheel.x", "coupling.flange_a.phi"),
    ("wheel.v", "coupling.flange_a.w"),
    ("rotor.flange", "coupling.flange_b"),
)


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    """A foreign mass of other names, a coupling, a rotor; two FMUs with signals of all types."""
    folder = tmp_path_factory.mktemp("parts")
    mass = build_kinds(folder, "oscillator_mass.c") / "oscillator_mass.fmu"
    types = build_all_types(folder)
    coupling = {"stiffness": STIFFNESS, "damping": 4.0}
    return (
        PartSpec("wheel", fmu=mass, values={"m": INERTIAS[0], "c": 0.0}),
        PartSpec("coupling", component="shaft_coupling", values=coupling),
        PartSpec("rotor", component="load_motor", values={"inertia": INERTIAS[1]}),
        PartSpec("one", fmu=types),
        PartSpec("other", fmu=types),
    )


def test_the_bond_of_a_foreign_body_is_found_by_its_connections(parts):
    """Two inertias on a spring, w = sqrt(k (1/J1 + 1/J2)), to the error of differences."""
    system = System("named", "", parts[:3], WIRES)
    with opened_surrogates(system, STEP) as found:
        network = linear_network(system, strangers=found.strangers)
        (bond,) = bond_table(*network)
        assert bond.masses == pytest.approx(INERTIAS, rel=1e-5)
        w = np.sqrt(STIFFNESS * sum(1.0 / J for J in INERTIAS))
        assert bond.frequency == pytest.approx(w, rel=1e-5)
        assert highest_frequency(*network) == pytest.approx(w, rel=1e-5)


def test_differences_without_a_unit_are_of_the_size_of_the_answers(parts):
    """A mass that is 1000 times lighter moves 1000 times as far by the same force."""
    found = []
    for mass in (INERTIAS[0], 1e-3 * INERTIAS[0]):
        light = replace(parts[0], values={"m": mass, "c": 0.0})
        with opened_surrogates(
            System("light", "", (light, *parts[1:3]), WIRES), STEP
        ) as surrogates:
            stand_in = StandIn(surrogates.strangers["wheel"])
            found.append([stand_in.output_change(name, 1.0) for name in "xv"])
    assert np.divide(*reversed(found)) == pytest.approx([1e3, 1e3], rel=1e-3)


@pytest.fixture
def told(parts, tmp_path, capsys):
    """Function: lines of `stability` of the system, with one of its parts' types connected."""

    def lines(kind, *more):
        mass, types = parts[0].fmu, parts[3].fmu
        wires = [*WIRES, (f"one.{kind}_out", f"other.{kind}_in")]
        (tmp_path / "system.toml").write_text(
            f'name = "typed"\nconnections = {[list(pair) for pair in wires]}\n[parts]\n'
            f'wheel = {{ fmu = "{mass}" }}\ncoupling = {{ component = "shaft_coupling" }}\n'
            f'rotor = {{ component = "load_motor" }}\none = {{ fmu = "{types}" }}\n'
            f'other = {{ fmu = "{types}" }}\n',
            encoding="utf-8",
        )
        assert main(["stability", str(tmp_path), *more]) == 0
        return " ".join(capsys.readouterr().out.split())

    return lines


def test_truth_values_stay_those_of_the_start(told):
    said = told("Boolean", "--algorithm", "jacobi:order=1")
    assert "connection 'one.Boolean_out' -> 'other.Boolean_in', of type Boolean: the value" in said
    assert "foreign parts as linear systems that trial steps show: wheel of order 2" in said


def test_nothing_is_promised_of_motions_in_single_precision(told):
    """They couple, and the analysis does not see it."""
    said = told("Float32", "--algorithm", "jacobi:order=1")
    assert "nothing is promised: one: Float32_out is a Float32, held over a step" in said
    assert "what is told is of the system without one" in said
