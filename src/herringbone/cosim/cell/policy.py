"""Which FMUs run in cells, and what came of those that did."""

import os
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from herringbone.core import ParameterError
from herringbone.core.wording import option
from herringbone.cosim.cell.system_calls import FUTEX

if TYPE_CHECKING:
    from herringbone.cosim.cell.process import Cell

T = TypeVar("T")
DEADLINE = 60.0
"""Longest time that a call of an FMU takes, unless something else is asked for [s]."""
_SPIN = 20e-6


@dataclass(frozen=True)
class Remark:
    """What a cell found out about an FMU, besides its results.

    Attributes:
        part: name of the instance.
        text: what, to be read after the name.
        crashed: it did not survive its end.
    """

    part: str
    text: str
    crashed: bool = False

    def __str__(self) -> str:
        return f"{self.part} {self.text}"


@dataclass(frozen=True)
class Policy:
    """Where foreign FMUs run: each in a cell, or in this process.

    Attributes:
        in_process: in this process, as those that were built here.
        deadline: longest time that a call of an FMU in a cell takes [s].
        remarks: what was found out.
        idle: cells by their FMU that may be used again; None: each is used once.
        longest_trial: steps that a trial may have in the test of a role; None: any number.
        most_trial_steps: that all trials of a part may have together; None: any number.
        taken: steps of trials, by part.
        lost: trials that a crash or a deadline ended, by part; another time they may do otherwise,
            so that nothing that was found with them is kept.
    """

    in_process: bool = False
    deadline: float = DEADLINE
    longest_trial: int | None = None
    most_trial_steps: int | None = None
    taken: Counter[str] = field(default_factory=Counter)
    lost: Counter[str] = field(default_factory=Counter)
    remarks: list[Remark] = field(default_factory=list)
    idle: dict[str, list["Cell"]] | None = None

    @property
    def trials_ended(self) -> tuple[str, ...]:
        """Parts of which no further trials are made."""
        most = self.most_trial_steps
        return tuple(name for name, n in self.taken.items() if most is not None and n >= most)

    def note_lost(self, part: str, why: str) -> None:
        """A trial of a part was lost: that is told, and counts."""
        self.lost[part] += 1
        remark = Remark(part, f"lost a trial ({why}); what follows from it is not kept")
        if remark not in self.remarks:
            self.remarks.append(remark)


_policy: ContextVar[Policy | None] = ContextVar("cell_policy", default=None)


def policy() -> Policy:
    """The policy of this context."""
    return _policy.get() or Policy()


@contextmanager
def foreign_fmu_policy(
    *,
    in_process: bool | None = None,
    deadline: float | None = None,
    longest_trial: int | None = None,
    most_trial_steps: int | None = None,
) -> Iterator[Policy]:
    """Context in which foreign FMUs run so.

    Args:
        in_process: in this process; None: as around this context, or else in cells.
        deadline: longest time of a call [s]; if not given as around this context, or `DEADLINE`.
        longest_trial: steps of a trial in the test of a role; None: as around this context, or any.
        most_trial_steps: of all trials of a part together; likewise.

    Raises:
        ParameterError: the deadline is not positive, or a trial has no step.
    """
    if deadline is not None and not deadline > 0.0:
        raise ParameterError(f"call_deadline = {deadline:g} s: it must be positive")
    if longest_trial is not None and longest_trial < 1:
        raise ParameterError(f"{option('longest_trial', longest_trial)}: it must be 1 at least")
    if most_trial_steps is not None and most_trial_steps < 1:
        given = option("most_trial_steps", most_trial_steps)
        raise ParameterError(f"{given}: it must be 1 at least")
    outer = policy()
    found = Policy(
        outer.in_process if in_process is None else in_process,
        outer.deadline if deadline is None else deadline,
        outer.longest_trial if longest_trial is None else longest_trial,
        outer.most_trial_steps if most_trial_steps is None else most_trial_steps,
        outer.taken if most_trial_steps is None else Counter(),
        idle={},
    )
    token = _policy.set(found)
    try:
        yield found
    finally:
        _policy.reset(token)
        for cell in (cell for cells in (found.idle or {}).values() for cell in cells):
            cell.close()


def elsewhere(function: Callable[..., T]) -> Callable[..., T]:
    """A function, of a module, that does the same in another process, under the policy of here."""
    here = policy()
    asked = {
        "in_process": here.in_process,
        "deadline": here.deadline,
        "longest_trial": here.longest_trial,
        "most_trial_steps": here.most_trial_steps,
    }
    return partial(_under, asked, function)


def _under(asked: dict[str, Any], function: Callable[..., T], *arguments: object) -> T:
    with foreign_fmu_policy(**asked):
        return function(*arguments)


@contextmanager
def foreign_fmus_housed(
    in_process: bool | None,
    deadline: float | None,
    longest_trial: int | None,
    most_trial_steps: int | None = None,
) -> Iterator[Sequence[Remark]]:
    """As `foreign_fmu_policy`, with remarks that are to be told; a context around tells its own.

    Args:
        in_process, deadline, longest_trial, most_trial_steps: see `foreign_fmu_policy`.

    Raises:
        ParameterError: the deadline is not positive, or a trial has no step.
    """
    asked = in_process, deadline, longest_trial, most_trial_steps
    if _policy.get() is not None and asked == (None,) * 4:
        yield ()
        return
    with foreign_fmu_policy(
        in_process=in_process,
        deadline=deadline,
        longest_trial=longest_trial,
        most_trial_steps=most_trial_steps,
    ) as found:
        yield found.remarks


@contextmanager
def remarks_of_cells() -> Iterator[list[Remark]]:
    """Context with the policy as it is, and the remarks on the FMUs that are opened in it."""
    found = replace(policy(), remarks=[])
    token = _policy.set(found)
    try:
        yield found.remarks
    finally:
        _policy.reset(token)


def cells_work() -> bool:
    """True where there are cells: on Linux, on processors whose system calls are known."""
    return sys.platform == "linux" and FUTEX > 0 and hasattr(os, "pidfd_open")


def spin_time(cells: int) -> float:
    """Time to spin [s], with so many cells of this process; 0 where cores are scarce."""
    if sys.platform != "linux":
        return 0.0
    return _SPIN if 1 + cells <= len(os.sched_getaffinity(0)) else 0.0
