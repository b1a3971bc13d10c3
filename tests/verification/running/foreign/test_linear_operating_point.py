"""Foreign parts are linear where the run starts, and not where they declare."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from support.foreign.c_flange import c_flange
from support.foreign.kinds import build_kinds
from support.foreign.strangers import write_system
from support.parts.fakes import FakePart

import herringbone as hb
from herringbone.analysis.asked import shaft_torques
from herringbone.analysis.figures.channels import moments
from herringbone.analysis.stability.instability import warn_if_unstable
from herringbone.analysis.stability.surrogates.operating_point import (
    UNLOADED,
    flange_points,
    linear_at,
)
from herringbone.analysis.unanswered import unanswered
from herringbone.components.registry import COMPONENTS
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.foreign.linear_start import turned_back, under_load
from herringbone.running.foreign.surrogates import opened_surrogates
from herringbone.running.prepared import Wishes, prepared
from herringbone.running.reporting.physical import physical_results
from herringbone.scenes import Start

STEP = 4e-5
SYNCHRONOUS, BREAKDOWN, SLIP = 100.0, 900.0, 0.12
LAG, INERTIA, STIFFNESS, DAMPING = 5e-3, 0.4, 6e4, 40.0
"""Of `tests/fmus/kinds/rotation/c_slip_motor.c`."""
SHARE = 0.6
SHAFT = 'coupling = { component = "shaft_coupling", set = { stiffness = 3e5, damping = 50.0 } }'


def slope_of(speed, breakdown=BREAKDOWN):
    """Torque over speed of the motor, by the derivative of its law [N m s/rad]."""
    s = 1.0 - speed / SYNCHRONOUS
    torque = 2.0 * breakdown * s * SLIP / (s * s + SLIP * SLIP)
    return -torque * (1.0 / s - 2.0 * s / (s * s + SLIP * SLIP)) / SYNCHRONOUS


@pytest.fixture(scope="module")
def kinds(tmp_path_factory):
    return build_kinds(tmp_path_factory.mktemp("operating"), "c_slip_motor.c", "c_fan.c")


@pytest.fixture(scope="module")
def ventilated(kinds):
    """A slip motor, a gearbox, and a fan without inertia behind a rotor."""
    joined = [
        ["motor.flange", "gearbox.pinion"],
        ["gearbox.wheel", "coupling.flange_a"],
        ["coupling.flange_b", "rotor.flange_a"],
        ["rotor.flange_b.w", "fan.flange.w"],
        ["fan.flange.tau", "rotor.flange_b.tau"],
    ]
    files = {"motor": kinds / "c_slip_motor.fmu", "fan": kinds / "c_fan.fmu"}
    system = write_system(kinds, "ventilated", joined, files)
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(f'\ngearbox = {{ system = "gearbox" }}\n{SHAFT}\n')
        opened.write('rotor = { component = "rotating_inertia" }\n')
    return system


VALUES = {"gear_mesh.der(angle)": 98.0, "fan.share": SHARE}


@pytest.fixture(scope="module")
def started(ventilated):
    wishes = Wishes(values=VALUES, start=Start.EQUILIBRIUM, start_offset={})
    return turned_back(under_load(prepared(ventilated, None, wishes, trial_step=STEP).system))


def test_machines_as_they_are_at_their_speed(started):
    """The motor's poles by its equations at the speed where torques balance, the fan's slope.

    To 1 %: the motor steps itself by 1 us, which moves a pole of 450 1/s by 2e-4 of it.
    """
    with opened_surrogates(started, STEP) as found:
        assert not found.missing
        assert warn_if_unstable(started, LI(), STEP, strangers=found.strangers) is None
        motor, fan = (found.strangers[name] for name in ("motor", "fan"))
        (shaft,), (blades,) = flange_points(motor), flange_points(fan)
        poles = np.sort_complex(np.linalg.eigvals(motor.surrogate.model.a))
        residuals = [s.surrogate.residual(STEP) for s in (motor, fan)]
        lines = list(linear_at(found.strangers))
    slope = slope_of(shaft.speed)
    machine = [[-1 / LAG, slope / LAG, 0], [1 / INERTIA, -DAMPING / INERTIA, -STIFFNESS / INERTIA],
               [0, 1, 0]]  # fmt: skip
    assert poles == pytest.approx(np.sort_complex(np.linalg.eigvals(machine)), rel=0.01)
    assert shaft.slope == pytest.approx(slope, rel=0.01)
    assert blades.slope == pytest.approx(-2.0 * SHARE * blades.speed, rel=1e-3)
    # What the fan takes is what the motor gives, through a ratio of 3.
    assert blades.torque == pytest.approx(-3.0 * shaft.torque, rel=2e-3)
    assert residuals[0] < 1e-4
    assert residuals[1] < 1e-3  # half of what a change of 0.03 is of 33 rad/s, as the square goes
    assert lines[0].startswith("motor is linear in the steady rotation in which the run starts: ")
    assert UNLOADED not in lines


def test_teeth_without_load_are_told():
    """A torque of either part is one."""

    def lines_with(*torques):
        parts = {
            f"part {k}": SimpleNamespace(
                part=FakePart("p").real("flange.tau", "output", "N.m").real("flange.w", "input"),
                surrogate=SimpleNamespace(
                    inputs=("flange.w",), outputs=("flange.tau",), start=[0.0],
                    start_outputs=[torque],
                ),
                at_start=True,
            )
            for k, torque in enumerate(torques)
        }  # fmt: skip
        return list(linear_at(parts))

    assert lines_with(0.0, 1e-6)[-1] == UNLOADED
    assert UNLOADED not in lines_with(0.0, -40.0)


def test_values_declared_are_told(started):
    """Where no start was found: beyond its breakdown torque, at rest, the motor pushes.

    Of its slope three digits are told; trials of 3 ms leave one of its slowest motion.
    """
    parts = tuple(replace(p, approach=None) if p.name == "motor" else p for p in started.parts)
    with opened_surrogates(replace(started, parts=parts), STEP) as found:
        line = next(iter(linear_at(found.strangers)))
    told, _, slope = line.partition(", torque over speed ")
    assert told == "motor is linear at the values that it declares: flange at 0 rad/s, 0 N m"
    assert slope_of(0.0) > 0.0
    assert float(slope.split()[0]) == pytest.approx(slope_of(0.0), rel=0.5)


def test_what_truly_grows_is_told_and_seen(kinds):
    """A motor at four fifths of its speed runs away from where it meets a constant load."""
    joined = [
        ["motor.flange", "gearbox.pinion"],
        ["gearbox.wheel", "coupling.flange_a"],
        ["load.flange", "coupling.flange_b"],
        ["bench.torque_setpoint", "load.torque_setpoint"],
    ]
    system = write_system(kinds, "beyond", joined, {"motor": kinds / "c_slip_motor.fmu"})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(f'\ngearbox = {{ system = "gearbox" }}\n{SHAFT}\n')
        opened.write(
            'load = { component = "load_motor" }\nbench = { component = "bench_controller" }\n'
        )
    balance, off, duration = 80.0, 0.5, 0.1
    s = 1.0 - balance / SYNCHRONOUS
    breakdown = 200.0 * (s * s + SLIP * SLIP) / (2.0 * s * SLIP)
    values = {"motor.breakdown": breakdown, "gear_mesh.der(angle)": balance + off}
    run = hb.run(system, values=values, t_end=duration, algorithm=LI(), step=STEP, record_step=2e-4)
    line = next(note for note in run.info.notes if "itself, linear at the start, grows" in note)
    rate = float(line.partition("as exp(")[2].split()[0])

    def of(name, parameter):
        return COMPONENTS[name].declaration.variable(parameter).start

    pinion, wheel = (2.0 * of("gear_mesh", f"{gear}.inertia") for gear in ("pinion", "wheel"))
    inertia = INERTIA + pinion + (wheel + of("load_motor", "inertia")) / 9.0
    # The lag takes from a slow motion what it adds to its inertia: J (1 + lag rate) rate = slope.
    expected = slope_of(balance + off, breakdown) / inertia
    expected = (math.sqrt(1.0 + 4.0 * LAG * expected) - 1.0) / (2.0 * LAG)
    assert rate == pytest.approx(expected, rel=0.01)
    thirds = np.array_split(run.data["gearbox.gear_mesh.pinion.w"].to_numpy(), 3)
    first, middle, last = (part.mean() for part in thirds)
    seen = math.log((last - middle) / (middle - first)) / (duration / 3.0)
    # The slope falls by 2 % on the way, and teeth pass at 360 Hz.
    assert seen == pytest.approx(rate, rel=0.05)


def test_torque_of_foreign_parts_at_the_flanges(kinds):
    """Of motors on both shafts, without couplings: as they drive, whatever acts on the wheel."""
    joined = [["motor.flange", "gearbox.pinion"], ["brake.flange", "gearbox.wheel"]]
    file = kinds / "c_slip_motor.fmu"
    system = write_system(kinds, "both", joined, {"motor": file, "brake": file})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write('\ngearbox = { system = "gearbox" }\n')
    values = {"motor.w0": 1.0, "brake.w0": -1.0}
    run = hb.run(system, values=values, start="rest", t_end=1e-3, record_step=STEP, algorithm=LI(),
                 step=STEP)  # fmt: skip
    torques = shaft_torques(run)
    assert torques["pinion"] == ("motor.flange.tau", 1.0)
    assert torques["wheel"] == ("brake.flange.tau", -1.0)
    (box,) = physical_results(run)["gearboxes"].values()
    (pair,) = box["gear_pairs"].values()
    assert pair["torque_Nm"]["pinion"] == moments(run, "motor.flange.tau").mean > 0.0
    assert pair["torque_Nm"]["wheel"] == -moments(run, "brake.flange.tau").mean > 0.0
    assert not any("torque" in names for names in unanswered(run).values())


@pytest.mark.parametrize(("speed", "declared"), [(100.0, 0.0), (100.0, 98.0), (0.0, 0.0)])
def test_a_step_that_is_stable_by_models_of_another_speed(tmp_path, speed, declared):
    """Of a motor that is not brought to the start: a line, unless both speeds are alike.

    That of the start counts, and not that at which own parts are linear.
    """
    fmu = c_flange(tmp_path, "SHAFT", "NONE", f"START={declared}")
    system = write_system(tmp_path, "turning", [["motor.flange", "rotor.flange_a"]], {"motor": fmu})
    with (system / "system.toml").open("a", encoding="utf-8") as opened:
        opened.write(
            f'\nrotor = {{ component = "rotating_inertia", set = {{ speed = {speed} }} }}\n'
        )
    found = read_system(system)
    under = found.with_values({"rotor.speed": 1.5 * speed})
    with opened_surrogates(found, STEP) as surrogates:
        line = warn_if_unstable(under, LI(), STEP, strangers=surrogates.strangers, start=found)
    if declared == 0.0 and speed:
        assert line and "motor.flange.w at 0 and not 100 rad/s" in line
    else:
        assert line is None
