"""Critical speeds: where orders of parts and of the mesh meet modes, in figures and pictures."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

import herringbone as hb
from herringbone.analysis.modes.critical_speeds import mesh_label
from herringbone.commands.main import main
from herringbone.commands.studies.modes import critical_lines
from herringbone.plotting.modes.campbell import campbell
from herringbone.plotting.modes.rays import Label, Ray, merged, rays_of

ROTORS = "one", "two", "three"
INERTIA, STIFFNESS = 0.5, 6e4
JOINED = [
    *[("one.flange_a", "engine.flange"), ("three.flange_b", "load.flange")],
    *[("one.flange_b", "front.flange_a"), ("two.flange_a", "front.flange_b")],
    *[("two.flange_b", "rear.flange_a"), ("three.flange_a", "rear.flange_b")],
]
ENGINE = {
    "nominal_torque": 0.1, "nominal_speed": 200.0, "constant_share": 26.0, "linear_share": -25.0,
    "order_1.order": 3.0, "order_1.amplitude": 80.0, "order_2.order": 0.5,
    "order_2.amplitude": 5.0, "order_3.order": 7.0,
}  # fmt: skip
LOAD = {"nominal_torque": -0.05, "nominal_speed": 200.0, "constant_share": 1.0}
SHAFT = {"stiffness": STIFFNESS, "damping": 5.0}
R_MIN = 30.0 / math.pi
WATER = 4.0 * 31.0 / 77.0
"""Order of the ship's propeller, by turns of the pinion."""


def part(name, component, values):
    told = ", ".join(f'"{variable}" = {value}' for variable, value in values.items())
    return f'[parts.{name}]\ncomponent = "{component}"\nset = {{ {told} }}\n'


def chain(folder, joined=(), more=""):
    """Three equal rotors between two equal shafts, with an engine and a load."""
    joints = ", ".join(f'["{one}", "{other}"]' for one, other in (*JOINED, *joined))
    parts = [part(name, "rotating_inertia", {"inertia": INERTIA}) for name in ROTORS]
    parts += [part(name, "shaft_coupling", SHAFT) for name in ("front", "rear")]
    parts += [part("engine", "torque_source", ENGINE), part("load", "torque_source", LOAD)]
    (folder / "system.toml").write_text(f"connections = [{joints}]\n{''.join(parts)}{more}")
    (folder / "scenes").mkdir()
    (folder / "scenes" / "loaded.toml").write_text('t_end = 0.1\nstart = "rest"\n')
    return folder


@pytest.fixture(scope="module")
def ship():
    return hb.modes("ship")


@pytest.mark.parametrize(("reference", "rays"), [("", 6), ("engine", 0)])
def test_mesh_orders_are_told_of_a_turning_pinion_alone(ship, reference, rays):
    """Their speeds are the pinion's, and not those of another shaft, or of none."""
    excited = ship.excited._replace(reference=reference, orders=())
    other = replace(ship, excited=excited)
    assert other.critical_speeds(3000.0, 3000.0).empty
    assert not list(critical_lines(other, 3000.0, 3000.0))
    assert len(rays_of(other, range(1, 7))) == rays


def test_an_engine_on_three_rotors(tmp_path):
    """Speed 60 f / order, w^2 = k/J and 3 k/J; at present 25 w / w_0 = 26 - 1/2.

    Mobility at the resonance is phi^2 / (m d/k w^2), shapes (1, 0, -1) and (1, -2, 1): 9 to 1. The
    slope of the engine's torque, 0.0125 N m s, adds 0.13 % to the damping of the first, and moves
    frequencies by less than its square. Orders without amplitude are none.
    """
    found = hb.modes(chain(tmp_path))
    excited = found.excited
    assert (excited.reference, excited.apart) == ("engine", ())
    assert [one.label for one in excited.orders] == ["engine 3", "engine 0.5"]
    assert excited.speed == pytest.approx(R_MIN * 200.0 * 25.5 / 25.0, rel=1e-6)
    first, second = (math.sqrt(n * STIFFNESS / INERTIA) / (2.0 * math.pi) for n in (1, 3))
    table = found.critical_speeds(1e5, 1e3)
    speeds = [20.0 * first, 20.0 * second, 120.0 * first, 120.0 * second]
    assert table.sort_values("speed")["speed"].tolist() == pytest.approx(speeds, rel=1e-5)
    assert (table["from_present"] + excited.speed).to_numpy() == pytest.approx(table["speed"])
    assert (np.diff(table["from_present"].abs()) >= 0.0).all()
    answers = table.set_index("mode")["answer"]
    assert answers[1].tolist() == [1.0, 1.0]
    assert answers[2].tolist() == pytest.approx([1.0 / 9.0] * 2, rel=2e-3)
    assert len(found.critical_speeds(100.0 * first, 1.1 * first)) == 1
    told = "the present speed lies beyond that; speed=2500 goes past it"
    assert told in list(critical_lines(found, 1900.0, 1e3))
    assert told not in list(critical_lines(found, 2500.0, 1e3))
    assert campbell(found).axes[0].get_xlabel() == "engine speed [r/min]"


def test_a_shaft_that_turns_by_itself_has_no_critical_speeds(tmp_path):
    machine = {"nominal_torque": 1.0, "constant_share": 1.0, "linear_share": -1.0,
               "order_1.amplitude": 1.0}  # fmt: skip
    more = part("second", "torque_source", machine) + part("fourth", "rotating_inertia", {})
    found = hb.modes(chain(tmp_path, [("fourth.flange_a", "second.flange")], more))
    assert found.excited.apart == ("second",)
    assert {one.part for one in found.excited.orders} == {"engine"}
    assert found.notes[-1] == (
        "second: orders without critical speeds, as nothing joins the shaft's angle to that of the "
        "engine"
    )


def test_orders_of_the_ship_cross_its_torsional_modes(ship):
    """Diesel on the pinion's shaft, propeller on the wheel's: 31 and 77 teeth."""
    assert ship.excited.reference == "pinion"
    table = ship.critical_speeds(3000.0, 3000.0).set_index(["excitation", "mode"])
    second = ship.frequency_hz[1]
    assert table["speed"]["diesel 3", 2] == pytest.approx(20.0 * second, rel=1e-9)
    assert table["speed"]["water 4", 2] == pytest.approx(60.0 * second / WATER, rel=1e-9)
    assert table["speed"]["2 f_m", 2] == pytest.approx(60.0 * second / 62.0, rel=1e-9)
    assert table["answer"]["diesel 3", 1] == 1.0
    assert table["answer"]["diesel 6", 3] < 1e-3  # gears along their axes: torque moves none


def test_pictures_have_the_orders_of_parts(ship):
    """In the whole, and in a panel up to 450 Hz, what diesel 9 reaches at 3000 r/min."""
    whole, low = campbell(ship).axes
    assert (whole.get_ylim()[1], low.get_ylim()[1]) == (3000.0, pytest.approx(450.0))
    told = {text.get_text() for text in low.texts}
    assert {"diesel 3", "diesel 6", "diesel 9"} <= told
    assert " present speed, 1800 r/min" in told
    (narrow,) = campbell(ship, highest=100.0).axes
    told = {text.get_text() for text in narrow.texts}
    assert "$f_m$ ... 6 $f_m$" in told
    assert {"diesel 3", "water 4", "diesel 0.5"} <= told


def test_labels_that_would_overlap_are_one():
    rays = [Ray("", mesh_label(k), float(k)) for k in (1, 2, 3)]
    rays += [Ray("diesel", "3", 3.0), Ray("diesel", "6", 6.0)]
    labels = [Label(at, (ray,)) for at, ray in zip((0.0, 0.04, 0.06, 0.5, 0.51), rays, strict=True)]
    found = merged(labels, lambda one: 0.05)
    assert [one.text for one in found] == ["f_m ... 3 f_m", "diesel 3, 6"]
    assert [one.at for one in found] == pytest.approx([0.1 / 3.0, 0.505])
    assert merged(labels, lambda one: 0.001) == labels


def test_command_tells_critical_speeds(tmp_path, capsys, ship):
    assert main(["modes", "ship", "-o", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "critical speeds of the pinion, nearest to its present 1800 r/min first" in text
    assert "frequencies are those at the present speed and load" in text
    (line,) = (line for line in text.splitlines() if line.startswith(f"{'diesel 3':>20}{2:>6}"))
    speed = 20.0 * ship.frequency_hz[1]
    assert f"{speed:.1f} r/min" in line
    assert f"{speed - ship.excited.speed:+.1f} r/min" in line
    table = pd.read_csv(tmp_path / "critical_speeds.csv")
    assert table["speed"].to_numpy() == pytest.approx(ship.critical_speeds(3e3, 3e3)["speed"])
