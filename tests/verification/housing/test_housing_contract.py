"""The contract of housings: what ships holds it; each kind of wrong housing fails its own test."""

from pathlib import Path

import numpy as np
import pytest
from support.parts.fakes import OK, CallbackPart

from herringbone.analysis.finding import Verdict
from herringbone.analysis.housing import behaviour as housing_behaviour
from herringbone.analysis.housing import runs as housing_runs
from herringbone.analysis.housing.behaviour import least_work, steps_of_tests
from herringbone.analysis.housing.contract import STEP, check_housing
from herringbone.analysis.housing.runs import FORCES, POSITIONS, VELOCITIES
from herringbone.components.in_process import InProcessPart
from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.core import Instance, ParameterError
from herringbone.core.places.paths import component_folder
from herringbone.cosim.loops.drive import drive
from herringbone.housing import default_housing, write_housing
from herringbone.housing.reduction.reduced_housing import reduce_housing

RESOURCES = component_folder("modal_housing") / "resources"


def component(modes: Path, shapes: Path) -> InProcessPart:
    part = InProcessPart(Instance(MODAL_HOUSING, "housing"))
    part.set("modes", str(modes))
    part.set("shapes", str(shapes))
    return part


@pytest.fixture(scope="module")
def shipped(tmp_path_factory) -> dict[str, tuple[Path, Path]]:
    """Every housing that ships, and the default one reduced to 800 Hz."""
    folder = tmp_path_factory.mktemp("reduced")
    write_housing(reduce_housing(default_housing(), band_hz=800.0, tolerance=0.05), folder)
    return {
        "default": (RESOURCES / "modes.csv", RESOURCES / "shapes.csv"),
        "thesis": (RESOURCES / "thesis_modes.csv", RESOURCES / "thesis_shapes.csv"),
        "reduced": (folder / "modes.csv", folder / "shapes.csv"),
    }


@pytest.mark.parametrize("name", ["default", "thesis", "reduced"])
def test_passivity_of_what_ships(shipped, name):
    """100 random records that start at zero: never more work out than in, but for rounding."""

    def run(forces: np.ndarray) -> np.ndarray:
        part = component(*shipped[name])
        part.enter_initialization(0.0, 1.0)
        part.exit_initialization()
        return drive(part, FORCES, forces, POSITIONS, STEP)

    assert min(least_work(run, seed, STEP) for seed in range(100)) >= -1e-12


def test_the_default_holds_the_contract(shipped):
    housing = default_housing()
    findings = check_housing(
        lambda: component(*shipped["default"]), static=housing.static_compliance()
    )
    assert [f.test for f in findings if not f.holds] == []
    assert len(findings) == 14


def test_other_statics_are_noticed(shipped):
    findings = check_housing(
        lambda: component(*shipped["default"]), static=1.03 * default_housing().static_compliance()
    )
    assert [f.test for f in findings if not f.holds] == ["static compliance"]


MASS, STIFFNESS, DAMPING = 50.0, 1e9, 2e4


class Seats(CallbackPart):
    """Twelve oscillators of 712 Hz, semi-implicit Euler; subclasses spoil one thing each."""

    def __init__(self, outputs=(*POSITIONS, *VELOCITIES)):
        super().__init__("housing", FORCES, outputs, nodes=False, state=False)
        self.s, self.v = np.zeros(12), np.zeros(12)

    def force(self, f, s, v):
        return f - STIFFNESS * s - DAMPING * v

    def shown(self, s, f):
        return s

    def step(self, t, h):
        f = np.array(self.memory[24:36])
        self.v = self.v + h * self.force(f, self.s, self.v) / MASS
        self.s = self.s + h * self.v
        self.memory[:24] = [*self.shown(self.s, f), *self.v]
        return OK

    def out(self):
        pass


class Active(Seats):
    def force(self, f, s, v):
        return f - STIFFNESS * s + DAMPING * v


class Directed(Seats):
    """What acts at one seat is felt at the next, but not the other way round."""

    def force(self, f, s, v):
        return super().force(f + 0.1 * np.roll(f, 1), s, v)


class Hardening(Seats):
    def force(self, f, s, v):
        return super().force(f, s, v) - 1e20 * s**3


class Direct(Seats):
    def shown(self, s, f):
        return s + 1e-9 * f


class Preloaded(Seats):
    def force(self, f, s, v):
        return super().force(f + 1.0, s, v)


class Creeping(Seats):
    """A damper in place of the spring: the deflection never settles."""

    def force(self, f, s, v):
        return f - 1e5 * v


class Coarse(Seats):
    """Damped by its own step: half of it gives twice the damping."""

    def step(self, t, h):
        self.v = self.v * np.exp(-h * h * 1e8)
        return super().step(t, h)


class Millimetres(Seats):
    def step(self, t, h):
        status = super().step(t, h)
        self.memory[12:24] = list(1e3 * self.v)
        return status


class Backwards(Seats):
    def step(self, t, h):
        status = super().step(t, h)
        self.memory[12:24] = list(-self.v)
        return status


class Late(Seats):
    """It moves under the force of the step before."""

    def __init__(self):
        super().__init__()
        self.last = np.zeros(12)

    def force(self, f, s, v):
        last, self.last = self.last, f
        return super().force(last, s, v)


@pytest.mark.parametrize(
    ("kind", "fails"),
    [
        (Seats, set()),
        (Millimetres, {"v = ds/dt"}),
        (Backwards, {"v = ds/dt"}),
        (Late, {"no delay"}),
        (Active, {"damping", "passivity"}),
        (Directed, {"reciprocity"}),
        (Hardening, {"superposition"}),
        (Direct, {"no feedthrough", "v = ds/dt"}),
        (Preloaded, {"zero stays zero", "superposition"}),
        (Creeping, {"static compliance"}),
        (Coarse, {"step halving"}),
    ],
)
def test_each_fault_fails_its_test(monkeypatch, kind, fails):
    monkeypatch.setattr(housing_behaviour, "_SETTLING", 700)
    found = {f.test for f in check_housing(kind) if not f.holds}
    assert found == fails


def test_no_damping_is_a_remark(monkeypatch):
    """Exact oscillators without damping keep their energy; damped ones of 30 % lose it."""
    monkeypatch.setattr(housing_behaviour, "_SETTLING", 700)

    class Undamped(Seats):
        def force(self, f, s, v):
            return f - STIFFNESS * s

    for kind, said in ((Undamped, True), (Seats, False)):
        (remark,) = (f for f in check_housing(kind) if f.test == "damping")
        assert remark.holds
        assert ("next to no damping" in remark.measured) == said


@pytest.mark.parametrize(
    ("hz", "longest", "verdict", "said"),
    [
        (70.0, None, Verdict.HOLDS, "% in 96 ms"),
        (25.0, None, Verdict.REMARK, "slow vibration: drifts by"),
        (70.0, 800, Verdict.FAILS, "drifts by"),
    ],
)
def test_soft_mounts(monkeypatch, hz, longest, verdict, said):
    """6 ms, and 96 ms where these are allowed: 6.7 and 2.4 periods."""
    monkeypatch.setattr(housing_behaviour, "_SETTLING", 300)

    class Mounted(Seats):
        def force(self, f, s, v):
            w = 2.0 * np.pi * hz
            return f - MASS * (w**2 * s + 0.06 * w * v)

    found = {f.test: f for f in check_housing(Mounted, longest=longest)}
    assert found["static compliance"].verdict is verdict
    assert said in found["static compliance"].measured


def test_a_slow_housing_is_told_and_tested_in_short_runs(monkeypatch, caplog):
    """Steps are told as they are taken, but for the few before; what takes longer is left out."""
    monkeypatch.setattr(housing_behaviour, "_SETTLING", 900)
    monkeypatch.setattr(housing_runs, "PATIENCE", 0.0)
    taken = 0

    class Counted(Seats):
        def step(self, t, h):
            nonlocal taken
            taken += 1
            return super().step(t, h)

    assert all(finding.holds for finding in check_housing(Counted))
    assert f"take {steps_of_tests()} steps" in caplog.text
    assert taken == steps_of_tests() + 4
    taken = 0
    found = check_housing(Counted, longest=housing_behaviour.SHORT)
    untested = {f.test for f in found if f.verdict is Verdict.NOT_TESTED}
    waiting = {"static compliance", "compliance", "reciprocity", "superposition", "damping"}
    assert untested == waiting
    assert taken == 25 * 400 + 4


def test_missing_and_wrong_variables(monkeypatch):
    findings = check_housing(lambda: Seats(POSITIONS))
    assert [(f.test, f.holds) for f in findings] == [
        ("variables", False), ("units", True), ("dependencies", True),
    ]  # fmt: skip
    assert findings[0].measured == (
        "24 of 36; missing: pinion_left.v_x, pinion_left.v_y, pinion_left.v_z, ..."
    )
    monkeypatch.setattr(Seats, "feedthrough", True)
    assert [f.test for f in check_housing(Seats) if not f.holds] == ["dependencies"]


def test_bad_step():
    with pytest.raises(ParameterError, match="step -1 s must be positive"):
        check_housing(Seats, step=-1.0)
