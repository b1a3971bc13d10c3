"""What is said of a search for a periodic motion."""

from collections.abc import Sequence

from herringbone.analysis.steady.harmonic_balance.orbit import Orbit
from herringbone.analysis.steady.marching.march import March
from herringbone.analysis.steady.marching.repeated import Repeated
from herringbone.analysis.steady.operating_point import Point
from herringbone.analysis.steady.searching.found import Found
from herringbone.analysis.steady.searching.guess import LONG, LONGEST, SETTLING, turns
from herringbone.analysis.steady.searching.irregular import Irregular
from herringbone.analysis.steady.structure import Structure
from herringbone.core import ParameterError
from herringbone.core.wording import percent

NO_ROTATION = (
    "no steady rotation: what drives and what loads balance at no speed; look for a load "
    "beyond what the drive gives"
)
NO_LOAD = "torque = 0 N m: nothing holds the teeth together, which drift apart; ask for a load"
FOLD = "fold: the branch turns back between the state before and this one"
GROWS = "unstable: small deviations grow, a run would leave this motion"
NO_SHOT = (
    f"shooting comes to no periodic motion from marches of up to {SETTLING:g} s; teeth that rattle "
    "may never repeat: ask for a larger torque, begin at a state nearby, or run it"
)


def other_flank(structure: Structure, gears: Sequence[str]) -> str:
    """Why a motion is none that a system has: its equations are those of the other flank."""
    return (
        f"{structure.system.name} was prepared for the other flank of {', '.join(gears)}, and its "
        "line of action: prepare it at this point, as 'steady' does"
    )


def not_marched(structure: Structure, still: Orbit) -> str:
    """Why no march from an equilibrium could come to a motion; empty if one could."""
    meshes, period = structure.meshes, still.period
    if not turns(still, meshes):
        return NO_ROTATION
    if period <= LONGEST:
        return ""
    longer = f"takes {period:.4g} s, longer than {LONGEST:g} s that are marched"
    if meshes == 1:
        return f"its period {longer}; take a higher speed"
    return (
        f"its period of {meshes} meshes {longer}; set run-outs and deviations to 0, take a higher "
        "speed, or run it"
    )


def told(times: int) -> tuple[str, ...]:
    """Of a motion that repeats after some periods only."""
    return (f"subharmonic: it repeats after {times} periods",) if times > 1 else ()


def unsettled(structure: Structure, march: March | None) -> str:
    """Why there is no march that could be followed to a motion."""
    if structure.problem.free is not None and structure.meshes > 1:
        return (
            f"nothing holds the speed, which drifts in a march over the {structure.meshes} meshes "
            "of its period; join a drive and a load, or set run-outs and deviations to 0"
        )
    if march is None:
        return "a march from equilibrium fails, too"
    return (
        f"no stable periodic motion was found: {SETTLING:g} s from equilibrium a march still "
        f"changes by {percent(march.least)} from one period to later ones; ask for a larger "
        "torque, or run it"
    )


def not_repeating(march: Repeated | None) -> str:
    """Why there is no march that repeats, of a period of many meshes."""
    if march is None:
        return "a march from equilibrium fails, too"
    return (
        f"no periodic motion was found: after {march.way.time:.3g} s from equilibrium a march "
        f"still changes by {percent(march.change)} from one period to later ones, though "
        "motions beside it come together; ask for a larger torque, or run it"
    )


def not_exact(found: Found, tolerance: float) -> str:
    """Why a march that repeats does not give the motion to a tolerance."""
    return (
        f"a march repeats, but at {found.orbit.resolved.per_mesh // 2} harmonics of the mesh and "
        f"the shortest of its steps its error is {found.errors.worst:.2g}, where {tolerance:g} is "
        "asked: ask for no less than that"
    )


def never_repeats(found: Irregular) -> str:
    """Why there is no periodic motion, and what there is."""
    parted, doubt = found.parting
    why = (
        "so that it never repeats"
        if found.parting.parts
        else "so that they hardly part, and do not come together either"
    )
    levels = "; ".join(
        f"{group.replace('_', ' ')} {min(own):.3g} to {max(own):.3g} rms"
        for group, own in found.levels.items()
    )
    return (
        f"irregular: teeth rattle; after {found.time:.3g} s from equilibrium a march still changes "
        f"by {percent(found.change)} from one period to later ones, and motions beside it part by "
        f"{percent(parted)} a mesh (+- {percent(doubt, 1)}), {why}; levels over its last periods: "
        f"{levels}; ask for a larger torque or finer teeth, or run it"
    )


def check_shooting(structure: Structure, point: Point) -> None:
    """Refuse what shooting cannot do; raises ParameterError."""
    name = structure.system.name
    if point.torque == 0.0:
        raise ParameterError(
            f"{name}: solver = shooting: {NO_LOAD}, or leave the solver to be chosen"
        )
    if structure.problem.free is not None:
        raise ParameterError(
            f"{name}: solver = shooting: nothing holds the speed, which would drift within a "
            "period; join a drive and a load, or leave the solver to be chosen"
        )
    if structure.meshes >= LONG:
        raise ParameterError(
            f"{name}: solver = shooting: a period of {structure.meshes} meshes is too long for it "
            f"(below {LONG}); set run-outs and deviations to 0, or leave the solver to be chosen"
        )
