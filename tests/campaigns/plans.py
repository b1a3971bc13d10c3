"""Plans of systems that they were not made with: estimates against the truth, rung by rung.

    python -m campaigns.plans [COUNT [SEED [SECONDS]]]

in tests/; the seed is the last commit's.

Pairs, housings, operating points and questions are drawn. Each rung of a plan's ladder is solved,
whatever its estimate is, at the points where it was estimated; what the plan chose is held against
the whole model at other points of the range, and its cost against that of the cheapest rung that
meets the tolerance there. One line per system, and what all of them say.
"""

import math
import random
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from fuzz.campaign import last_commit

from herringbone.analysis.leaner.form import Form
from herringbone.analysis.leaner.question import apart, lines_of
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.core import HerringboneError
from herringbone.housing import default_housing, write_housing
from herringbone.running.operating.questions import questions_of
from herringbone.running.operating.steady import prepared_solver
from herringbone.running.prepared import Wishes
from herringbone.scenes import Ask, Operating, Scene
from herringbone.scenes.asking import SHARE
from herringbone.studies.planning.certified import Certifier
from herringbone.studies.planning.estimated import Ladder
from herringbone.studies.planning.plan import plan
from herringbone.studies.planning.points import first_point, points_to_probe
from herringbone.studies.planning.rung import STEADY

_R_MIN = math.pi / 30.0
_LEAST, _LARGE = 1e-4, 0.3
_QUANTITIES = (
    "bearing force",
    "seat velocity",
    "mesh force",
    "transmission error",
    "radiated power",
    "sensor",
)
_FRESH, _TURNS = 5, 9


class Drawn(NamedTuple):
    """A system with a question."""

    system: str
    gear: Path
    housing: Path
    scene: Scene


class Pair(NamedTuple):
    """Estimate and truth of a rung."""

    name: str
    estimate: float
    truth: float


def tell(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def drawn(chance: random.Random, folder: Path) -> Drawn:
    """One system."""
    teeth = chance.randint(18, 40)
    wheel = round(teeth * chance.uniform(1.2, 3.5))
    module, helix = chance.uniform(2.5, 5.0), chance.uniform(15.0, 33.0)
    gear = folder / "pair.toml"
    gear.write_text(
        f"[gear_pair]\nnumber_of_teeth = [{teeth}, {wheel}]\n"
        f'normal_module = "{module:.3g} mm"\nhelix_angle = "{helix:.3g} deg"\n'
        f'face_width = "{chance.uniform(30, 60):.3g} mm"\ngap_width = "40 mm"\n'
        f'stub_length = "60 mm"\nshaft_diameter = ["{0.5 * module * teeth:.3g} mm", '
        f'"{0.5 * module * teeth:.3g} mm"]\n[mesh]\nbacklash = "120 um"\n'
        f"damping_ratio = {chance.uniform(0.04, 0.1):.3g}\n"
        '[table]\ntorque = "200 N m"\nmethod = "coupled-slices"\nphases = 16\n',
        encoding="utf-8",
    )
    model = default_housing()
    factors = np.array([chance.uniform(0.75, 1.3) for _ in model.frequency_hz])
    size = np.array([chance.uniform(0.6, 1.5) for _ in model.frequency_hz])
    housing = folder / "housing"
    write_housing(
        replace(
            model,
            frequency_hz=model.frequency_hz * chance.uniform(0.7, 1.3) * factors,
            shapes=model.shapes * size,
            static=None,
            residual=None,
            gram=np.asarray(model.gram) * np.outer(size, size),
            certificate={},
        ),
        housing,
    )
    form = chance.choice((Form.SPECTRUM, Form.LEVEL, Form.SIGNAL, Form.ORDER))
    orders = (1.0, 2.0, 3.0) if form is Form.ORDER else ()
    band = chance.uniform(1000.0, 4000.0) if form is Form.SPECTRUM else math.inf
    tolerance = 10.0 ** chance.uniform(-3.0, -1.0)
    what = chance.choice(_QUANTITIES)
    if what == "radiated power" and form is Form.SIGNAL:  # a mean over time has none
        form = Form.LEVEL
    ask = Ask((what,), form, tolerance, band, orders)
    low = chance.uniform(400.0, 2400.0)
    speed = (low * _R_MIN, low * chance.uniform(1.0, 1.25) * _R_MIN)
    torque = chance.uniform(80.0, 400.0)
    at = Operating(speed=speed, torque=(torque, torque))
    symmetric = {"gear_mesh.symmetry_deviation": chance.choice((0.0, 0.0, 5e-6))}
    scene = Scene("drawn", asks=(ask,), operating=at, values=symmetric)
    system = chance.choice(("test_rig", "gearbox"))
    if what == "sensor":  # the gearbox alone has none
        system = "test_rig"
    return Drawn(system, gear, housing, scene)


def every_rung(given: Drawn) -> Iterator[Pair]:
    """Estimate and truth of all rungs, at the middle of the range."""
    solver = _solver(given)
    questions = questions_of(solver.structure.core, given.scene.asks)
    at = given.scene.operating
    middle = replace(at, speed=(sum(at.speed) / 2.0,) * 2)
    (point,) = points_to_probe(middle)
    certifier = Certifier(solver, questions, [point], SHARE)
    fine = solver.leaner(solver.structure.core.lean, certifier.fine)
    ladder = Ladder(fine, [fine.solve(point)], questions)
    for rung in ladder.rungs():
        truth = certifier.error(rung.lean)
        yield Pair(rung.name, rung.estimate.error, math.nan if truth is None else truth.error)


def _solver(given: Drawn) -> SteadySolver:
    wishes = Wishes(gear=given.gear, housing=given.housing)
    return prepared_solver(given.system, given.scene, first_point(given.scene.operating), wishes)[0]


def chosen(given: Drawn, chance: random.Random) -> str:
    """What the plan chose, its error at fresh points, and its cost over the cheapest."""
    found = plan(given.system, scene=given.scene, gear=given.gear, housing=given.housing)
    solver = _solver(given)
    (question,) = found.questions
    low, high = given.scene.operating.speed
    torque = given.scene.operating.torque[0]
    points = [Point(chance.uniform(low, high), torque) for _ in range(_FRESH)]
    fine = solver.leaner(solver.structure.core.lean, question.tolerance / 20.0)
    own = solver.leaner(found.choice.lean, found.tolerance)
    worst = 0.0
    for point in points:
        ours, theirs = (lines_of(each.solve(point), question) for each in (own, fine))
        worst = max(worst, apart(question, ours, theirs).error)
    certifier = Certifier(solver, [question], points, SHARE)
    rungs = [rung for rung in found.rungs if rung.solver == STEADY]
    good = [
        rung
        for rung in rungs
        if not rung.lean or ((e := certifier.error(rung.lean)) and e.ratio <= 1.0)
    ]
    costs = certifier.costs([rung.lean for rung in good], rounds=_TURNS)
    mine = next(c for rung, c in zip(good, costs, strict=True) if rung is found.choice)
    over, cost = worst / question.tolerance, mine / min(costs)
    return (
        f"choice {found.choice.name}: error over tolerance {over:.2g}, cost over cheapest "
        f"{cost:.2f}, planned in {found.seconds:.2g} s"
    )


def _late(number: int, frame: object) -> None:
    del number, frame
    raise TimeoutError("not within the CPU time that a system has here")


def main(count: int = 20, seed: str | None = None, limit: int = 600) -> None:
    """Draw, and print; a system has some seconds of CPU time [s]."""
    signal.signal(signal.SIGPROF, _late)
    seed = last_commit() if seed is None else seed
    tell(f"seed {seed}")
    every: list[Pair] = []
    for number in range(count):
        chance = random.Random(f"{seed} {number}")
        begin = time.process_time()
        with tempfile.TemporaryDirectory() as folder:
            given = drawn(chance, Path(folder))
            (ask,) = given.scene.asks
            low, high = (speed / _R_MIN for speed in given.scene.operating.speed)
            tell(
                f"{number}: {given.system}, {ask.name}, {100 * ask.tolerance:.2g} %, "
                f"{low:.4g} to {high:.4g} r/min, {given.scene.operating.torque[0]:.4g} N m"
            )
            try:
                signal.setitimer(signal.ITIMER_PROF, limit)
                pairs = list(every_rung(given))
                counted = [p for p in pairs if _LEAST <= p.truth <= _LARGE]
                ratios = [p.estimate / p.truth for p in counted]
                spread = f"{min(ratios):.2g} to {max(ratios):.2g}" if ratios else "none"
                large = [p for p in pairs if p.truth > _LARGE]
                missed = sum(p.estimate <= _LARGE / 2.0 for p in large)
                tell(f"   {len(counted)} rungs, estimate over truth {spread}; large ones: "
                      f"{len(large)}, of which {missed} looked good")  # fmt: skip
                for p in counted:
                    if not 0.5 <= p.estimate / p.truth <= 2.0:
                        tell(f"   {p.name}: estimate {p.estimate:.3g}, truth {p.truth:.3g}")
                every += counted
                tell(f"   {chosen(given, chance)}")
            except (HerringboneError, TimeoutError) as error:
                tell(f"   {error}")
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0.0)
            tell(f"   {time.process_time() - begin:.1f} s of CPU")
    ratios = np.array([p.estimate / p.truth for p in every])
    within = np.mean((ratios >= 0.5) & (ratios <= 2.0)) if ratios.size else math.nan
    tell(f"{ratios.size} rungs: {100 * within:.1f} % within a factor 2, least {ratios.min():.3g}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20, *sys.argv[2:3], *map(int, sys.argv[3:4]))
