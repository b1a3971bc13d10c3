"""Many damaged files: `python -m fuzz.campaign COUNT [KIND ...]` in the folder `tests`.

What no reader may do (a traceback, more than ten seconds, the end of the process) is printed, with
the file in `build/fuzz`. Seeds follow from the hash of the last commit.
"""

import faulthandler
import logging
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from collections import Counter
from contextlib import contextmanager
from pathlib import Path

from fuzz.kinds import all_kinds
from fuzz.kinds.kind import Kind, refused
from fuzz.mutate import mutated

LONGEST = 10
"""Seconds that reading a file may take."""
_MEMORY = 6 << 30


class TooLong(BaseException):
    """Reading takes too long; no `except Exception` may hide it."""


@contextmanager
def limited(seconds=LONGEST):
    def ring(*_):
        raise TooLong

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def last_commit() -> str:
    command = ["git", "rev-parse", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()


def try_many(kind: Kind, count: int, seed: str, folder: Path, keep: Path) -> tuple[int, Counter]:
    """How many were refused, and what else happened, by where it did."""
    found: Counter = Counter()
    refusals = 0
    kind.read(kind.content, folder)  # what it takes to compile counts for nobody
    for n in range(count):
        content = mutated(kind.content, random.Random(f"{seed} {kind.name} {n}"))
        (folder / "last").write_bytes(content)
        try:
            with limited():
                refusals += refused(kind, content, folder)
        except (Exception, TooLong) as error:
            frames = traceback.extract_tb(error.__traceback__)
            own = [f for f in frames if "/herringbone/" in f.filename] or frames
            where = f"{Path(own[-1].filename).name}:{own[-1].lineno}"
            label = f"{kind.name}: {type(error).__name__} at {where}: {str(error)[:90]!r}"
            if not found[label]:
                keep.joinpath(f"{kind.name}.{len(found)}").write_bytes(content)
            found[label] += 1
    return refusals, found


def main(count: int, names: list[str]) -> None:
    faulthandler.enable()
    logging.disable()
    warnings.simplefilter("ignore")
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    keep = Path(__file__).resolve().parents[2] / "build" / "fuzz"
    keep.mkdir(parents=True, exist_ok=True)
    kinds = [kind for kind in all_kinds() if not names or kind.name in names]
    total = sum(kind.weight for kind in kinds)
    seed = last_commit()
    shared = Path("/dev/shm")  # files are written a thousand times a second
    with tempfile.TemporaryDirectory(dir=shared if shared.is_dir() else None) as scratch:
        tempfile.tempdir = scratch
        for kind in kinds:
            share = count * kind.weight // total
            started = time.monotonic()
            refusals, found = try_many(kind, share, seed, Path(scratch), keep)
            spent = time.monotonic() - started
            lines = [f"{kind.name:32} {share:8d} {refusals:8d} refused {spent:7.1f} s"]
            lines += [f"    {times:6d} {label}" for label, times in found.most_common()]
            sys.stdout.write("\n".join([*lines, ""]))
            sys.stdout.flush()


if __name__ == "__main__":
    main(int(sys.argv[1]), sys.argv[2:])
