"""How foreign FMUs are run, for all that a script calls."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from herringbone.cosim.cell.policy import Remark, foreign_fmus_housed


@contextmanager
def foreign_fmus(
    *,
    in_process: bool | None = None,
    call_deadline: float | None = None,
    longest_trial: int | None = None,
    most_trial_steps: int | None = None,
) -> Iterator[Sequence[Remark]]:
    """Context in which all functions run foreign FMUs so, `steady` and `sweep` with its workers.

        with hb.foreign_fmus(call_deadline=5.0) as remarks:
            found = hb.steady("car", speed=300.0)
        print(*remarks, sep="; ")

    What a function is given itself holds for that call, and contexts may be nested; None is as
    around. It is that of this thread: threads of the caller enter one of their own.

    Args:
        in_process, call_deadline, longest_trial, most_trial_steps: as in `herringbone.run`; the
            steps of trials are those of all calls together.

    Yields:
        What was found out about FMUs besides results; a run tells its own in its notes.

    Raises:
        ParameterError: the deadline is not positive, or a trial has no step.
    """
    asked = in_process, call_deadline, longest_trial, most_trial_steps
    with foreign_fmus_housed(*asked) as remarks:
        yield remarks
