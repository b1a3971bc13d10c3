"""Three questions to the test rig: what their planned answers cost and err.

    python -m campaigns.answers

in tests/. Each is planned, answered as planned, and held against a finer answer of the whole model.
Its cost stands beside two default runs: that of 994c202, 0.85 s of CPU per simulated second, and
today's; 0.2 s are simulated for an operating point. All are CPU times of the thread in the loop, of
two turns the lesser; the times of planning stand besides, cold where something has to be compiled.
"""

import math
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np

import herringbone as hb
from campaigns.plans import tell
from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import Question, apart, lines_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.steady.state import SteadyState
from herringbone.analysis.twin.fused.core import Core, Steps, closeness
from herringbone.analysis.twin.fused.measured import DEGREES
from herringbone.core.lean import WHOLE
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes, prepared
from herringbone.scenes import Ask, Motion, Operating, Scene
from herringbone.studies.planning.marching import Marched, marched
from herringbone.studies.planning.plan import Plan, plan
from herringbone.studies.planning.transient_plan import worst_of

_R_MIN = math.pi / 30.0
_BASE, _SIMULATED = 0.85, 0.2
"""Of the default run at 994c202: CPU seconds per second [1]; simulated for a point [s]."""
_RIG = "test_rig"
_STILL = {"gear_mesh.symmetry_deviation": 0.0}
_POINTS = 401
_FINE = 1e-5


class Answer(NamedTuple):
    """A planned answer: error over tolerance, CPU time [s], simulated time it stands for [s]."""

    name: str
    wanted: float
    over: float
    seconds: float
    simulated: float
    planning: float


def lesser(work: Callable[[], object], turns: int = 2) -> float:
    """CPU time of this thread [s]; of some turns the least."""
    spent = []
    with one_blas_thread():
        for _ in range(turns):
            begin = time.thread_time()
            work()
            spent.append(time.thread_time() - begin)
    return min(spent)


def default_of_the_day() -> float:
    """CPU seconds per simulated second of the default run of the rig."""
    long, short = 0.5, 0.1

    def run(t_end: float) -> float:
        return lesser(lambda: hb.run(_RIG, t_end=t_end))

    run(1e-3)
    return (run(long) - run(short)) / (long - short)


def planned(scene: Scene) -> Plan:
    """The plan, and its cost: warm, as the second one."""
    cold = plan(_RIG, scene=scene)
    warm = plan(_RIG, scene=scene)
    tell(f"   planning {cold.seconds:.2f} s the first time, {warm.seconds:.2f} s warm")
    tell(f"   choice: {warm.choice.solver}, {warm.choice.name}")
    return warm


def steady_answer(name: str, wanted: float, ask: Ask, speeds: np.ndarray) -> Answer:
    """Steady states at some speeds [rad/s], each from the one before."""
    tell(f"{name}: {speeds.size} points")
    ends = (float(speeds[0]), float(speeds[-1]))
    scene = Scene("asking", values=_STILL, asks=(ask,), operating=Operating(speed=ends))
    found = planned(scene)
    solver, _ = prepared_solver(
        _RIG, scene, Point(speed=ends[0]), Wishes(), tolerance=found.tolerance
    )
    own = solver.leaner(found.scene.model)
    seconds = lesser(lambda: solved(own, speeds))
    fine = solver.leaner(WHOLE, _FINE)
    (question,) = found.questions
    over = worst(question, solved(own, speeds), solved(fine, speeds)) / ask.tolerance
    return Answer(name, wanted, over, seconds, _SIMULATED * speeds.size, found.seconds)


def solved(solver: SteadySolver, speeds: np.ndarray) -> list[SteadyState]:
    """States at some speeds, each from the one before."""
    states: list[SteadyState] = []
    for speed in speeds:
        states.append(solver.solve(Point(speed=float(speed)), states[-1] if states else None))
    return states


def worst(question: Question, ours: list[SteadyState], theirs: list[SteadyState]) -> float:
    """The largest error of all points; infinite where one of them was not found."""
    if not all(state.converged for state in (*ours, *theirs)):
        return math.inf
    return max(
        apart(question, lines_of(one, question), lines_of(other, question)).error
        for one, other in zip(ours, theirs, strict=True)
    )


def run_up_answer(name: str, wanted: float, ask: Ask) -> Answer:
    """A march of the core through the scene `runup`, as planned."""
    tell(f"{name}:")
    scene = replace(
        prepared(_RIG, "runup", Wishes()).scene,
        asks=(ask,),
        operating=Operating(Motion.TRANSIENT),
    )
    found = planned(scene)
    core = Core(prepared(_RIG, scene, Wishes()).system)
    (question,) = found.questions
    steps = Steps(found.choice.step, DEGREES[0], closeness(ask.tolerance))

    def march(own: Steps) -> Marched:
        return marched(core, scene.t_end, scene.record_step, own, question.columns)

    seconds = lesser(lambda: march(steps))
    finest = march(steps._replace(length=0.125 * steps.length, close=0.01 * steps.close))
    over = worst_of([question], question.columns, march(steps), finest).error / ask.tolerance
    return Answer(name, wanted, over, seconds, scene.t_end, found.seconds)


def main() -> int:
    """Print; 0 if all three hold."""
    today = default_of_the_day()
    tell(f"default run: {_BASE:g} s per s at 994c202, {today:.3f} s per s today")
    at = np.array([1000.0 * _R_MIN])
    spectrum = Ask(("seat velocity",), Form.SPECTRUM, 0.01, 2000.0)
    level = Ask(("bearing force",), Form.LEVEL, 0.05)
    torque = Ask(("torque",), Form.SIGNAL, 1e-3)
    answers = [
        steady_answer("seat-velocity spectrum to 2 kHz, 1 %, steady", 20.0, spectrum, at),
        steady_answer(
            "levels of bearing forces, 5 %, 600 to 1800 r/min", 50.0, level,
            np.linspace(600.0, 1800.0, _POINTS) * _R_MIN,
        ),
        run_up_answer("torque in a run-up, 0.1 %", 3.0, torque),
    ]  # fmt: skip
    tell("")
    good = True
    for a in answers:
        with_plan = a.seconds + a.planning
        times = _BASE * a.simulated / a.seconds
        good &= times >= a.wanted and a.over <= 1.0
        tell(
            f"{a.name}: error over tolerance {a.over:.2g}; {1e3 * a.seconds:.3g} ms, "
            f"{times:.3g} times cheaper than 994c202 (asked {a.wanted:g}), "
            f"{today * a.simulated / a.seconds:.3g} times than today; planning included "
            f"{1e3 * with_plan:.4g} ms, {_BASE * a.simulated / with_plan:.3g} and "
            f"{today * a.simulated / with_plan:.3g} times"
        )
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
