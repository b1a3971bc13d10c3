"""The oscillator with clearance as a gear pair: shooting on the condensed core.

A wheel on the teeth of a pinion that a stiff drive turns, under a mean load and a harmonic one of
ratio r, in bearings that hardly give way: one degree of freedom, of the gear pair's own kernels,

    x'' + F(x, x') = 1 + r cos(W t),    F = max(0, x + 2 zeta g x') for x > 0, else 0

with the damping's share g = t^2 (3 - 2 t), t = x / depth at most 1. Contact is lost and regained at
the roots in `test_steady_clearance_oscillator`, and the branch of an up-sweep ends in a fold, where
a multiplier is 1; where that is tells continuation of harmonic balance.
"""

import hashlib
import math
import subprocess

import numpy as np
import pytest
from support.clearance import contact_lost, fold
from support.gearing.gear_mesh import constant_table

import herringbone as hb
from herringbone.analysis.steady.marching.held import Held
from herringbone.analysis.steady.marching.marched import start_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.twin.condensed.solution import Solution
from herringbone.analysis.twin.fused.core import Steps
from herringbone.components.gear_mesh import GEAR_MESH
from herringbone.core import Instance
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes

STIFFNESS, MEAN = 1e9, 2e-6
TOLERANCE, DEPTH = 1e-4, 0.02
TAIL = math.sqrt(1.0 + 1.0 / 7.0)
"""Stated are harmonics up to twice those in use. Of a force with a bend they fall with the square
of their order, so that those beyond have a seventh of the energy of these."""
DROOP, PLACES = 1e-5, 256
SYSTEM = """name = "oscillator"
description = "A wheel on its teeth"
connections = [
  ["gear_mesh.pinion_left", "bearing_supports.shaft.pinion_left"],
  ["gear_mesh.pinion_right", "bearing_supports.shaft.pinion_right"],
  ["gear_mesh.wheel_left", "bearing_supports.shaft.wheel_left"],
  ["gear_mesh.wheel_right", "bearing_supports.shaft.wheel_right"],
  ["gear_mesh.pinion", "drive.flange"],
  ["gear_mesh.wheel", "load.flange"],
]
[parts.gear_mesh]
component = "gear_mesh"
[parts.bearing_supports]
component = "bearing_supports"
[parts.drive]
component = "torque_source"
[parts.load]
component = "torque_source"
[channels]
path = ["gear_mesh.wheel.w"]
"""


class Oscillator:
    """The gear pair of some damping and ratio, and what solves for its motions."""

    def __init__(self, folder, zeta: float, ratio: float, *, solver: str = "shooting") -> None:
        folder.mkdir(exist_ok=True)
        (folder / "system.toml").write_text(SYSTEM, encoding="utf-8")
        gear = Instance(GEAR_MESH, "gear")
        self._radii = [gear[f"{g}.base_radius"] for g in ("pinion", "wheel")]
        self._teeth = [int(gear[f"{g}.number_of_teeth"]) for g in ("pinion", "wheel")]
        self._omega = math.sqrt(STIFFNESS * self._radii[1] ** 2 / gear["wheel.inertia"])
        self._ratio = ratio
        stiff = {"stiffness": 1e16, "damping": 1e9}
        fixed = {
            "gear_mesh.stiffness_table": str(constant_table(folder / "t.csv", STIFFNESS)),
            "gear_mesh.pinion.inertia": 1e5,
            "gear_mesh.base_helix_angle": 0.0,
            "gear_mesh.mesh_damping_ratio": zeta,
            "gear_mesh.damping_transition": DEPTH * MEAN,
            "gear_mesh.backlash": 1e-3,
            "gear_mesh.symmetry_deviation": 0.0,
            **{f"gear_mesh.{g}.mass": 1e3 for g in ("pinion", "wheel")},
            **{
                f"bearing_supports.{g}.{axis}_{what}": value
                for g in ("pinion", "wheel")
                for axis in ("radial", "axial")
                for what, value in stiff.items()
            },
        }
        wishes = Wishes(values={**fixed, **self._at(0.7)})
        self.solver: SteadySolver = prepared_solver(
            folder, wishes=wishes, tolerance=TOLERANCE, solver=solver
        )[0]

    def _at(self, w: float) -> dict[str, float]:
        """Values at which the load alternates with a frequency, over the natural one."""
        speed = w * self._omega / self._teeth[0]
        load = 2.0 * STIFFNESS * MEAN
        pinion, wheel = self._radii
        return {
            "drive.nominal_torque": load * pinion,
            "drive.nominal_speed": speed,
            "drive.constant_share": 1.0 + 1.0 / DROOP,
            "drive.linear_share": -1.0 / DROOP,
            "load.nominal_torque": -load * wheel,
            "load.nominal_speed": speed * self._teeth[0] / self._teeth[1],
            "load.constant_share": 1.0,
            "load.order_1.order": float(self._teeth[1]),
            "load.order_1.amplitude": self._ratio * load * wheel,
            "load.ramp_time": 0.0,
        }

    def solve(self, w: float, near: hb.SteadyState | None = None) -> hb.SteadyState:
        """The motion at a frequency, over the natural one."""
        return self.solver.solve(Point(values=self._at(w)), near)

    def least(self, state: hb.SteadyState) -> float:
        """The smallest force of a period, over the mean one."""
        times = np.arange(2000) / 2000 * state.period
        return float(state.signal("mesh_left.force", times).min() / (STIFFNESS * MEAN))


@pytest.fixture(scope="module")
def oscillator(tmp_path_factory):
    return Oscillator(tmp_path_factory.mktemp("oscillator") / "o", 0.05, 0.3)


@pytest.fixture(scope="module")
def upwards(oscillator):
    """States on the branch of an up-sweep, from contact to the fold, by frequency."""
    found, near = {}, None
    for w in (0.75, 0.8, 0.82, 0.825, 0.83, 0.845, 0.85, 0.851, 0.8513, 0.8514, 0.85145, 0.856):
        near = found[w] = oscillator.solve(w, near)
        assert near.converged
        assert near.solver == "shooting"
    return found


def test_contact_is_lost_at_the_roots(oscillator, upwards):
    """Of the amplitude A of the force, 1 / A^2 is a parabola over W^2 but for 4 zeta^2 W^2."""
    sides = ((0.82, 0.825, 0.83), (1.15, 1.145, 1.14))
    for root, points in zip(contact_lost(0.05, 0.3), sides, strict=True):
        states = [upwards.get(w) or oscillator.solve(w) for w in points]
        sizes = [(1.0 - oscillator.least(state)) ** -2 - 1.0 for state in states]
        ahead = np.sqrt(np.roots(np.polyfit(np.square(points), sizes, 2)))
        assert np.abs(ahead - root).min() < 2e-5
        inside, outside = (root + way * np.sign(1.0 - root) for way in (3e-3, -3e-3))
        assert oscillator.solve(outside, states[-1]).orbit.samples.f[:, 0].min() > 0.0
        assert oscillator.solve(inside, states[-1]).orbit.samples.f[:, 0].min() == 0.0


def stiffness_of_return(state: hb.SteadyState) -> float:
    """det(1 - M) of the period map's derivative M: zero in a fold, with the root of the way."""
    return float(np.prod(1.0 - state.multipliers.values).real)


def test_multipliers_are_one_in_the_fold(upwards):
    """Along a branch det(1 - M)^2 falls to zero along a line near the fold."""
    points = (0.851, 0.8513, 0.8514)
    squares = [stiffness_of_return(upwards[w]) ** 2 for w in points]
    found = np.polyval(np.polyfit(squares, points, 2), 0.0)
    expected, _ = fold(0.05, 0.3, DEPTH, 0.84, clamped=True)
    assert found == pytest.approx(expected, abs=1e-5)


def test_an_up_sweep_jumps_at_the_fold(upwards):
    sizes = {w: state.level("mesh_left.deflection") for w, state in upwards.items()}
    assert sizes[0.8513] < 1.03 * sizes[0.851]
    assert sizes[0.856] > 2.0 * sizes[0.8513]


def marched(state: hb.SteadyState, periods: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of the last of some periods of a fine march that begins at a state."""
    steps, core = Steps(2e-6, 4, 1e-9, lean=False), state.structure.core
    signals = state.motion.given[:-1, 0].real.copy()
    held = Held(core.twin, core.condensed.equations, core.condensed.modes, signals)
    run, own = Solution(held, steps.degree, steps.close), start_of(state.orbit)
    run.state.q[: own.size] = own
    outputs = core.outputs(state.chosen("path"), steps, inside=False)
    gap = state.period / PLACES
    times = (np.arange(PLACES) + (periods - 1) * PLACES) * gap
    step = gap / np.ceil(gap / steps.length)
    parts = run.piece(0.0, periods * PLACES * gap, step, times)
    return times, np.concatenate([outputs.values(run, part)[:, 0] for part in parts])


def test_a_march_stays_on_states_whose_teeth_part(tmp_path):
    """Drawn from the last commit, between the roots; over as many periods as deviations die out."""
    head = subprocess.run(["git", "rev-parse", "HEAD"], capture_output=True, check=False).stdout
    random = np.random.default_rng(int(hashlib.sha256(head).hexdigest()[:8], 16))
    for k in range(3):
        zeta, ratio = random.uniform(0.03, 0.08), random.uniform(0.2, 0.4)
        low, high = contact_lost(zeta, ratio)
        w = random.uniform(low + 0.02, high - 0.02)
        state = Oscillator(tmp_path / str(k), zeta, ratio).solve(w)
        assert state.converged, (zeta, ratio, w, state.notes)
        assert state.bends
        assert state.orbit.samples.f[:, 0].min() == 0.0
        if not state.stable:  # it says so
            assert "unstable" in state.notes[0]
            continue
        times, values = marched(state, 40)
        expected = state.signal("path", times)
        off = np.linalg.norm(values - expected) / np.linalg.norm(expected - expected.mean(axis=0))
        assert off < TAIL * TOLERANCE, (zeta, ratio, w, off)
