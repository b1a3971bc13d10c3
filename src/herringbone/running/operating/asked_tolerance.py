"""The solver's tolerance that what a scene asks needs, where a caller gives none."""

from herringbone.analysis.steady.solver import TOLERANCE
from herringbone.scenes import Motion, Scene
from herringbone.scenes.asking import SHARE


def asked_tolerance(scene: Scene) -> float:
    """Of steady states: what a plan found, or its share of the least that is asked.

    Never more than the usual one, as figures that nothing is asked of come with the answer.
    """
    at = scene.operating
    if not scene.asks or at.motion is Motion.TRANSIENT:
        return TOLERANCE
    least = SHARE * min(ask.tolerance for ask in scene.asks)
    return min(TOLERANCE, least, at.solver_tolerance or least)  # asks may be finer than planned


def tolerance_notes(scene: Scene, given: float | None) -> tuple[str, ...]:
    """A line if what is asked makes the solver finer than usual, and no tolerance was given."""
    tolerance = asked_tolerance(scene)
    if given is not None or tolerance >= TOLERANCE:
        return ()
    planned = scene.operating.solver_tolerance == tolerance
    why = "as planned" if planned else f"{SHARE:g} of the least tolerance that is asked"
    return (f"scene {scene.name}: solved to a tolerance of {tolerance:.2g}, {why}",)
