"""Inner steps of a system's own parts for a tolerance.

A part is stepped from node to node of the forces' polynomials. One inner step there errs about as
much as `li` of degree 3 with the macro step that suits the tolerance (see `step_error.INNER`); more
of them would cost time for nothing. So the longest inner step is the distance of two nodes at that
macro step, which the fastest bond gives by `LI.accurate_step`; polynomials of degree 4 are for
longer macro steps, and take shorter inner ones beside each other. It is not longer than follows
what a part does by itself, such as teeth that swing against each other, nor than is stable. Where
the run begins without load, or with a kick, teeth part: there `separation_step` tells. An inner
step that is set by name stays.
"""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from herringbone.analysis.anatomy import anatomy, value_at
from herringbone.analysis.set_points import pinion_teeth, speed_of
from herringbone.analysis.stability.bonds import highest_frequency
from herringbone.analysis.stability.recommendation import RULE_ERROR, separation_step
from herringbone.components.registry import component
from herringbone.core import Instance
from herringbone.core.caching.remembered import Remembered
from herringbone.core.declaring.roles import Quantity, Role
from herringbone.core.declaring.variable import Causality, Variability, Variable
from herringbone.core.places.part_path import PartPath, in_groups
from herringbone.cosim.algorithms import LI
from herringbone.cosim.layouts.inner_stepping import InnerStepping
from herringbone.cosim.structure.system import System
from herringbone.running.content import contents_of_system
from herringbone.running.steps.cheapest_degree import cheapest_degree
from herringbone.running.steps.linear_gearbox import STABLE, Linear, linear, stable_step

_known: Remembered["_Chosen"] = Remembered(256)
_LI = LI()
_RULE = _LI.accurate_step or 0.0
_BY_DEGREE = {4: 0.7}
"""Inner steps beside polynomials of this degree, over those beside degree 3."""
_OPEN, _KICKED = 0.5, 1.5
"""Error by `separation_step` over the tolerance. Macro steps are short while teeth part: for a few
blows they do."""
_SHORTEST = 5e-7
"""Where teeth part [s]: a millisecond takes two thousand of them."""
_ORDER = 4
"""Of the error of classical Runge-Kutta."""
_FOLLOWS = 1.1
"""Step times frequency, as STABLE, at the rule's error of 1e-3; the phase of a swing errs by 1/120
of its fourth power in every radian. That hardly shows in bearing forces, but in velocities of the
gears, and where teeth meet: errors were 3.7 and 1.8 times the tolerance without, on `on_ground` and
in `tip_out` of `e_axle`. Macro steps get longer by it, as inner steps take less of the tolerance.
"""
_SHOWN = 0.75
"""Times that, where velocities of the gears are recorded: `on_ground` erred 2.7 times 1e-3 without,
and the error falls with the fourth power."""

_MESHES = 0.08
"""Step over the period of meshing, at the rule's error of 1e-3: a table's kinks have harmonics."""


class InnerSteps(NamedTuple):
    """Inner steps that were chosen.

    Attributes:
        system: with them.
        stepping: the longest of gear pairs, or of all parts where there is none; parts of a system
            with pairs may take longer ones while the run goes on, up to what is stable for pairs,
            where teeth do not part and no velocities of gears are recorded.
        degree: of the forces' polynomials.
        lines: what they are, and why where that is not the tolerance.
    """

    system: System
    stepping: InnerStepping
    degree: int
    lines: tuple[str, ...] = ()

    @property
    def longest(self) -> float:
        """See `InnerStepping` [s]."""
        return self.stepping.longest


def with_inner_steps(
    system: System,
    tolerance: float,
    degree: int | None = 3,
    *,
    kicked: bool = False,
    apart: float = LI.default_largest_step,
) -> InnerSteps:
    """The system with inner steps that suit a tolerance, where none are set by name.

    Args:
        system: with all values.
        tolerance: relative error that the inner steps may leave [1].
        degree: of the forces' polynomials; None: see `cheapest_degree`.
        kicked: the run does not begin in equilibrium, so that teeth may part for a while.
        apart: time between rows [s].
    """
    asked = (tolerance, degree, kicked, apart, *system.channels.items())
    key = (system.name, *contents_of_system(system), *asked)
    found = _known(key, lambda: _chosen(system, tolerance, degree, kicked, apart))
    stepping = InnerStepping(_longest(system, found.steps), *_longer(system, found))
    return InnerSteps(system.with_values(found.steps), stepping, found.degree, found.lines)


class _Chosen(NamedTuple):
    """Inner steps [s] by path, the longest that they may get, degree and lines."""

    steps: dict[str, float]
    most: dict[str, float]
    degree: int
    lines: tuple[str, ...]


def _longer(system: System, found: _Chosen) -> tuple[Mapping[str, float], float]:
    """Steps by path, if those of all gear pairs are chosen, and times that they may be longer.

    Tunable ones of other parts, which do not swing by themselves, follow if they may go as far.
    """
    pairs = _paths_of_pairs(system)
    if not pairs or not found.most or not all(path in found.steps for path in pairs):
        return {}, 1.0
    times = {path: found.most[path] / step for path, step in found.steps.items()}
    most = min(times[path] for path in pairs)
    follow = [path for path in times if times[path] >= most and _is_tunable(system, path)]
    return {path: found.steps[path] for path in follow}, most


def _chosen(
    system: System, tolerance: float, degree: int | None, kicked: bool, apart: float
) -> _Chosen:
    """See `with_inner_steps`."""
    found = linear(system)
    bond = highest_frequency(found.network, found.members) if found else 0.0
    if found is None or not bond:
        return _Chosen({}, {}, degree or cheapest_degree(None, tolerance, apart), ())
    part = found.open or kicked
    degree = degree or cheapest_degree(None if part else bond, tolerance, apart)
    macro = _RULE / bond * (tolerance / RULE_ERROR) ** (1.0 / _LI.convergence_order)
    wanted = macro / _LI.degree * _BY_DEGREE.get(degree, 1.0)
    why = ""
    blows = separation_step((_OPEN if found.open else _KICKED) * tolerance)
    if part and blows < wanted:
        wanted = max(blows, _SHORTEST)
        why = "the shortest that is taken" if wanted > blows else "because teeth part"
    stable = _stable(system, found)
    follows = _FOLLOWS / STABLE * (tolerance / RULE_ERROR) ** (1.0 / _ORDER)
    follows *= _SHOWN if _gears_are_recorded(system) else 1.0
    meshing = _meshing(system, tolerance)
    chosen = {
        path: min(wanted, min(follows, 1.0) * longest, meshing) for path, longest in stable.items()
    }
    pairs = _paths_of_pairs(system)
    most = {
        path: max(chosen[path], min(longest, meshing)) if path in pairs else longest
        for path, longest in stable.items()
    }
    said = []
    for path, step in chosen.items():
        own = "as it swings by itself" if follows < 1.0 else "the longest that is stable"
        own = "as teeth mesh so fast" if step == meshing else own
        reason = why if step == wanted else own
        said.append(f"{path} {1e6 * step:.3g} us" + f" ({reason})" * bool(reason))
    kept = part or _gears_are_recorded(system)
    found_steps = _Chosen(chosen, {} if kept else most, degree, ())
    longer, times = _longer(system, found_steps)
    which = "" if len(longer) == len(chosen) else f"{', '.join(longer)} "
    more = f"; {which}up to {times:.3g} times longer where they err little"
    line = f"inner steps: {', '.join(said)}" + more * (times > 1.0)
    return found_steps._replace(lines=(line,) if said else ())


def _paths_of_pairs(system: System) -> list[str]:
    """Inner steps of own gear pairs."""
    known = anatomy(system).with_role(Role.GEAR_PAIR)
    return [path for part, path in _paths(system) if part in known]


def _meshing(system: System, tolerance: float) -> float:
    """The longest step [s] that follows what meshing excites at the start's speeds."""
    fastest = 0.0
    for pair in anatomy(system).with_role(Role.GEAR_PAIR):
        if teeth := pinion_teeth(system, pair):
            turns = value_at(system, speed_of(system, pair)) / (2.0 * math.pi)
            fastest = max(fastest, abs(turns) * teeth)
    share = _MESHES * (tolerance / RULE_ERROR) ** (1.0 / _ORDER)
    return share / fastest if fastest else math.inf


def _gears_are_recorded(system: System) -> bool:
    """True if errors are measured by what gear pairs themselves do."""
    pairs = anatomy(system).with_role(Role.GEAR_PAIR)
    outputs = [
        f"{pair}.{v.name}"
        for pair in pairs
        if not system.part(pair).foreign
        for v in component(str(system.part(pair).component)).declaration.variables
        if v.causality is Causality.OUTPUT
    ]
    return bool(in_groups([PartPath(pair) for pair in pairs], outputs, system.channels))


def stable_inner_steps(system: System) -> dict[str, float]:
    """The longest inner step [s] that own parts may take, by path, where none is set by name."""
    return _stable(system, linear(system))


def _paths(system: System) -> Iterator[tuple[str, str]]:
    """Own parts with an inner step to set, and its path."""
    known = anatomy(system)
    for part in known.parts:
        path = known.column(part, Quantity.MICRO_STEP)
        if path and not system.part(part).foreign:
            yield part, path


def _stable(system: System, found: Linear | None) -> dict[str, float]:
    """See `stable_inner_steps`; of a part that could not be made linear the declared step."""
    members = found.members if found else []
    own = {member.name: member for member in members if isinstance(member, Instance)}
    steps = {}
    for part, path in _paths(system):
        declared = _declared(system, path)
        if declared.name not in system.part(part).values:
            stable = stable_step(own[part]) if part in own else float(declared.start)
            steps[path] = min(stable, declared.maximum or stable)
    return steps


def _longest(system: System, chosen: dict[str, float]) -> float:
    """The longest inner step of the gear pairs, or of all parts; 0 if there is none."""
    known = anatomy(system)
    paths = dict(_paths(system.with_values(chosen)))
    gears = [paths[part] for part in known.with_role(Role.GEAR_PAIR) if part in paths]
    return max((_value(system, path, chosen) for path in gears or paths.values()), default=0.0)


def _declared(system: System, path: str) -> Variable:
    name, variable = system.split(path)
    return component(str(system.part(name).component)).declaration.variable(variable)


def _is_tunable(system: System, path: str) -> bool:
    return _declared(system, path).variability is Variability.TUNABLE


def _value(system: System, path: str, chosen: dict[str, float]) -> float:
    declared = _declared(system, path)
    values = system.part(system.split(path)[0]).values
    return float(chosen.get(path, values.get(declared.name, declared.start)))
