"""Plans: how much model, and which solver, a scene's questions need."""

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from herringbone.analysis.leaner.question import Question
from herringbone.analysis.steady.solver import SteadySolver
from herringbone.analysis.twin.fused.core import Core
from herringbone.analysis.twin.monolithic import refuse_foreign_parts
from herringbone.core import ParameterError
from herringbone.core.facts import Facts
from herringbone.core.lean import WHOLE
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.core.wording import option
from herringbone.cosim.structure.system import System
from herringbone.running.loading import load_scene, system_and_folder, with_options
from herringbone.running.operating.at_point import prepared_at
from herringbone.running.operating.questions import questions_of
from herringbone.running.pairs.gears import Gear
from herringbone.running.prepared import Named, Wishes, prepared
from herringbone.scenes import Model, Motion, Scene
from herringbone.studies.planning.certified import FINER, tolerance_for
from herringbone.studies.planning.joint import Joint, joint_choices
from herringbone.studies.planning.points import first_point
from herringbone.studies.planning.rung import Rung
from herringbone.studies.planning.steady_plan import steady_rungs
from herringbone.studies.planning.transient_plan import transient_rungs


@dataclass(frozen=True, repr=False)
class Plan(Facts):
    """How much model, and which solver, a scene's questions need.

    Attributes:
        system: name.
        scene: that asks; its model is the choice.
        questions: what is asked.
        rungs: the ladder, the whole model first.
        tolerance: for the solver of the choice.
        seconds: CPU time that planning took [s].
        notes: lines that the user should read.
        joint: joint choices of model and solver, if they were asked for.
    """

    system: str
    scene: Scene
    questions: tuple[Question, ...]
    rungs: tuple[Rung, ...]
    tolerance: float
    seconds: float
    notes: tuple[str, ...] = ()
    joint: tuple[Joint, ...] = ()

    @property
    def choice(self) -> Rung:
        """The rung that is taken."""
        return next(rung for rung in self.rungs if not rung.why)

    @property
    def saved(self) -> float:
        """CPU time that leaving out saves in an answer [s]; 0 if nothing is left out."""
        whole = next((rung.cost for rung in self.rungs if rung.whole), None)
        return max(0.0, (whole or 0.0) - (self.choice.cost or 0.0))

    def _facts(self) -> dict[str, str]:
        return {
            "system": self.system,
            "scene": self.scene.name,
            "asks": "; ".join(question.name for question in self.questions),
            "choice": f"{self.choice.solver}, {self.choice.name}",
            "planning": f"{self.seconds:.2g} s",
        }


@one_blas_thread()
def plan(
    system: str | Path | System,
    *,
    scene: str | Path | Scene | None = None,
    values: Mapping[str, float | str | Path] | None = None,
    gear: Gear | Mapping[str, Gear] | None = None,
    housing: Named | None = None,
    chart: bool = False,
    for_fmu: bool = False,
    estimated: Callable[[Sequence[Rung]], None] | None = None,
) -> Plan:
    """The least model and the solver that answer what a scene asks.

    Errors of leaner models are estimated from one linear solve at motions of the whole one, before
    any is solved; what looks good enough is solved, at other operating points, and so is the whole.

    Args:
        system, scene, values, gear, housing: see `herringbone.run`; the scene asks.
        for_fmu: choose what an FMU can do without, as much as may go; states are its cost.
        estimated: called with the ladder of steady states and its estimates, before any leaner
            model is solved.
        chart: also solve joint choices of model and tolerance, for a picture; of steady states.

    Raises:
        ParameterError: the scene asks nothing, or what it asks is not there; or a chart of
            transients is asked for.
        HerringboneError: something about the input is wrong, or a part is a foreign FMU.
    """
    begin, charted = time.process_time(), None
    own = Wishes(values=values or {}, gear=gear, housing=housing, lean=True)
    asking = _with_files(_scene(system, scene), gear, housing)
    if not asking.asks:
        raise ParameterError(
            f"scene {asking.name}: it asks nothing; add [[ask]], see docs/plans.md"
        )
    if asking.operating.motion is Motion.TRANSIENT:
        if chart:
            raise ParameterError(
                f"{option('chart', True)}: of steady states; scene {asking.name} asks of transients"
            )
        found = prepared(system, scene, own)
        refuse_foreign_parts(found.system, "no plan can be certified")
        core = Core(found.system)
        questions = questions_of(core, asking.asks)
        rungs, said = transient_rungs(core, questions, asking)
        tolerance = min(question.tolerance for question in questions)
    else:
        at = first_point(asking.operating)
        found = prepared_at(at, system, scene, own)
        refuse_foreign_parts(found.system, "no plan can be certified")
        solver = SteadySolver(found.system)
        questions = questions_of(solver.structure.core, asking.asks)
        fine = solver.leaner(WHOLE, tolerance_for(questions, 1.0 / FINER))
        rungs, certifier, said = steady_rungs(
            fine, questions, asking, asking.model.left_out, for_fmu=for_fmu, estimated=estimated
        )
        tolerance, charted = certifier.tolerance, certifier
        at_it = replace(asking.operating, solver_tolerance=tolerance)
        asking = replace(asking, operating=at_it)
    asking = with_options(asking, values=values)
    notes = (*found.notes, *said)
    made = _made(found.system, asking, questions, rungs, tolerance, begin, notes)
    if chart and charted is not None:
        return replace(made, joint=tuple(joint_choices(charted, rungs)))
    return made


def _scene(system: str | Path | System, scene: str | Path | Scene | None) -> Scene:
    return load_scene(system_and_folder(system)[1], scene)


def _with_files(scene: Scene, gear: object, housing: object) -> Scene:
    """A scene with the files that the caller gave besides, so that it is whole."""
    gears, housings = _files(gear, "gear"), _files(housing, "housing")
    return replace(scene, gears={**scene.gears, **gears}, housings={**scene.housings, **housings})


def _files(given: object, name: str) -> dict[str, Path]:
    """Files by path of their part; "": of the only one."""
    own = dict(given) if isinstance(given, Mapping) else {} if given is None else {"": given}
    found = {}
    for path, file in own.items():
        if not isinstance(file, str | Path):
            raise ParameterError(f"plan: {name}: give a file, which the planned scene can name")
        found[str(path)] = Path(file)
    return found


def _made(
    system: System,
    scene: Scene,
    questions: list[Question],
    rungs: list[Rung],
    tolerance: float,
    begin: float,
    notes: tuple[str, ...],
) -> Plan:
    choice = next(rung for rung in rungs if not rung.why)
    at = scene.operating
    error = None if choice.measured is None else choice.measured.largest
    model = Model()
    if choice.lean:
        model = Model(**vars(choice.lean), error=error, speed=at.speed, torque=at.torque)
    return Plan(
        system.name, replace(scene, model=model), tuple(questions), tuple(rungs), tolerance,
        time.process_time() - begin, notes,
    )  # fmt: skip
