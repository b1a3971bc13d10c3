"""Drivetrains that turn freely, with foreign parts whose own motions are slow against the step.

Trials of a millisecond tell little of a spring that swings in a tenth of a second; what is made of
them then must not be taken for growth. Values are drawn from a commit's hash.
"""

import numpy as np
import pytest
from pythonfmu.builder import FmuBuilder
from support.foreign.kinds import KINDS

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.instability import warn_if_unstable
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.foreign.surrogates import opened_surrogates

HASH = 0x9C6BDB9E
"""Of the commit that the work began with."""
STEP = 1e-5
POLES = 1e-4
"""Of the part's own Runge-Kutta steps, and of trials whose residual is 1e-8."""
PARAMETERS = {"engine_inertia": 0.12, "gearbox_inertia": 0.03, "arc_stiffness": 900.0,
              "arc_damping": 4.0, "stub_stiffness": 5e4, "stub_damping": 8.0}  # fmt: skip
TEXT = """name = "car"
connections = [["flywheel.flange", "vehicle.flange"],
               ["bench_controller.torque_setpoint", "vehicle.torque_setpoint"]]
[parts]
flywheel = {{ fmu = "{file}" }}
vehicle = {{ component = "load_motor", set = {{ inertia = {inertia} }} }}
bench_controller = {{ component = "bench_controller" }}
"""


@pytest.fixture(scope="module")
def flywheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("flywheel")
    return FmuBuilder.build_FMU(KINDS.parent / "dual_mass_flywheel.py", dest=folder)


def _drawn(number):
    """Values between half and twice of the shipped ones."""
    random = np.random.default_rng([HASH, number])
    return {name: float(x * 2.0 ** random.uniform(-1.0, 1.0)) for name, x in PARAMETERS.items()}


def _poles(given):
    """Of the flywheel behind a flange that stands."""
    k, d = given["arc_stiffness"], given["arc_damping"]
    stiffness = np.array([[k, -k], [-k, k + given["stub_stiffness"]]])
    damping = np.array([[d, -d], [-d, d + given["stub_damping"]]])
    inertia = np.array([[given["engine_inertia"]], [given["gearbox_inertia"]]])
    zero, one = np.zeros((2, 2)), np.eye(2)
    return np.linalg.eigvals(np.block([[zero, one], [-stiffness / inertia, -damping / inertia]]))


@pytest.mark.parametrize("number", range(3))
def test_a_dual_mass_flywheel_turns_freely(flywheel, tmp_path, number):
    """Its slow motion is found at a step of 10 us, and no algorithm is said to make it grow."""
    given = _drawn(number)
    text = TEXT.format(file=flywheel, inertia=0.5)
    (tmp_path / "system.toml").write_text(text, encoding="utf-8")
    values = {f"flywheel.{name}": x for name, x in given.items()}
    system = read_system(tmp_path).with_values(values)
    with opened_surrogates(system, STEP) as found:
        (surrogate,) = (s.surrogate for s in found.strangers.values())
        poles = np.linalg.eigvals(surrogate.model.a)
        assert np.sort_complex(poles) == pytest.approx(np.sort_complex(_poles(given)), rel=POLES)
        for name in ("jacobi:order=2", "gauss_seidel:order=2", "li:degree=3"):
            algorithm = parse_algorithm(name)
            members = linear_network(system, strangers=found.strangers)
            assert Amplification(*members, algorithm).growth(STEP).radius <= 1.0 + GROWTH
            assert warn_if_unstable(system, algorithm, STEP, strangers=found.strangers) is None
