"""What every coupling algorithm must keep, as checks of one algorithm each.

Algorithms come from the registry, in the variants that their classes declare; what they claim is
read from them. A check raises AssertionError if a claim is false. Exact subsystems leave nothing
but the coupling's error; limits are those of two rotors, whose parts are the product's own.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.linalg import expm

from herringbone.analysis.accuracy.error import relative_error
from herringbone.analysis.stability.amplification import Amplification
from herringbone.analysis.stability.atlas import simulated_limit, two_rotors
from herringbone.analysis.stability.bonds import highest_frequency
from herringbone.analysis.stability.growth import Growth
from herringbone.analysis.stability.linear_parts import linear_network
from herringbone.analysis.stability.steps.step_scan import unstable_bands
from herringbone.core import ParameterError
from herringbone.core.energy_report import EnergyReport, Verdict
from herringbone.cosim.algorithms import ALGORITHMS, Algorithm, adapts
from herringbone.cosim.rows.recording import Recording
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System
from support.parts.running import columns, open_in_process, slope
from support.parts.two_masses import MOTION, TWO_MASS_SYSTEM, Ramp, TwoMass, every_step


def variants() -> tuple[Algorithm, ...]:
    """All registered algorithms, in all variants that their classes declare."""
    kinds = ALGORITHMS.values()
    return tuple(dict.fromkeys(a for kind in kinds for a in (*kind.variants(), *kind.charted())))


ITERATED = [kind() for kind in ALGORITHMS.values() if "rollback" in kind.needs]
"""Those that repeat steps, with their defaults."""
STAGED = [a for a in variants() if not a.needs]
"""Those that step each part once, whatever it can do, in all variants."""


def every(claim: Callable[[Algorithm], bool] = lambda _: True) -> pytest.MarkDecorator:
    """Parametrise a test over all variants of which a claim is true."""
    return pytest.mark.parametrize("algorithm", [a for a in variants() if claim(a)], ids=str)


def keeps_its_step(algorithm: Algorithm) -> bool:
    """Not adaptive."""
    return not algorithm.adaptive


# -- two exact masses ---------------------------------------------------------------------------

PROBLEM = TwoMass(zeta=0.1, start=(0.0, 0.0))
"""In equilibrium; w = 1 rad/s, so that a step is h w."""
DRIVEN = System(
    "driven",
    "",
    (*TWO_MASS_SYSTEM.parts, PartSpec("ramp")),
    (*TWO_MASS_SYSTEM.connections, ("ramp.flange.f", "left.load.f")),
)
"""The left mass is pulled with t N: smooth, and no force or rate to begin with."""
T_END = 4.0
COARSEST, FINEST, EXACT = 0.8, 0.025, 1e-12
"""Steps of the ladder, and the error at which it ends: rounding leaves 1e-14."""
DEVIATION = 0.2
"""Of a slope from a whole number: what higher powers leave at the last steps. The next is 1 off."""


def run(algorithm: Algorithm, h: float, t_end: float = T_END, slow=None, **more) -> Recording:
    """Run the driven masses with new participants, recording every step."""
    parts = [*PROBLEM.parts(**({"acceleration": True} | more)), Ramp("ramp", 1.0)]
    return simulate(DRIVEN, parts, algorithm, every_step(algorithm, h, t_end), slow=slow)


def exact(h: float, count: int) -> np.ndarray:
    """Motions (count, 4) of the driven masses, every h s."""
    (m1, m2), k, c = PROBLEM.mass, PROBLEM.stiffness, PROBLEM.damping
    rates = np.zeros((6, 6))  # of s1, v1, s2, v2, force, 1
    rates[0, 1] = rates[2, 3] = rates[4, 5] = 1.0
    rates[1, :5] = np.array([-k, -c, k, c, 1.0]) / m1
    rates[3, :4] = np.array([k, c, -k, -c]) / m2
    step, found = expm(rates * h), [np.eye(6)[5]]
    while len(found) < count:
        found.append(step @ found[-1])
    return np.array(found)[:, :4]


def error(recording: Recording) -> float:
    """Of all motions, relative."""
    assert recording.outcome.completed
    solution = exact(recording.time[1], recording.time.size)
    found = columns(recording, MOTION) - solution
    return float(np.linalg.norm(found) / np.linalg.norm(solution))


def measured_order(algorithm: Algorithm, **more) -> float:
    """Slope of the error over the last two steps of a ladder that halves them."""
    steps, errors = [COARSEST], [error(run(algorithm, COARSEST, **more))]
    while len(steps) < 2 or (errors[-1] > EXACT and steps[-1] > FINEST):
        steps.append(0.5 * steps[-1])
        errors.append(error(run(algorithm, steps[-1], **more)))
    return slope(steps[-2:], errors[-2:])


def check_order(algorithm: Algorithm) -> None:
    """The error falls with the declared power of the step."""
    found, declared = measured_order(algorithm), algorithm.convergence_order
    assert abs(found - declared) < DEVIATION, f"order {found:.2f} is declared as {declared}"


def check_end(algorithm: Algorithm) -> None:
    """The last communication point is the end, whether steps divide it or not."""
    for h, t_end in ((0.1, 3.0), (0.07, 1.0), (1.0, 1.0)):
        found = run(algorithm, h, t_end)
        assert found.outcome.completed
        assert found.outcome.message == found.outcome.culprit == ""
        assert abs(found.time[-1] - t_end) <= 1e-15 * t_end
        assert found.outcome.time == found.time[-1]
        assert found.time.size == found.macro_steps + 1 == len(found.values)


def check_determinism(algorithm: Algorithm) -> None:
    """Two runs with one algorithm have the same bits."""
    first, second = (run(algorithm, 0.1, 20.0) for _ in range(2))
    assert first.time.tobytes() == second.time.tobytes()
    assert first.values.tobytes() == second.values.tobytes()


def check_cost(algorithm: Algorithm) -> None:
    """As many passes a macro step as declared; all but one are taken back.

    The few of a Jacobian, if there is one, are less than a further pass a step would be. The spring
    takes all of them, as it sees both forces, and a mass those of its own.
    """
    found = run(algorithm, 0.1)
    for part in ("left", "right", "spring"):
        more = found.passes[part] - found.macro_steps * algorithm.passes
        assert 0 <= more < found.macro_steps
    left, right, spring = (found.passes[part] for part in ("left", "right", "spring"))
    assert spring - found.rollbacks == found.macro_steps
    assert left == right
    assert 0 <= 2 * (spring - left) <= spring - found.macro_steps * algorithm.passes
    assert (found.rollbacks > 0) == ("rollback" in algorithm.needs)


def refusal(algorithm: Algorithm, **options) -> str:
    """Why a run is refused; empty if it completes."""
    try:
        assert run(algorithm, 0.1, **options).outcome.completed
    except ParameterError as why:
        return str(why)
    return ""


def check_needs(algorithm: Algorithm) -> None:
    """What is declared is needed, and what is not declared is not.

    Without accelerations a run falls back, with a note.
    """
    why = refusal(algorithm, states=False)
    assert ("cannot save and restore its state" in why) == ("rollback" in algorithm.needs)
    assert bool(why) == ("rollback" in algorithm.needs)
    notes = [run(algorithm, 0.1, acceleration=known).notes for known in (True, False)]
    assert (notes[0] != notes[1]) == ("accelerations" in algorithm.needs)


def check_slow_bodies(algorithm: Algorithm) -> None:
    """With a body that steps once in five steps the second order is left, or it is refused.

    The predicted velocity of a slow body errs by H^2 a' / 2, and a damper feels it.
    """
    slow = {"right": 5}
    why = refusal(algorithm, slow=slow)
    assert ("steps all bodies alike" in why) != algorithm.multirate
    if not algorithm.multirate:
        return
    assert not why
    found = run(algorithm, 0.1, slow=slow)
    assert 5 * found.passes["right"] == found.macro_steps
    order = min(algorithm.convergence_order, 2)
    assert abs(measured_order(algorithm, slow=slow) - order) < DEVIATION


# -- adaptive steps -----------------------------------------------------------------------------

LOW, HIGH = 0.1, 5.0
"""Error over tolerance: the estimate is that of the forces, not of what a system makes of them."""


def check_adaptive(algorithm: Algorithm) -> None:
    """The error follows the tolerance; without one, all steps are those of the grid."""
    if not algorithm.adaptive:
        found = run(algorithm, 0.1)
        assert found.steps is None
        assert np.ptp(np.diff(found.time)) < 1e-14
        return
    assert adapts(type(algorithm))
    problem, longer = TwoMass(zeta=0.02), 0.0
    for tolerance in (1e-4, 1e-3, 1e-2):
        adapted = replace(algorithm, tolerance=tolerance)
        found = problem.run(adapted, 2.0, 20.0)
        s1, v1, s2, v2 = problem.exact(found.time).T
        force = problem.stiffness * (s1 - s2) + problem.damping * (v1 - v2)
        off = relative_error(columns(found, ("spring.b.f",)), force[:, None], found.time)
        assert LOW <= off / tolerance <= HIGH
        assert found.steps is not None
        assert found.steps.median > longer
        longer = found.steps.median


# -- two rotors ---------------------------------------------------------------------------------

ZETAS = (0.02, 0.1)
FREQUENCY = 3000.0
"""Of the rotors' bond [rad/s]."""
SMALLEST, LARGEST = 0.01 / FREQUENCY, 20.0 / FREQUENCY
TWO_SCANS = 0.02
"""Both limits are found to 1 %."""
SIDE = 0.02
SEEN = 1e-2
"""Growth per step that the monitor must flag; `test_energy_monitor` counts what is slower."""


@cache
def rotors(zeta: float) -> System:
    """Two free rotors and a coupling."""
    return two_rotors(zeta, 3.0)


@cache
def predicted(
    algorithm: Algorithm, zeta: float
) -> tuple[Callable[[float], Growth], tuple[tuple[float, float], ...]]:
    """Growth over the step, and unstable bands [s]."""
    growth = cache(Amplification(*linear_network(rotors(zeta)), algorithm).growth)
    return growth, unstable_bands(growth, SMALLEST, LARGEST)


def check_limit(algorithm: Algorithm, zeta: float) -> None:
    """Runs of the same parts change sides at the predicted step."""
    _, bands = predicted(algorithm, zeta)
    assert bands
    seen, limit = simulated_limit(rotors(zeta), algorithm, bands), bands[0][0]
    said = f"runs change sides at {seen:.3g} s, predicted {limit:.3g} s"
    assert abs(seen / limit - 1.0) < TWO_SCANS, said  # NaN if nowhere near


def watched(algorithm: Algorithm, zeta: float, step: float) -> EnergyReport:
    """What the monitor says of a run of the rotors, one of which is kicked."""
    kicked = rotors(zeta).with_values({"left.speed": 1e-3})
    grid = make_grid(3000.0 * step, step, step)
    frequency = highest_frequency(*linear_network(kicked))
    found = simulate(kicked, open_in_process(kicked), algorithm, grid, bond_frequency=frequency)
    assert found.energy is not None
    return found.energy


def check_energy(algorithm: Algorithm, zeta: float) -> None:
    """Flagged beyond the limit, silent below, even after the motion has died out to rounding.

    Far below it all is fine. So it is with an adaptive step.
    """
    if algorithm.adaptive:
        assert watched(algorithm, zeta, 1.0 / FREQUENCY).verdict is Verdict.FINE
        return
    growth, bands = predicted(algorithm, zeta)
    limit, end = bands[0]
    inside = limit * (1.0 + SIDE) ** np.arange(1, 120)
    beyond = next(s for s in inside[inside < end] if growth(s).radius > 1.0 + SEEN)
    assert watched(algorithm, zeta, beyond).verdict is Verdict.UNSTABLE
    assert watched(algorithm, zeta, (1.0 - SIDE) * limit).verdict is not Verdict.UNSTABLE
    far = watched(algorithm, zeta, limit / 25.0)
    assert far.verdict is Verdict.FINE
    assert far.ratio is None or math.fabs(far.ratio) < 0.1
