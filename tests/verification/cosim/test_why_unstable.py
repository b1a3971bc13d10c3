"""Why a run is unstable: the bond that is named is the one that grows, its remedies hold."""

import numpy as np
import pytest
from support.rig.limits import rig

from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.atlas import two_rotors
from herringbone.analysis.stability.diagnosis import diagnose
from herringbone.analysis.stability.growth import GROWTH
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.components.bearing_supports import BEARING_SUPPORTS
from herringbone.components.in_process import InProcessPart
from herringbone.cosim.algorithms import (
    LI,
    FixedPoint,
    GaussSeidel,
    Jacobi,
    Predict,
    parse_algorithm,
)
from herringbone.cosim.simulation import make_grid, simulate


def test_why_names_the_bond_and_remedies_that_hold():
    """Of an unstable step: the pinion's bearings, and a smaller step that is stable."""
    found = diagnose(rig(), Jacobi(1), 5e-5)
    assert sum(share for _, share in found.bonds) == pytest.approx(1.0)
    assert {name for name, _ in found.bonds[:2]} == {
        f"gearbox.bearing_supports.shaft.pinion_{side}.f_y" for side in ("left", "right")
    }
    assert found.bonds[0][1] + found.bonds[1][1] > 0.9
    step = float(found.remedies[0].split("below ")[1].split(" s")[0])
    growth = Amplification(*linear_network(rig()), Jacobi(1)).growth
    assert growth(0.98 * step).radius <= 1.0 + GROWTH < growth(1.02 * step).radius
    assert diagnose(rig(), Jacobi(1), 0.98 * step) is None


def test_no_step_is_to_blame_where_the_algorithm_adapts_it():
    """`li:degree=3` is unstable at 735 us; with a tolerance it finds that, and goes below."""
    assert diagnose(rig(), LI(3), 735e-6) is not None
    assert diagnose(rig(), LI(3, tolerance=1e-3), 735e-6) is None


WHY_AT = {
    GaussSeidel(2): (39.0, 36.9),
    Predict(): (70.0, 67.8),
    FixedPoint(3): (220.0, 213.3),
    LI(3): (735.0, 700.9),
    Jacobi(0, "parallel"): (10.0, 6.9),
}
"""Step and predicted limit [us]."""
KICK, RISEN = 1e-13, 1e9
"""Velocities [m/s] that start a motion, and by what it rises: other motions fade meanwhile."""


def growing_forces(algorithm, step, growth):
    """Forces by name, less their equilibrium, at the end of a kicked run of the linear parts."""
    _, instances = linear_network(rig())
    random = np.random.default_rng(1)
    for instance in instances:
        for entry, v in enumerate(instance.component.declaration.states):
            if v.unit == "m/s":
                instance.block[entry] += KICK * random.uniform(-1.0, 1.0)
    grid = make_grid(np.ceil(np.log(RISEN) / np.log1p(growth)) * step, step, step)
    found = simulate(rig(), [InProcessPart(i) for i in instances], algorithm, grid)
    return dict(zip(found.names, np.diff(found.values, axis=0)[-40:].T, strict=True))


def leading_root(x):
    """Eigenvalue per sample of the one motion, a pair or alone, that is left in samples."""
    pair = np.linalg.lstsq(np.column_stack([x[1:-1], x[:-2]]), x[2:], rcond=None)[0]
    return max(np.roots([1.0, *-pair]), key=abs)


@pytest.mark.slow
@pytest.mark.parametrize("algorithm", WHY_AT, ids=str)
def test_why_is_true_for_every_algorithm(algorithm):
    """The motion is the one that runs of the same parts end with; the remedies are stable."""
    step, limit = (1e-6 * t for t in WHY_AT[algorithm])
    found = diagnose(rig(), algorithm, step)
    forces = growing_forces(algorithm, step, found.growth)
    root = leading_root(forces[found.bonds[0][0]])
    assert np.abs(root) - 1.0 == pytest.approx(found.growth, rel=0.01)
    assert abs(np.angle(root)) / (2.0 * np.pi * step) == pytest.approx(found.frequency, rel=1e-3)
    sizes = {bond: np.ptp(forces[bond]) for bond, _ in found.bonds if bond.endswith(".f_y")}
    assert {bond for bond, _ in found.bonds[:2]} == set(sorted(sizes, key=sizes.get)[-2:])
    pinion = [share for bond, share in found.bonds if ".pinion_" in bond]
    assert sum(pinion) > 0.9
    assert pinion[0] == pytest.approx(pinion[1], rel=0.05)  # left and right are alike
    assert found.sampled == (step > 200e-6)
    assert_remedies_hold(found, algorithm, step, limit)


def assert_remedies_hold(found, algorithm, step, limit):
    """Steps and algorithms named are stable, and the step is the limit; so is the damping."""

    def grows(other, at, system=None):
        growth = Amplification(*linear_network(system or rig()), other).growth(at)
        return growth.radius > 1.0 + GROWTH

    below, *others = found.remedies
    assert float(below.split()[3]) == pytest.approx(limit, rel=0.01)
    assert not grows(algorithm, 0.99 * float(below.split()[3]))
    for remedy in others:
        if "times as much" in remedy:
            factor = float(remedy.split(", ")[1].split()[0])
            stronger = {
                f"bearing_supports.{v.name}": factor * v.start
                for v in BEARING_SUPPORTS.declaration.parameters
                if v.name.endswith("damping")
            }
            assert not grows(algorithm, step, rig().with_values(stronger))
            continue
        name, _, reach = remedy.partition(", stable ")
        reach = float(reach.split()[1]) if reach.startswith("below") else 4.0 * step
        assert not grows(parse_algorithm(name), step)
        assert not grows(parse_algorithm(name), 0.99 * reach)


def test_why_of_two_rotors_in_closed_form():
    """Held torques want h w < 4 zeta: at twice that, half the step or twice the damping."""
    zeta, frequency = 0.02, 3000.0
    found = diagnose(two_rotors(zeta, 3.0), Jacobi(0), 8.0 * zeta / frequency)
    ((bond, share),) = found.bonds
    assert (bond, share) == ("coupling.flange_a.tau", pytest.approx(1.0))
    assert found.frequency == pytest.approx(frequency / (2.0 * np.pi), rel=0.02)
    assert float(found.remedies[0].split()[3]) == pytest.approx(4.0 * zeta / frequency, rel=0.02)
    assert "times as much" in found.remedies[-1]


def test_why_takes_few_matrices(monkeypatch):
    """One linearisation; a coarse scan and a bisection for each thing that is printed."""
    matrices, systems = [], []

    class Counted(Amplification):
        def growth(self, step):
            matrices.append(step)
            return super().growth(step)

    def linearised(system, **more):
        systems.append(system)
        return linear_network(system, **more)

    monkeypatch.setattr("herringbone.analysis.stability.diagnosis.Amplification", Counted)
    monkeypatch.setattr("herringbone.analysis.stability.diagnosis.linear_network", linearised)
    found = diagnose(two_rotors(0.02, 3.0), Jacobi(0), 8.0 * 0.02 / 3000.0)
    assert len(found.remedies) == 4
    assert len(systems) == 1
    assert len(matrices) < 60
