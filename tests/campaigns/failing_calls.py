"""Calls of the system fail: `python -m campaigns.failing_calls [COUNT [KIND ...]]`.

Runs are tried in forks of a process that has made one, so that a run is what it costs. Of each kind
the first, second ... call of a run fails; if there are more than COUNT calls, so many at random.
A run must end well, with the bits of any other, or in one line; then its rows are the first ones of
a whole run, and the run that goes on, or is made again, has the bits of a whole one.
"""

import ctypes
import errno
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from support.foreign.c_fmu import compiler

import herringbone as hb
from herringbone import plotting
from herringbone.commands.main import main
from herringbone.cosim.checkpoint import checkpoints
from herringbone.cosim.rows import stream

HERE = Path(__file__).resolve().parent
KINDS = {
    "allocation": (1, errno.ENOMEM),
    "open": (2, errno.EMFILE),
    "write": (3, errno.ENOSPC),
    "change": (4, errno.EIO),
}
"""Number in `failing.c`, and the error."""
RUN = ("run", "test_rig", "--fmu=in-process", "--t-end=0.002")
_MOST = 60
_SECONDS = 120


class Runs:
    """Runs in forks of this process.

    Args:
        folder: for their files.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.out = folder, folder / "out"
        self.library = ctypes.CDLL(os.environ["LD_PRELOAD"])
        self.said = folder / "said"
        assert self.run(folder / "whole", here=True) == 0, self.said.read_text()
        self.whole = contents(folder / "whole")

    def run(self, out: Path, *, here: bool = False) -> int:
        """Run, or go on, in this process; exit code."""
        there = (out / "run.json").exists()
        words = ["run", "--resume", str(out)] if there else [*RUN, "-o", str(out)]
        if here:
            return main(words)
        return self.forked(lambda: main(words))

    def forked(self, act) -> int:
        """Exit code of what is done in a fork, or minus the signal that ended it."""
        process = os.fork()
        if process == 0:
            code = 99
            try:
                with self.said.open("w") as file:
                    for descriptor in (1, 2):
                        os.dup2(file.fileno(), descriptor)
                    code = act()
            except BaseException:
                self.library.fail_at(0, 0, 0)
                sys.excepthook(*sys.exc_info())
            finally:
                sys.stderr.flush()
                os._exit(code)
        return os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])

    def failing(self, kind: str, number: int) -> int:
        """Run while the n-th call fails; exit code."""
        what, error = KINDS[kind]

        def act() -> int:
            resource.setrlimit(resource.RLIMIT_CPU, (_SECONDS, _SECONDS))
            words = [*RUN, "-o", str(self.out)]
            self.library.fail_at(what, number, error)
            code = main(words)
            self.folder.joinpath("calls").write_text(str(self.library.counted()))
            self.library.fail_at(0, 0, 0)
            return code

        shutil.rmtree(self.out, ignore_errors=True)
        return self.forked(act)

    def judge(self, code: int) -> str:
        """How the run ended; raises AssertionError if it is wrong."""
        said = self.said.read_text(errors="replace")
        lines = [line for line in said.splitlines() if line.startswith("herringbone: ")]
        assert "Traceback" not in said, said[-1500:]
        if code == 0:
            assert contents(self.out) == self.whole, "other bits, and it says nothing"
            return "no harm"
        assert code < 0 or len(lines) == 1, f"{code}: {said[-1500:]}"
        if (self.out / "run.json").exists():
            rows = hb.load(self.out).data.to_numpy().tobytes()
            assert self.whole["results.npy"][128 : 128 + len(rows)] == rows, "other rows"
        assert self.run(self.out) == 0, self.said.read_text(errors="replace")[-1500:]
        assert contents(self.out) == self.whole, f"after {said!r} it goes on with other bits"
        return "one line" if code > 0 else f"signal {-code}"


def contents(folder: Path) -> dict[str, bytes]:
    """What counts of a results folder."""
    names = ("results.npy", "results.csv", "units.csv")
    return {name: (folder / name).read_bytes() for name in names if (folder / name).exists()}


def sweep(runs: Runs, kind: str, most: int) -> tuple[Counter, list[str]]:
    """Let calls of a kind fail; how runs ended, and what was wrong."""
    found, wrong = Counter(), []
    runs.failing(kind, 0)
    calls = int((runs.folder / "calls").read_text())
    numbers = range(1, calls + 1)
    for number in numbers if calls <= most else sorted(random.Random(1).sample(numbers, most)):
        code = runs.failing(kind, number)
        try:
            found[runs.judge(code)] += 1
        except Exception as error:  # whatever reading the folder may raise
            wrong.append(f"{kind} {number} of {calls}: {type(error).__name__}: {error}")
    return found, wrong


def swept(most: int, kinds: list[str]) -> int:
    """Sweep over some kinds, or all; number of wrong runs."""
    bad = 0
    write_soon()
    with tempfile.TemporaryDirectory() as scratch:
        runs = Runs(Path(scratch))
        for kind in kinds or KINDS:
            started = time.monotonic()
            found, wrong = sweep(runs, kind, most)
            told = [f"{kind:12} {dict(found)}, {time.monotonic() - started:.0f} s"]
            sys.stdout.write("\n".join([*told, *(f"    WRONG {text}" for text in wrong), ""]))
            sys.stdout.flush()
            bad += len(wrong)
    return bad


def write_soon() -> None:
    """Rows and checkpoints are written after every chunk of the loop; pictures are left out."""
    checkpoints.SECONDS = stream.SELDOM = 0.0
    plotting.write_pictures = lambda result, folder: []


def preloaded(folder: Path, most: int, kinds: list[str]) -> "subprocess.CompletedProcess[str]":
    """The sweep in a process that has the library loaded before all others."""
    library = folder / "failing.so"
    command = [*compiler(), "-O2", "-shared", "-fPIC", "-o", str(library), str(HERE / "failing.c")]
    subprocess.run([*command, "-ldl"], check=True)
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    return subprocess.run(
        [sys.executable, "-m", "campaigns.failing_calls", str(most), *kinds], cwd=HERE.parent,
        env={**os.environ, **one_thread, "LD_PRELOAD": str(library)}, text=True, check=False,
        stdout=subprocess.PIPE,
    )  # fmt: skip


if __name__ == "__main__":
    most = int(sys.argv[1]) if len(sys.argv) > 1 else _MOST
    if "LD_PRELOAD" in os.environ:
        sys.exit(swept(most, sys.argv[2:]) > 0)
    with tempfile.TemporaryDirectory() as place:
        done = preloaded(Path(place), most, sys.argv[2:])
    sys.stdout.write(done.stdout)
    sys.exit(done.returncode)
