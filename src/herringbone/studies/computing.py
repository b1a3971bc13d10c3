"""The chains of a study that are not there yet: what they cost, and computing them."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain as joined
from itertools import islice

from herringbone.cosim.cell.policy import elsewhere
from herringbone.studies.keys import Chain
from herringbone.studies.store import StudyFolder
from herringbone.studies.working.chain import Done, Job, read_so_far, run_chain, run_chains
from herringbone.studies.working.executors import ThisProcess, Working

_TRIED = 2
"""Points of a chain that are computed to tell what the others cost."""
_WORTH = 20
"""Points of a chain from which on it is worth that to try its first ones."""
_EVERY = 0.5
"""Time after which points of chains that are not whole are counted [s]."""
Progress = Callable[[int], None]
"""Called with the number of points that were done since."""


@contextmanager
def points_told(progress: bool | Progress, points: int) -> Iterator[Progress]:
    """What a study calls inside: a bar of its points for True; nothing for False.

    Args:
        progress: of the caller.
        points: of the study.
    """
    if not isinstance(progress, bool):
        yield progress
        return
    from tqdm import tqdm  # noqa: PLC0415 (many callers show none)

    tqdm.monitor_interval = 0  # a thread, and what has threads is not forked
    with tqdm(total=points, unit=" points", disable=not progress) as bar:
        yield bar.update


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
    """Compute chains, in pieces of some; a bounded number of pieces is under way at a time."""
    waiting: dict[Future[list[Done]], list[Chain]] = {}
    counted: dict[str, int] = {}
    here = isinstance(where.executor, ThisProcess)

    def count(chain: Chain, points: int) -> None:
        progress(points - counted.get(chain.key, 0))
        counted[chain.key] = points

    def begin(chains: Sequence[Chain]) -> Future[list[Done]]:
        jobs = [replace(job(c.numbers), so_far=str(store.so_far(c))) for c in chains]
        if not here:
            return where.executor.submit(elsewhere(run_chains), jobs)
        counted.update((chain.key, len(chain.keys)) for chain in chains)
        return where.executor.submit(run_chains, jobs, progress)

    left = iter(missing)
    try:
        while True:
            while len(waiting) < where.window and (piece := list(islice(left, where.piece))):
                waiting[begin(piece)] = piece
            if not waiting:
                return
            ended = wait(waiting, _EVERY, return_when=FIRST_COMPLETED).done
            for future in ended:
                for chain, done in zip(waiting.pop(future), future.result(), strict=True):
                    store.write(chain, done)
                    count(chain, len(chain.keys))
            if not ended:
                for chain in joined.from_iterable(waiting.values()):
                    if found := read_so_far(store.so_far(chain)):
                        count(chain, len(found.rows))
    except BaseException:
        for future in waiting:
            future.cancel()
        raise
