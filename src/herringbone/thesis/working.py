"""Entries are computed: those that are not there yet, each in one call, in several processes."""

from collections.abc import Iterator, Sequence
from concurrent.futures import Future, as_completed
from dataclasses import dataclass
from time import perf_counter

from herringbone.core import HerringboneError, one_line
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.core.process.telling import Tell
from herringbone.studies.working.executors import Workers, working
from herringbone.thesis.entry import Entry, Outcome
from herringbone.thesis.registry import ENTRIES
from herringbone.thesis.store import as_kept, read_outcome, write_outcome


@dataclass(frozen=True)
class Done:
    """An entry that was computed, or kept, or that failed.

    Attributes:
        entry: that it is.
        outcome: None if it failed.
        error: why it failed; else "".
        seconds: that it took; 0 if it was kept.
    """

    entry: Entry
    outcome: Outcome | None
    error: str = ""
    seconds: float = 0.0


def computed(entries: Sequence[Entry], workers: Workers, told: Tell) -> list[Done]:
    """Entries in their order; what is kept is not computed again.

    Args:
        entries: of the registry.
        workers: where.
        told: called with a line on each.
    """
    there = {e.name: Done(e, found) for e in entries if (found := read_outcome(e)) is not None}
    missing = sorted((e for e in entries if e.name not in there), key=lambda e: -e.seconds)
    if there:
        told(f"{len(there)} of {len(entries)} entries are kept from before")
    for count, done in enumerate(_found(missing, workers, told), 1):
        there[done.entry.name] = done
        how = f"failed: {done.error}" if done.error else "done"
        told(f"{count}/{len(missing)} {done.entry.name}: {how}, {done.seconds:.1f} s")
    return [there[entry.name] for entry in entries]


def _found(missing: Sequence[Entry], workers: Workers, told: Tell) -> Iterator[Done]:
    """Entries as they come."""
    if not missing:
        return
    cost = sum(entry.seconds for entry in missing)
    with working(workers, cost, len(missing)) as where:
        told(f"{len(missing)} entries to compute {where.told}, about {cost:.0f} s of CPU time")
        futures: dict[Future, Entry] = {}
        for entry in missing:
            futures[where.executor.submit(compute_entry, entry.name)] = entry
        for future in as_completed(futures):
            yield _of(futures[future], future)


def _of(entry: Entry, future: Future) -> Done:
    """What came out, also where a process died."""
    try:
        outcome, error, seconds = future.result()
    except HerringboneError as died:
        return Done(entry, None, str(died))
    return Done(entry, outcome, error, seconds)


def compute_entry(name: str) -> tuple[Outcome | None, str, float]:
    """Compute an entry and keep what comes out; returns it, or why there is none, and seconds."""
    entry, start = ENTRIES[name], perf_counter()
    try:
        with one_blas_thread():
            outcome = as_kept(entry.compute())
        write_outcome(entry, outcome)
    except Exception as error:  # whatever it is: the other entries make a report
        why = str(error) if isinstance(error, HerringboneError) else repr(error)
        return None, one_line(why), perf_counter() - start
    return outcome, "", perf_counter() - start
