"""What every housing must do, whoever wrote it: the contract and its tests.

Variables: twelve forces on the housing `<seat>.f_x` ... [N] are inputs; the motions of the seats
`<seat>.s_x` ... [m] and `<seat>.v_x` ... [m/s] are outputs without direct dependence on inputs.
Behaviour, from rest: zero stays zero; a constant force leads to a constant deflection; the
compliance is reciprocal; responses add up; a force record never gets out more work than it put in;
a halved step changes little; velocities are the rates of the positions; the answer comes in the
step of the force. Vibration must not grow; whether it dies out is told, not asked for.

Behaviour is tested in `behaviour`.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import cache

import numpy as np

from herringbone.analysis.finding import Finding, judged, not_tested, remark
from herringbone.analysis.housing.behaviour import (
    SHORT,
    Behaviour,
    random_forces,
    steps_of_tests,
)
from herringbone.analysis.housing.runs import FORCES, POSITIONS, VELOCITIES, Runs
from herringbone.components.in_process import InProcessPart
from herringbone.components.registry import component_for
from herringbone.core import Instance, ParameterError
from herringbone.core.declaring.roles import Role
from herringbone.core.declaring.units import unit_dimension
from herringbone.core.part import Part, PartVariable
from herringbone.core.process.telling import Tell, untold
from herringbone.cosim.signature.trial import Refused
from herringbone.cosim.units import in_si_units

STEP = 2e-5
"""Communication step size [s] of the tests; two-way coupling wants no larger one."""
_VARIABLES = "variables"
_DECLARED = {_VARIABLES, "units", "dependencies"}
"""Tests without steps; if one fails, no other one is made."""
_FIRST = 4
"""Steps in which an FMU shows whether it repeats."""
_ENERGY = {"passivity", "damping"}
"""Tests that a housing fails which makes energy."""
_UNITS = (
    dict.fromkeys(FORCES, "N") | dict.fromkeys(POSITIONS, "m") | dict.fromkeys(VELOCITIES, "m/s")
)


def check_housing(
    open_part: Callable[[], Part],
    *,
    static: np.ndarray | None = None,
    usual: float | None = None,
    step: float = STEP,
    longest: int | None = None,
    progress: Tell = untold,
) -> list[Finding]:
    """Test a housing against the contract.

    Args:
        open_part: makes a new instance, not yet initialised.
        static: (12, 12) compliance at the seats to compare with [m/N], if it is known.
        usual: static compliance of a housing of this kind [m/N], see `compliance_of`; its size is
            compared with that.
        step: communication step size [s].
        longest: steps that a run may have; as many as the tests want if None.
        progress: called with what begins.

    Returns:
        One finding a test; if variables are wrong, nothing else is tested.

    Raises:
        HerringboneError: it does not start or does not step.
    """
    if not 0.0 < step < 1.0:
        raise ParameterError(f"step {step:g} s must be positive")
    part = open_part()
    try:
        findings = list(_declared(part))
    finally:
        part.close()
    if not all(finding.holds for finding in findings):
        return findings
    runs = Runs(lambda: in_si_units(open_part()), step, longest)
    tests = Behaviour(runs)
    for what, test in (
        ("no feedthrough", tests.feedthrough),
        ("no delay", tests.delay),
        ("v = ds/dt", tests.velocities),
        ("zero stays zero", tests.zero),
        ("static compliance", lambda: tests.statics(static)),
        ("compliance", lambda: tests.size(usual)),
        ("reciprocity", tests.reciprocity),
        ("superposition", tests.superposition),
        ("passivity", tests.passivity),
        ("step halving", tests.halving),
        ("damping", tests.damping),
    ):
        progress(what)
        try:
            findings.append(test())
        except Refused as error:
            findings.append(not_tested(what, str(error)))
        if what == "no delay" and longest is None:
            runs.tell_cost(part.name, steps_of_tests(), SHORT)
    return findings


def repeats(open_part: Callable[[], Part], findings: Sequence[Finding], step: float) -> bool:
    """True if two instances give equal bits in their first steps, or none was stepped.

    Args:
        open_part: makes a new instance, not yet initialised.
        findings: of its tests.
        step: communication step size [s].

    Raises:
        HerringboneError: it does not start or does not step.
    """
    if not all(finding.holds for finding in findings if finding.test in _DECLARED):
        return True
    runs, forces = Runs(lambda: in_si_units(open_part()), step), random_forces(0, step, _FIRST)
    return np.array_equal(runs.positions(forces), runs.positions(forces), equal_nan=True)


def compliance_of(open_part: Callable[[], Part]) -> float:
    """Largest static compliance of a seat of a housing, along the force [m/N].

    Args:
        open_part: makes a new instance, not yet initialised.
    """
    return Behaviour(Runs(lambda: in_si_units(open_part()), STEP)).compliance


@cache
def usual_compliance() -> float:
    """That of the component that is the housing if nothing else is said [m/N]."""
    return compliance_of(lambda: InProcessPart(Instance(component_for(Role.HOUSING), "usual")))


def looks_like_housing(part: Part) -> bool:
    """True if a part has all variables of a housing."""
    return all(finding.holds for finding in _declared(part) if finding.test == _VARIABLES)


def of_energy(findings: Sequence[Finding]) -> list[Finding]:
    """What says of a housing that was tested that it makes energy."""
    return [finding for finding in findings if finding.test in _ENERGY and not finding.holds]


def _declared(part: Part) -> Iterator[Finding]:
    wanted = {name: "input" for name in FORCES} | dict.fromkeys((*POSITIONS, *VELOCITIES), "output")
    missing = [
        name
        for name, causality in wanted.items()
        if name not in part.variables
        or part.variables[name].causality != causality
        or not part.variables[name].is_real
    ]
    count = f"{len(wanted) - len(missing)} of {len(wanted)}"
    shown = f"{count}; missing: {', '.join(missing[:3])}{', ...' if len(missing) > 3 else ''}"
    limit = "12 inputs f, 12 outputs s, 12 outputs v"
    yield judged(_VARIABLES, not missing, shown if missing else count, limit)
    present = [part.variables[name] for name in wanted if name not in missing]
    yield _units(present)
    direct = [v.name for v in present if v.causality == "output" and v.dependencies]
    undeclared = sum(v.causality == "output" and v.dependencies is None for v in present)
    shown = f"{undeclared} outputs say nothing" if undeclared else "none"
    shown = f"{direct[0]} and {len(direct) - 1} more" if direct else shown
    yield judged("dependencies", not direct, shown, "none of s, v on f")


def _units(present: Sequence[PartVariable]) -> Finding:
    """Whether units are of the right dimension; others than SI are brought to it."""
    known = [(v, v.dimension) for v in present if v.unit and v.dimension]
    wrong = [f"{v.name} in {v.unit}" for v, d in known if d[2] != unit_dimension(_UNITS[v.name])[2]]
    if wrong:
        return judged("units", False, ", ".join(wrong[:3]), "N, m, m/s")
    if others := sorted({str(v.unit) for v, d in known if d[:2] != (1.0, 0.0)}):
        return remark("units", f"{', '.join(others)}: brought to SI units", "N, m, m/s")
    bare = sum(not v.unit for v in present)
    shown = f"{bare} without unit, taken as SI" if bare else "declared"
    return judged("units", True, shown, "N, m, m/s")
