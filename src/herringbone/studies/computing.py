"""The chains of a study that are not there yet: what they cost, and computing them."""

from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import replace

from herringbone.studies.keys import Chain
from herringbone.studies.store import StudyFolder
from herringbone.studies.working.chain import Done, Job, read_so_far, run_chain
from herringbone.studies.working.executors import ThisProcess, Working

_TRIED = 2
"""Points of a chain that are computed to tell what the others cost."""
_WORTH = 20
"""Points of a chain from which on it is worth that to try its first ones."""
_EVERY = 0.5
"""Time after which points of chains that are not whole are counted [s]."""
Progress = Callable[[int], None]
"""Called with the number of points that were done since."""


def measured(
    missing: list[Chain],
    job: Callable[[Sequence[int]], Job],
    store: StudyFolder,
    progress: Progress,
) -> tuple[list[Chain], list[Done]]:
    """What points cost, from the second one on: the first one also loads what all need.

    Points of the last chain are tried as well: run-outs may stand there that the first has not.

    Returns:
        What is still missing, and what was measured.
    """
    for _ in range(2):
        numbers = missing[0].numbers
        done = run_chain(job(numbers[:_TRIED]))
        if len(numbers) <= _TRIED:
            store.write(missing[0], done)
            progress(len(numbers))
            missing = missing[1:]
        if not missing:
            break
    known = [done]
    if len(missing) > 1 and len(missing[-1].numbers) >= _WORTH:
        known.append(run_chain(job(missing[-1].numbers[:_TRIED])))
    return missing, known


def compute(
    missing: Sequence[Chain],
    job: Callable[[Sequence[int]], Job],
    store: StudyFolder,
    where: Working,
    progress: Progress,
) -> None:
    """Compute chains; a bounded number of them is under way at a time."""
    waiting: dict[Future[Done], Chain] = {}
    counted: dict[str, int] = {}
    here = isinstance(where.executor, ThisProcess)

    def count(chain: Chain, points: int) -> None:
        progress(points - counted.get(chain.key, 0))
        counted[chain.key] = points

    def begin(chain: Chain) -> Future[Done]:
        work = replace(job(chain.numbers), so_far=str(store.so_far(chain)))
        if not here:
            return where.executor.submit(run_chain, work)
        counted[chain.key] = len(chain.keys)
        return where.executor.submit(run_chain, work, progress)

    left = iter(missing)
    try:
        while True:
            while len(waiting) < where.window and (chain := next(left, None)) is not None:
                waiting[begin(chain)] = chain
            if not waiting:
                return
            ended = wait(waiting, _EVERY, return_when=FIRST_COMPLETED).done
            for future in ended:
                chain = waiting.pop(future)
                store.write(chain, future.result())
                count(chain, len(chain.keys))
            if not ended:
                for chain in waiting.values():
                    if found := read_so_far(store.so_far(chain)):
                        count(chain, len(found.rows))
    except BaseException:
        for future in waiting:
            future.cancel()
        raise
