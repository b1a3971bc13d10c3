"""The gearbox as an FMU for hosts: what it shows, how it starts, what a flange takes."""

import math
import random
import re
import time
from functools import cache
from xml.etree.ElementTree import fromstring
from zipfile import ZipFile

import numpy as np
import pytest
from fmpy import read_model_description, simulate_fmu
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import fmi3IntermediateUpdateCallback
from support.compiler import needs_compiler
from support.hosts.fmi2 import Fmi2Host
from support.hosts.fmi3 import Fmi3Host

from herringbone.core import ParameterError
from herringbone.core.declaring.hosting import Given, Wanted
from herringbone.fmi.check import check_fmu
from herringbone.fmi.reference import replay
from herringbone.fmi.validation import validation_problems
from herringbone.running.exporting.system_fmu import export_fmu

RATIO, SPEED = 3.0, 1000.0 * math.pi / 30.0
"""Teeth 81/27; 1000 r/min in rad/s."""
MOTION = Wanted({"pinion": Given.MOTION})
GIVEN = Wanted({"pinion": Given.MOTION, "wheel": Given.SPEED})
BOTH = Wanted({"pinion": Given.SPEED}, exchange=True)

pytestmark = [
    pytest.mark.slow,
    needs_compiler,
]


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Function: the gearbox for a host."""
    folder = tmp_path_factory.mktemp("hosted")

    @cache
    def export(number, fmi=2):
        wanted = (Wanted(), MOTION, BOTH, GIVEN)[number]
        return export_fmu("gearbox", folder / f"g{number}_{fmi}.fmu", fmi=fmi, wanted=wanted)

    return export


def load(torque, speed=SPEED):
    """Start of a gearbox that takes torques: speed [rad/s] and pinion torque [N m], balanced."""
    return {"initial_speed": speed, "pinion.tau": torque, "wheel.tau": -RATIO * torque}


def forces(host):
    return [n for n in host.reference if n.startswith("bearing.")]


@pytest.mark.parametrize(("number", "fmi"), [(0, 2), (2, 3)])
def test_what_it_shows(number, fmi, exported):
    file = exported(number, fmi)
    assert validation_problems(file) == []
    of = {c: [] for c in ("input", "output", "parameter", "local", "independent")}
    for v in read_model_description(str(file)).modelVariables:
        of[v.causality].append(v.name)
    inputs = {0: ["pinion.tau", "wheel.tau"], 2: ["pinion.w", "wheel.tau"]}[number]
    assert sorted(of["input"]) == inputs
    assert len(of["output"]) <= 40
    assert len(of["parameter"]) <= 20 + 3 * (number == 2)  # stiffness, damping, torque of a shaft
    # model exchange: 24 states of the pair, 2 of the flange, modes, and their derivatives; contacts
    locals_ = [name for name in of["local"] if not name.startswith("event_indicator")]
    assert len(of["local"]) - len(locals_) == (4 if number == 2 else 0)
    assert not locals_ or {"pinion.angle", "der(modal_housing.q)"} <= set(locals_)
    assert bool(locals_) is (number == 2)


def test_no_input_is_missing(exported, capfd):
    result = simulate_fmu(str(exported(0)), stop_time=5e-3)
    assert len(result) == 6  # steps of the default experiment
    assert "issing" not in "".join(capfd.readouterr())


DRAWN = random.Random("operating points")
POINTS = [
    (0.0, 0.0), (1.0, 200.0), (3.0, 900.0), (1.0, -200.0), (6.0, 20.0),
    *((DRAWN.uniform(0.1, 3.5), DRAWN.uniform(-900.0, 900.0)) for _ in range(2)),
]  # fmt: skip


@pytest.mark.parametrize(("speed", "torque"), POINTS)
def test_start_at_any_operating_point(speed, torque, exported, tmp_path):
    host = Fmi2Host(exported(0), tmp_path, values=load(torque, speed * SPEED))
    step, rows = 2e-5, []
    for k in range(15000):
        rows.append(host.get(*forces(host)))
        host.step(k * step, step)
    swing = np.ptp(rows[:250], axis=0).max()
    assert swing <= 1.1 * np.ptp(rows[-5000:], axis=0).max() + 0.01  # N


def test_start_on_the_coast_flank(exported, tmp_path):
    """Torque reversed: the mirror image of the same load, to what the apex deviation changes."""
    found = [
        Fmi2Host(exported(0), tmp_path / str(t), values={**load(t), "start_mode": 1})
        for t in (200.0, -200.0)
    ]
    drive, coast = (h.get("mesh_left.force", "bearing.pinion_left.f_y") for h in found)
    assert coast == pytest.approx(-drive, rel=1e-3)


def test_whole_accelerates_with_its_net_torque(exported, tmp_path):
    """Torque at the pinion alone: all turn together, with the moments of inertia of both gears."""
    values = {"initial_speed": 0.0, "pinion.tau": 200.0, "wheel.tau": 0.0}
    host = Fmi2Host(exported(0), tmp_path, values=values)
    pinion, wheel = host.get("pinion.a", "wheel.a")
    assert pinion == pytest.approx(RATIO * wheel, rel=1e-9)
    assert pinion > 0.0
    mesh = host.get("mesh_left.force", "mesh_right.force").sum()
    balanced = Fmi2Host(exported(0), tmp_path / "b", values=load(200.0)).get("mesh_left.force")[0]
    assert 0.0 < mesh < 2.0 * balanced


def test_no_equilibrium_is_told(exported, tmp_path):
    loose = {**load(200.0), "bearing_supports.pinion.radial_stiffness": 0.0}
    host = Fmi2Host(exported(0), tmp_path, values=loose)
    (line,) = [m for m in host.messages if "no equilibrium" in m]
    assert "they start undeformed" in line
    assert host.get("transmission_error")[0] == 0.0
    as_set = Fmi2Host(exported(0), tmp_path / "s", values={**load(200.0), "start_mode": 0})
    assert as_set.get("transmission_error")[0] == 0.0
    assert not [m for m in as_set.messages if "no equilibrium" in m]


def torque_at_given_motion(file, folder, step, ripple):
    """Mean torque at a pinion whose speed has a ripple, once a turn; held for a step [s]."""
    share = 0.05 * ripple
    host = Fmi2Host(file, folder, values={"pinion.phi": 0.0, "pinion.w": SPEED})
    period, means = 2.0 * math.pi / SPEED, []
    for k in range(round(6 * period / step)):
        t = k * step
        w = SPEED * (1.0 + share * math.sin(SPEED * t))
        phi = SPEED * t - share * (math.cos(SPEED * t) - 1.0)
        host.set({"pinion.phi": phi, "pinion.w": w, "wheel.tau": -600.0})
        host.step(t, step)
        means.append(host.get("pinion.tau_mean")[0])
    return np.mean(means[-round(2 * period / step) :])


@pytest.mark.parametrize("ripple", [False, True])
def test_held_angle_runs_on(ripple, exported, tmp_path):
    fine = torque_at_given_motion(exported(1), tmp_path / "f", 5e-5, ripple)
    held = torque_at_given_motion(exported(1), tmp_path / "h", 1e-3, ripple)
    assert fine == pytest.approx(-200.0, rel=1e-3)  # what balances 600 N m
    assert held == pytest.approx(fine, rel=0.01)


@pytest.mark.parametrize(
    "calls",
    [
        ("pinion.w wheel.w",),
        ("wheel.w pinion.w pinion.phi",),
        ("pinion.phi", "pinion.w wheel.w"),
        ("pinion.w", "wheel.w", "pinion.phi"),
    ],
)
def test_a_speed_that_is_set_alone_moves_no_angle(calls, exported, tmp_path):
    """0.01 % after 2 s: the angle had jumped by 0.021 rad, by which the torque turned round.

    Whether the host integrates the angle or leaves it, and in whatever order it sets it: torques
    differ by the angle's last digit times the shaft's stiffness, and by the steps' tolerance.
    """
    faster, turned = 1.0001 * SPEED, 2.0 * SPEED

    def run(calls, folder):
        start = {"pinion.phi": 0.0, "pinion.w": SPEED, "wheel.w": SPEED / RATIO}
        host = Fmi2Host(exported(3), folder, values=start)
        given = {"pinion.phi": turned, "pinion.w": faster, "wheel.w": faster / RATIO}
        for k in range(2):
            host.step(float(k), 1.0)
        for call in calls:
            host.set({name: given[name] for name in call.split()})
        rows = []
        for k in range(10):
            host.step(2.0 + k * 1e-4, 1e-4)
            rows.append(host.get("pinion.tau", *forces(host)))
        return np.array(rows)

    expected = run(("pinion.phi pinion.w wheel.w",), tmp_path / "integrated")
    assert np.abs(expected[:, 0] + 200.0).max() < 20.0
    digit = np.spacing(turned) * 1e5 / 0.023  # N, as below
    found = run(calls, tmp_path / "found")
    assert np.abs(found - expected).max() < 10.0 * digit + 1e-5 * np.abs(expected).max()


def test_an_angle_goes_on_from_where_its_rate_s_derivatives_brought_it(exported, tmp_path):
    """A speed that grows by a W, its angle left to it: (t + a t^2/2) W, as the host integrates.

    Without: each set took 0.5 a W H^2 back, 20 times 5e-4 rad / 400 at H = 1 ms.
    """
    share, step = 10.0, 1e-3
    found = {}
    for integrated in (True, False):
        host = Fmi2Host(exported(3), tmp_path / str(integrated), values={"pinion.w": SPEED})
        for k in range(20):
            t, wanted = k * step, {}
            for name, speed in (("pinion.w", SPEED), ("wheel.w", SPEED / RATIO)):
                wanted[name] = speed * (1.0 + share * t)
            if integrated:
                wanted["pinion.phi"] = SPEED * (t + share * t * t / 2.0)
            host.set(wanted)
            slopes = [share * SPEED, share * SPEED / RATIO]
            names = [host.reference[n] for n in ("pinion.w", "wheel.w")]
            host.slave.setRealInputDerivatives(names, [1, 1], slopes)
            host.step(t, step)
        found[integrated] = host.get("pinion.tau", *forces(host))
    assert found[False] == pytest.approx(found[True], rel=1e-5, abs=1e-3)


def test_speeds_alone_within_steps(exported, tmp_path):
    """FMI 3.0: by the integral of a polynomial of degree 4, whose error is (W h)^6 of a share."""
    wave, share, step = 377.0, 1e-3, 1e-4

    def swing(t):
        return 1.0 + share * math.sin(wave * t)

    def torques(integrated, folder):
        def update(_environment, t, asks, *_others):
            if asks:
                part.set({"pinion.w": SPEED * swing(t), "wheel.w": SPEED / RATIO * swing(t)})
            if asks and integrated:
                part.set({"pinion.phi": SPEED * (t + share * (1.0 - math.cos(wave * t)) / wave)})

        asked = fmi3IntermediateUpdateCallback(update)
        part = Fmi3Host(exported(3, 3), folder, None, intermediateUpdate=asked)
        rows = []
        for k in range(100):
            part.step(k * step, step)
            rows.append(part.get("pinion.tau")[0])
        return np.array(rows)

    wanted = torques(True, tmp_path / "integrated")
    assert np.ptp(wanted) > 1.0  # N m
    assert np.abs(torques(False, tmp_path / "alone") - wanted).max() < 1e-5 * np.abs(wanted).max()


def test_derivatives_of_the_angle_count_alone(exported, tmp_path):
    """With dphi/dt = w: as the angle that runs on. With dphi/dt = 0: the shaft is twisted."""
    found = {}
    for slope in (None, SPEED, 0.0):
        host = Fmi2Host(exported(1), tmp_path / str(slope), values={"pinion.w": SPEED})
        host.set({"pinion.phi": 0.0, "pinion.w": SPEED})
        if slope is not None:
            host.slave.setRealInputDerivatives([host.reference["pinion.phi"]], [1], [slope])
        host.step(0.0, 1e-4)
        found[slope] = host.get("pinion.tau")[0]
    assert found[SPEED] == pytest.approx(found[None], abs=1e-6)  # N m
    assert abs(found[0.0] - found[None]) > 50.0  # of 6e4 N m/rad times 0.01 rad


@pytest.mark.parametrize("number", [1, 3])
@pytest.mark.parametrize("angle", [2e4, -2e4, 1e6])
def test_the_host_s_angle_begins_anywhere(number, angle, exported, tmp_path):
    """Twists of 3e-3 rad were searched from there: the gearbox started undeformed, or with 2e8 N.

    Torques differ by the last digit of the angle times the shaft's stiffness, 1e5 N m/rad, and
    forces by that over the base radius, 0.023 m; the steps' tolerance adds to it.
    """

    def run(first):
        there = {"pinion.phi": first, "pinion.w": SPEED}
        host = Fmi2Host(exported(number), tmp_path / str(first), 0.0, 1e-9, there)
        rows = [host.get(*forces(host))]
        for k in range(20):
            host.set({"pinion.phi": first + SPEED * k * 1e-4})
            host.step(k * 1e-4, 1e-4)
            rows.append(host.get(*forces(host)))
        return np.array(rows)

    digit = np.spacing(abs(angle)) * 1e5 / 0.023  # N
    expected = run(0.0)
    assert np.abs(expected).max() > 1000.0
    assert np.abs(run(angle) - expected).max() < 10.0 * digit + 1e-5 * np.abs(expected).max()


def test_same_bits_as_fresh(exported, tmp_path):
    """Reset, second initialisation, another instance, another start time, a restored state."""

    def run(host, start=0.0):
        rows = []
        for k in range(20):
            t = start + k * 2.0**-12
            host.set({"pinion.phi": SPEED * (t - start), "pinion.w": SPEED})
            host.step(t, 2.0**-12)
            rows.append(host.get(*forces(host), "pinion.tau", "pinion.tau_mean"))
        return np.array(rows)

    values = {"pinion.w": SPEED, "wheel.tau": -600.0}
    host = Fmi2Host(exported(1), tmp_path, values=values)
    saved = host.slave.getFMUState()
    fresh = run(host)
    host.slave.setFMUState(saved)
    restored = run(host)
    host.slave.reset()
    host.initialise(values={"pinion.w": 2.0, "wheel.tau": 30.0})
    run(host)
    host.slave.reset()
    host.initialise(values=values)
    other = Fmi2Host(exported(1), tmp_path / "o", values=values)
    later = Fmi2Host(exported(1), tmp_path / "l", start=8.0, values=values)
    for rows in (restored, run(host), run(other), run(later, 8.0)):
        assert rows.tobytes() == fresh.tobytes()


def test_tolerance_decides_inner_steps(exported, tmp_path):
    def run(tolerance):
        host = Fmi2Host(exported(0), tmp_path / str(tolerance), 0.0, tolerance, load(200.0))
        rows = []
        for k in range(50):
            host.step(k * 1e-3, 1e-3)
            rows.append(host.get(*forces(host)))
        return np.array(rows)

    exact = run(1e-9)
    size = np.linalg.norm(exact - exact.mean(axis=0))
    errors = [np.linalg.norm(run(t) - exact) / size for t in (1e-3, 1e-5)]
    assert errors[0] < 2e-3
    assert errors[1] < 2e-5
    with pytest.raises(FMICallException):
        Fmi2Host(exported(0), tmp_path / "n", 0.0, -1.0)


@pytest.mark.parametrize(("speed", "torque"), [(1.0, 200.0), (3.0, 900.0), (1.0, -200.0)])
def test_a_quarter_of_real_time(speed, torque, exported, tmp_path):
    """Thread CPU of the default experiment's steps, each the least of equal runs, which are as many
    as it takes until nothing else has delayed a step in all of them."""
    values, step = load(torque, speed * SPEED), 1e-3
    host = Fmi2Host(exported(0), tmp_path, values=values)
    least = np.full(100, np.inf)
    settled = least[20:]
    for _ in range(400):
        host.slave.reset()
        host.initialise(values=values)
        for k in range(least.size):
            before = time.thread_time_ns()
            host.step(k * step, step)
            least[k] = min(least[k], 1e-9 * (time.thread_time_ns() - before))
        if settled.max() <= 1.2 * np.median(settled):
            break
    assert settled.mean() <= 0.25 * step
    assert settled.max() <= 1.2 * np.median(settled)


def test_what_is_no_gearbox_is_refused(tmp_path):
    with pytest.raises(ParameterError, match="of a whole gearbox alone"):
        export_fmu("test_rig", tmp_path / "rig.fmu", wanted=MOTION)
    with pytest.raises(ParameterError, match="has no flange 'shaft'"):
        export_fmu("gearbox", tmp_path / "g.fmu", wanted=Wanted({"shaft": Given.SPEED}))


def test_a_flange_that_takes_motion_has_no_core(tmp_path, caplog):
    export_fmu("gearbox", tmp_path / "torques.ssv", wanted=Wanted())
    assert not caplog.records
    export_fmu("gearbox", tmp_path / "motion.ssv", wanted=MOTION)
    assert "not the condensed core: the host gives motion at the pinion's flange" in caplog.text


@pytest.mark.parametrize("fmi", [2, 3])
def test_what_lies_in_it(fmi, exported):
    """Terminals of variables that exist, an icon, a licence, units as people read them."""
    file = exported(2 if fmi == 3 else 0, fmi)
    description = read_model_description(str(file))
    names = {v.name for v in description.modelVariables}
    with ZipFile(file) as archive:
        terminals = fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
        page = archive.read("documentation/index.html").decode()
        assert archive.read("terminalsAndIcons/icon.png").startswith(b"\x89PNG")
        assert b"Permission" in archive.read("documentation/licenses/license.txt")
    members = [m.get("variableName") for m in terminals.iter("TerminalMemberVariable")]
    assert set(members) <= names
    assert {t.get("name") for t in terminals.iter("Terminal")} >= {"pinion", "seat.wheel_left"}
    assert all(f"<td>{n}</td>" in page for n in members)
    shown = {v.name: v.displayUnit for v in description.modelVariables}
    assert (shown["wheel.w"], shown["mesh_left.force"]) == ("r/min", "kN")
    assert description.defaultExperiment.tolerance


def test_its_page_tells_of_this_fmu(exported):
    """Not of the integration of a gear pair's FMU; values of what is no variable of it."""
    with ZipFile(exported(0)) as archive:
        page = archive.read("documentation/index.html").decode()
    assert "micro_step" not in page
    assert "micro step" not in page
    assert "**Refused**" in page  # what follows that paragraph
    assert "<td>gear_mesh.face_width</td><td>m</td><td>0.0473</td>" in page
    told = set(re.findall(r"<td>([\w.]+)</td>", page))
    assert {"bearing_supports.seat_motion", "gear_mesh.drag_torque"} <= told
    assert not [name for name in told if ".guess_" in name]


@pytest.mark.parametrize("fmi", [2, 3])
def test_reference_results_are_replayed(fmi, exported, tmp_path):
    file = exported(2 if fmi == 3 else 0, fmi)
    assert check_fmu(file) == []
    folder = "extra/org.fmi-standard.fmi-ls-ref"
    with ZipFile(file) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    head, *rows = content[f"{folder}/gearbox_out.csv"].decode().splitlines()
    assert len(rows) == 21  # the start, and 20 steps
    wrong = tmp_path / "gearbox.fmu"
    rows[5] = ",".join([rows[5].split(",")[0], *["7.0"] * head.count(",")])
    with ZipFile(wrong, "w") as archive:
        content[f"{folder}/gearbox_out.csv"] = "\n".join([head, *rows]).encode()
        for name, data in content.items():
            archive.writestr(name, data)
    problems = check_fmu(wrong)
    assert len(problems) == head.count(",")
    assert "reference results: wheel.w = 34.9" in "".join(problems)


def behind_a_shaft(host, step, order, inertia=0.02, stiffness=6e4, damping=5.0):
    """Largest deviation of the shaft's torque [N m] late in a run of a hand-written loop."""
    phi, w = host.get("pinion.phi", "pinion.w")
    there, speed, before, deviations = phi + 200.0 / stiffness, w, 200.0, []
    for k in range(round(0.4 / step)):
        tau = stiffness * (there - phi) + damping * (speed - w)
        slope = (tau - before) / step if order and k else 0.0
        host.set({"pinion.tau": tau})
        if order:
            host.slave.setRealInputDerivatives([host.reference["pinion.tau"]], [1], [slope])
        host.step(k * step, step)
        jerk, now = -slope / inertia, (200.0 - tau) / inertia
        there += speed * step + now * step**2 / 2.0 + jerk * step**3 / 6.0
        speed += now * step + jerk * step**2 / 2.0
        phi, w = host.get("pinion.phi", "pinion.w")
        before = tau
        deviations.append(abs(tau - 200.0))
        if deviations[-1] > 5000.0:
            return math.inf
    return max(deviations[-len(deviations) // 4 :])


@pytest.mark.parametrize(
    ("order", "inertia", "beyond"), [(0, 0.02, 1.1), (1, 0.02, 1.1), (1, 1.0, 1.015)]
)
def test_documented_step_limit(order, inertia, beyond, exported, tmp_path):
    """Beyond a narrow band of unstable steps the page tells where steps are stable again."""
    with ZipFile(exported(0)) as archive:
        page = archive.read("documentation/index.html").decode()
    row = re.search(rf"<td>pinion</td><td>torque</td><td>{inertia:g} kg.*?</td>(.*?)</tr>", page)
    steps = [
        1e-6 * float(x) for x in re.findall(r"[>mo] ?(\d+) (?:us|to)", row[1].split("</td>")[order])
    ]

    def swing(step):
        folder = tmp_path / f"{step:.3e}"
        host = Fmi2Host(exported(0), folder, values=load(200.0))
        return behind_a_shaft(host, step, order, inertia)

    limit, *again = steps
    calm = swing(0.5 * limit)
    assert swing(0.9 * limit) < 3.0 * calm + 0.5  # N m
    assert swing(beyond * limit) > 10.0 * calm
    if again:
        assert swing(sum(again) / 2.0) < 3.0 * calm + 0.5
    assert bool(again) is (inertia == 1.0)


@pytest.mark.parametrize("number", [0, 1])
def test_reference_results_are_those_of_turning_shafts(exported, number):
    assert replay(exported(number)) == []


@pytest.mark.parametrize("unknown", ["bearing.pinion_left.f_y", "mesh_left.force", "wheel.a"])
def test_derivatives_in_initialisation_are_those_of_the_balanced_start(unknown, exported, tmp_path):
    """The start follows the torque: at fixed states forces would not depend on it at all."""
    host = Fmi2Host(exported(0), tmp_path)
    host.slave.reset()
    host.slave.setupExperiment(startTime=0.0)
    host.slave.enterInitializationMode()
    (torque,) = host.get("pinion.tau")
    at, of = host.reference["pinion.tau"], host.reference[unknown]
    (slope,) = host.slave.getDirectionalDerivative([of], [at], [1.0])
    there = []
    for given in (torque - 0.2, torque + 0.2):
        host.set({"pinion.tau": given})
        there.append(host.get(unknown)[0])
    assert slope == pytest.approx((there[1] - there[0]) / 0.4, rel=1e-5)
    assert slope > 1.0


def test_shafts_that_hang_free_in_a_clearance_start_where_they_settle(tmp_path):
    """No stiffness leads there: it could not be exported, and as a parameter began with a blow."""
    clearance = {"bearing_supports.pinion.radial_clearance": 1e-5}
    file = export_fmu("gearbox", tmp_path / "g.fmu", wanted=Wanted(), values=clearance)
    host, rows = Fmi2Host(file, tmp_path / "fmu"), []
    for k in range(300):
        host.step(k * 1e-4, 1e-4)
        rows.append(host.get("bearing.pinion_left.f_y")[0])
    first, last = np.array(rows[:50]), np.array(rows[200:])
    assert np.ptp(first) < 1.01 * np.ptp(last)
    assert first.mean() == pytest.approx(last.mean(), rel=1e-3)
