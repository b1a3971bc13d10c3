"""Processes with Python FMUs end: `python -m campaigns.exits COUNT` in the folder `tests`.

Some close their FMUs, some do not; some end by themselves, some by an error, `sys.exit` or a signal
that Python knows; all under faulthandler. A process is bad if its exit code is another one than
asked for, if faulthandler writes anything, or if it does not end.
"""

import os
import random
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from support.foreign.reel import python_reel

_SECONDS, _OFTEN = 300, 50
SCRIPT = """
import faulthandler, signal, sys
from pathlib import Path
faulthandler.enable()
signal.signal(signal.SIGINT, signal.default_int_handler)  # shells let background jobs ignore it
from herringbone.cosim.fmu.instance import new_part
files, close, steps, end = sys.argv[1].split(","), sys.argv[2], int(sys.argv[3]), sys.argv[4]
parts = [new_part(f"part{k}", Path(file)) for k, file in enumerate(files)]
for part in parts:
    part.enter_initialization(0.0, 1.0)
    part.exit_initialization()
for n in range(steps):
    for part in parts:
        part.slave.doStep(1e-3 * n, 1e-3)
if close == "close":
    for part in parts:
        part.close()
if end == "exit":
    sys.exit(7)
if end == "error":
    raise SystemError("wanted")
if end == "interrupt":
    signal.raise_signal(signal.SIGINT)
"""
ENDS = {"": 0, "exit": 7, "error": 1, "interrupt": -2}
"""Exit codes by ends."""


def tried(files: list[Path], chance: random.Random) -> list[tuple[str, ...]]:
    """Arguments of a process at random."""
    chosen = chance.choices(files, k=chance.randint(1, 3))
    close = chance.choice(("close", "leave"))
    end = chance.choice(("", "", "exit", "error", "interrupt"))
    return ",".join(map(str, chosen)), close, str(chance.choice((0, 1, 20))), end


def ended(arguments: tuple[str, ...]) -> tuple[str, str]:
    """How a process ended, and what was wrong with it."""
    _, close, _, end = arguments
    try:
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, *arguments], capture_output=True, text=True,
            check=False, timeout=_SECONDS,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return "bad", f"{arguments}: it does not end"
    said = done.stderr
    fatal = any(word in said for word in ("Fatal", "Segmentation", "Aborted", "Current thread"))
    if done.returncode != ENDS[end] or fatal:
        return "bad", f"{arguments}: exit code {done.returncode}\n{said[-2000:]}"
    return f"{close}, {end or 'by itself'}", ""


def try_exits(
    count: int,
    seed: int,
    workers: int,
    folder: Path,
    tell: Callable[[int], None] = lambda done: None,
) -> tuple[Counter, list[str]]:
    """End so many processes; how they ended, and what was wrong. Told is how many have ended."""
    from herringbone.fmi import build_python_fmus

    chance = random.Random(seed)
    own = build_python_fmus(["drive_motor", "shaft_coupling"])
    files = [python_reel(folder), *own.values()]
    found = []
    with ThreadPoolExecutor(workers) as pool:
        for one in pool.map(ended, [tried(files, chance) for _ in range(count)]):
            found.append(one)
            tell(len(found))
    return Counter(how for how, _ in found), [wrong for _, wrong in found if wrong]


def told(done: int) -> None:
    """A line now and then."""
    if done % _OFTEN == 0:
        sys.stderr.write(f"{done} have ended\n")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as scratch:
        cores = len(os.sched_getaffinity(0))
        counted, bad = try_exits(int(sys.argv[1]), 1, cores, Path(scratch), told)
    sys.stdout.write("\n".join([*(f"{n:5d} {how}" for how, n in counted.items()), *bad, ""]))
    sys.exit(bool(bad))
