"""What a tolerance asks for, and what the coupling errs then, where parts are strange and not.

    python -m campaigns.tolerances [COUNT [SEED [SYSTEM ...]]]

in tests/; the seed is the last commit's. Of each system the one that the suite knows, and COUNT
others that are drawn. A line for each tolerance: the error of the group that errs most over the
tolerance, against the same FMUs with a short step (of own parts against the twin, of the oscillator
against its exact solution); the same by the run's own estimate; CPU time, of two runs the lesser;
algorithm and step. The error must be at most twice the tolerance, and 0.02 of it at the least where
no line tells what limits the step; a looser tolerance must not cost more.
"""

import fnmatch
import math
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

from fuzz.campaign import last_commit
from support.foreign.c_housing import c_housing_fmu
from support.foreign.kinds import build_kinds
from support.foreign.oscillator import JOINED, Oscillator
from support.foreign.turning import with_motors

import herringbone as hb
from campaigns.plans import tell
from herringbone.analysis.accuracy.apart import apart
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.result.result import Result

TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6)
MOST, LEAST, DEARER = 2.0, 0.02, 1.2
"""Errors over the tolerance; CPU time over that of the next tolerance, by its own scatter."""
LIMITS = (
    "the longest that is stable",
    "is of no use here",
    "the shortest that is taken",
    "macro steps are as long as",
)
"""Lines that name what keeps the error below what is asked for."""
KINDS = ("oscillator_mass.c", "oscillator_spring.c")
_R_MIN = math.pi / 30.0
_FINEST = {"algorithm": "li:degree=4", "step": 1e-2 / 1200.0, "record_step": 1e-2 / 1200.0}
_FINEST_ONCE = {"algorithm": "li:degree=3", "step": 1e-2 / 4200.0, "record_step": 1e-2 / 4200.0}
"""Of parts that take each step once: third order. Both have many divisors, and all their points, so
that others have points in common with them."""
_INNER = {"gear_mesh.micro_step": 2e-7}


class Case(NamedTuple):
    """A system at its operating point.

    Attributes:
        name: what it is, with what was drawn.
        run: for a tolerance.
        errors: of a run, by group [1].
    """

    name: str
    run: Callable[[float], Result]
    errors: Callable[[Result], Mapping[str, float]]


def of_steps(
    name: str, run: Callable[..., Result], given: str, asked: Mapping[str, object] = _FINEST
) -> Case:
    """Errors are those against a run with short steps; of what foreign parts give, too."""
    finest = cache(lambda: run(**asked, values=_INNER))

    def errors(found: Result) -> Mapping[str, float]:
        return apart(found, finest(), fnmatch.filter(found.signals, given)).groups

    return Case(name, lambda tolerance: run(tolerance=tolerance), errors)


def rig(chance: random.Random | None, folder: Path) -> Case:
    """All parts are of this project."""
    del folder
    speed = chance.uniform(500.0, 3000.0) if chance else 1000.0
    torque = chance.uniform(80.0, 400.0) if chance else 200.0

    def run(tolerance: float, *, reference: bool = False) -> Result:
        return hb.run(
            "test_rig", speed=speed * _R_MIN, torque=torque, t_end=0.02, fmu="in-process",
            tolerance=tolerance, reference=reference,
        )  # fmt: skip

    def errors(found: Result) -> Mapping[str, float]:
        return run(found.info.estimate["asked"], reference=True).error

    return Case(f"rig, {speed:.4g} r/min, {torque:.3g} N m", run, errors)


def housed(chance: random.Random | None, folder: Path) -> Case:
    """The rig with a stranger's housing, whose own steps of 10 ns err little."""
    speed = chance.uniform(500.0, 3000.0) if chance else 1000.0
    torque = chance.uniform(80.0, 400.0) if chance else 200.0
    mass = chance.uniform(15.0, 100.0) if chance else 40.0
    spring = chance.uniform(0.3, 3.0) if chance else 1.0
    saves = chance.random() < 0.7 if chance else True
    defines = ("LONGEST=1e-8", f"MASS={mass!r}", f"SPRING={spring!r}")
    file = c_housing_fmu(folder, (*defines, *["SAVES"] * saves), saves=saves)

    def run(record_step: float = 1e-5, **asked: object) -> Result:
        return hb.run(
            "test_rig", speed=speed * _R_MIN, torque=torque, t_end=0.01, record_step=record_step,
            replace_parts={"modal_housing": file}, **asked,
        )  # fmt: skip

    name = f"rig with a housing of {mass:.3g} kg, springs x {spring:.3g}, "
    name += "saving its state" if saves else "not saving its state"
    name = f"{name}, {speed:.4g} r/min, {torque:.3g} N m"
    return of_steps(name, run, "*modal_housing.*.s_?", _FINEST if saves else _FINEST_ONCE)


def oscillator(chance: random.Random | None, folder: Path) -> Case:
    """The benchmark's two masses."""
    cut = chance.choice(list(JOINED)) if chance else "force and motion"
    damping = 10.0 ** chance.uniform(-3.0, 0.5) if chance else 0.01
    t_end = chance.uniform(1.0, 15.0) if chance else 10.0
    plain = chance.random() < 0.3 if chance else False
    own = Oscillator(build_kinds(folder, *KINDS), cut, damping, plain=plain)

    def run(tolerance: float) -> Result:
        return hb.run(
            own.system, tolerance=tolerance, record_step=1e-2, t_end=t_end, start="rest",
            values=own.values,
        )  # fmt: skip

    name = f"oscillator, {cut}, {damping:.2g} N s/m, {t_end:.3g} s, "
    return Case(name + ("not " * plain) + "saving its states", run, own.group_errors)


def motors(chance: random.Random | None, folder: Path) -> Case:
    """E-motors at both flanges of the gearbox, from steady rotation."""
    rpm = chance.uniform(500.0, 3000.0) if chance else 1000.0
    motor = build_kinds(folder, "e_drive.py") / "EDrive.fmu"
    system, given = with_motors(motor, folder, rpm)

    def run(
        values: Mapping[str, float] = MappingProxyType({}),
        record_step: float = 1e-5,
        **asked: object,
    ) -> Result:
        return hb.run(
            system, record_step=record_step, t_end=0.02, start="rest", values=given | values,
            **asked,
        )  # fmt: skip

    return of_steps(f"e-motors at both ends of the gearbox, {rpm:.4g} r/min", run, "*.tau")


SYSTEMS = {"rig": rig, "housing": housed, "oscillator": oscillator, "motors": motors}


def timed(case: Case, tolerance: float) -> tuple[Result, float]:
    """A run, and its CPU time [s], the lesser of two."""
    spent = []
    for _ in range(2):
        begin = time.process_time()
        found = case.run(tolerance)
        spent.append(time.process_time() - begin)
    return found, min(spent)


def lines(case: Case) -> Iterator[tuple[str, bool]]:
    """A line for each tolerance, and whether it holds."""
    case.run(1e-1)  # what is compiled and found out counts for none
    cheapest = math.inf
    for tolerance in reversed(TOLERANCES):
        found, seconds = timed(case, tolerance)
        errors = case.errors(found)
        group = max(errors, key=errors.__getitem__)
        over = errors[group] / tolerance
        limit = next((limit for limit in LIMITS if any(limit in n for n in found.info.notes)), "")
        told = estimated(found) / tolerance
        known = math.isfinite(told) and over <= MOST and (over >= LEAST or bool(limit))
        holds = known and seconds <= DEARER * cheapest
        cheapest = min(cheapest, seconds)
        step, algorithm = found.info.communication_step, found.info.algorithm
        yield (
            (
                f"   {tolerance:g}: error over tolerance {over:.2g} ({group}), estimated "
                f"{told:.2g}; {seconds:.3g} s; {algorithm}, step {step:.3g} s"
                f"{'; ' * bool(limit) + limit}{'' if holds else '   MISSED'}"
            ),
            holds,
        )


def estimated(found: Result) -> float:
    """Of the run by itself [1]; NaN if it tells none."""
    if found.verification:
        return found.verification.error
    estimate = found.info.estimate
    return math.hypot(estimate["coupling"], estimate["inner_steps"]) if estimate else math.nan


def main(count: int = 0, seed: str | None = None, *names: str) -> int:
    """Print; 0 if every line holds."""
    if unknown := set(names) - set(SYSTEMS):
        tell(f"unknown: {', '.join(sorted(unknown))}; there are: {', '.join(SYSTEMS)}")
        return 2
    seed = last_commit() if seed in {None, "-"} else seed
    tell(f"seed {seed}")
    missed = 0
    for name in names or SYSTEMS:
        for number in range(count + 1):
            chance = random.Random(f"{seed} {name} {number}") if number else None
            with tempfile.TemporaryDirectory() as folder, foreign_fmu_policy(in_process=True):
                case = SYSTEMS[name](chance, Path(folder))
                tell(f"{case.name}:")
                for line, holds in lines(case):
                    tell(line)
                    missed += not holds
    tell(f"{missed} missed")
    return 1 if missed else 0


if __name__ == "__main__":
    _, *given = sys.argv
    sys.exit(main(*map(int, given[:1]), *given[1:]))
