"""`run --plan`: what a scene asks is planned, and the choice is run."""

import argparse

from herringbone.commands.options import given_by, refuse_given
from herringbone.commands.output import say
from herringbone.commands.run.options import given_options
from herringbone.commands.studies.steady import tell
from herringbone.core import OutcomeKind, ParameterError
from herringbone.core.declaring.units import R_MIN
from herringbone.running.loading import load_scene, load_system
from herringbone.scenes import Motion
from herringbone.scenes.asking import Range
from herringbone.studies.planning.plan import Plan, plan
from herringbone.studies.planning.text import plan_text

_CHOSEN = ("algorithm", "step", "tolerance", "fuse", "record", "slow", "start", "t_end")
_OF_RUNS = ("verify", "reference", "parquet", "record_step", "fmu", "no_probe")
"""What a steady state has no use for."""


def planned(options: argparse.Namespace) -> Plan:
    """The plan, which is told.

    Raises:
        ParameterError: something is given that a plan chooses, or that it cannot take.
        HerringboneError: see `studies.planning.plan`.
    """
    given = given_options(options)
    taken = [name for name in (*_CHOSEN, "replace") if name in given]
    if options.speed is not None or options.torque is not None:
        raise ParameterError(
            "--plan is for the operating point of the scene: give speed and torque in its table "
            "[operating], and drop --speed and --torque"
        )
    if taken:
        names = ", ".join(f"--{name.replace('_', '-')}" for name in taken)
        raise ParameterError(f"--plan chooses the model and the solver; drop {names}")
    scene = load_scene(load_system(options.system)[1], options.scene)
    if scene.asks and scene.operating.motion is not Motion.TRANSIENT:
        why = f"of a run over time; scene {scene.name} asks of steady states, so leave it out"
        refuse_given(options, [name for name in _OF_RUNS if name in given], why)
    found = plan(
        options.system,
        scene=options.scene,
        **given_by(options),
    )
    say("\n".join(plan_text(found)))
    return found


def as_chosen(options: argparse.Namespace, found: Plan) -> argparse.Namespace:
    """Options of the fused run that a plan of a transient chose."""
    columns = dict.fromkeys(c for question in found.questions for c in question.columns)
    own = {"fuse": True, "step": found.choice.step, "record": list(columns), "plan": False}
    return argparse.Namespace(**{**vars(options), **own})


def run_steady(options: argparse.Namespace, found: Plan) -> OutcomeKind:
    """Solve for the steady state that a plan chose, show it, and write files if it is asked for.

    Raises:
        ParameterError: it is asked over a range.
        HerringboneError: see `running.operating.steady`.
    """
    from herringbone.analysis.steady.state import SteadyState  # noqa: PLC0415 (numba)
    from herringbone.running.operating.questions import answers  # noqa: PLC0415
    from herringbone.running.operating.steady import steady  # noqa: PLC0415

    at = found.scene.operating
    state = steady(
        options.system,
        scene=found.scene,
        speed=_one(at.speed, "speed", R_MIN, "r/min"),
        torque=_one(at.torque, "torque", 1.0, "N m"),
        tolerance=found.tolerance,
    )
    for note in state.notes:
        say(note)
    if isinstance(state, SteadyState) and state.converged:
        for line in answers(state, found.scene.asks):
            say(line)
    tell(state, {}, options.output, as_json=options.json, pictures=not options.no_pictures)
    return OutcomeKind.COMPLETED if state.converged else OutcomeKind.DIVERGED


def _one(ends: Range | None, name: str, factor: float, unit: str) -> float | None:
    if ends is None:
        return None
    low, high = ends
    if low != high:
        raise ParameterError(
            f"--plan: {name} from {low * factor:.5g} to {high * factor:.5g} {unit}: a run is "
            "at one operating point; use 'herringbone plan SYSTEM --scene S -o FOLDER', "
            f"then 'herringbone sweep SYSTEM --scene FOLDER/scene.toml --{name} START:STOP:COUNT'"
        )
    return low
