"""Where a command is killed, and what it must leave; see `kills.py`."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import herringbone as hb
from campaigns.kill_cases import ALL, Case
from herringbone.core import HerringboneError
from herringbone.core.places.paths import CACHE_VARIABLE, cache_root

LONGEST = 1200.0
SWEEP = (
    "from herringbone.core.places.temporary import temporary_folder\nwith temporary_folder(): pass"
)
"""Whoever makes the next temporary folder removes those of dead processes."""
_LEAVE = 60.0
"""Seconds in which cells of a killed master end."""


class Field:
    """Where a case is tried.

    Args:
        case: what is killed.
        folder: for all files.
    """

    def __init__(self, case: Case, folder: Path) -> None:
        self.case, self.folder = case, folder
        self.output, self.scratch = folder / case.output, folder / "scratch"
        self.scratch.mkdir(parents=True)
        self.cache = cache_root()
        if case.cold:
            self.cache = folder / "cache"  # files there are replaced, never changed: links do
        self.renew()
        self.seconds = self.since_rows = 0.0
        started = time.monotonic()
        with self.start(*case.words, "-o", str(self.output)) as process:
            self.wait_for_rows(process)
            rows = time.monotonic()
            assert not process.communicate(timeout=LONGEST)[1] or process.returncode == 0
        self.seconds, self.since_rows = time.monotonic() - started, time.monotonic() - rows
        self.whole = contents(self.output)

    def renew(self) -> None:
        """The cache as it is at the start."""
        if not self.case.cold:
            return
        shutil.rmtree(self.cache, ignore_errors=True)
        if self.case.cold != ALL:
            ignored = shutil.ignore_patterns("mypy", "fuzz", "locks", *self.case.cold)
            shutil.copytree(cache_root(), self.cache, ignore=ignored, copy_function=os.link)

    def start(self, *words: str) -> "subprocess.Popen[str]":
        """The command in a process of its own, with temporary files of its own."""
        return subprocess.Popen(
            [sys.executable, "-m", "herringbone", *words], cwd=self.folder, text=True,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            env={**os.environ, "TMPDIR": str(self.scratch), CACHE_VARIABLE: str(self.cache)},
        )  # fmt: skip

    def ask(self, *words: str, may: tuple[int, ...] = (0,)) -> str:
        """What a command says that is not killed."""
        with self.start(*words) as process:
            _, said = process.communicate(timeout=LONGEST)
        assert process.returncode in may, f"{words}: {process.returncode}\n{said[-2000:]}"
        assert "Traceback" not in said, said[-3000:]
        return said

    def wait_for_rows(self, process: "subprocess.Popen[str]") -> None:
        """Until a run has a folder with rows, or ends."""
        while process.poll() is None and not (self.output / "run.json").exists():
            time.sleep(0.02)

    def kill(self, share: float, *, with_rows: bool = False) -> bool:
        """Kill the command after a share of its time; False if it was through.

        with_rows: of the time from its first rows on.
        """
        with self.start(*self.case.words, "-o", str(self.output)) as process:
            if with_rows:
                self.wait_for_rows(process)
            try:
                process.communicate(
                    timeout=share * (self.since_rows if with_rows else self.seconds)
                )
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.wait()
                self.gone()
            return process.returncode == -signal.SIGKILL

    def gone(self) -> None:
        """All processes end that the killed one has begun."""
        end = time.monotonic() + _LEAVE
        while left := [p for p in others() if str(self.scratch) in environment(p)]:
            assert time.monotonic() < end, f"processes {left} have not ended"
            time.sleep(0.05)
        for folder in self.scratch.glob("herringbone_*"):
            os.utime(folder, (0, 0))  # young ones are not swept: their owners may be locking them

    def clear(self) -> None:
        """Remove what the command has written."""
        if self.output.is_dir():
            shutil.rmtree(self.output)
        self.output.unlink(missing_ok=True)

    def judge(self) -> str:
        """Look at what a kill has left, and go on; in a word how."""
        how = self.judge_run() if self.case.runs else self.judge_files()
        assert contents(self.output) == self.whole, f"{how}: other bits"
        environment = {**os.environ, "TMPDIR": str(self.scratch)}
        subprocess.run([sys.executable, "-c", SWEEP], check=True, env=environment)
        left = [f.name for f in self.scratch.glob("herringbone_*")]
        assert not left, f"{how}: {left} is left"
        return how

    def judge_files(self) -> str:
        """Files are absent or whole."""
        found = contents(self.output)
        wrong = [name for name in found if found[name] != self.whole.get(name)]
        assert not wrong, f"{wrong} differ"
        self.ask(*self.case.words, "-o", str(self.output))
        return f"{len(found)} of {len(self.whole)} files"

    def judge_run(self) -> str:
        """Rows are absent, or those of the run, up to some time."""
        try:
            found = hb.load(self.output)
        except HerringboneError as error:
            assert not (self.output / "run.json").exists(), str(error)
            self.ask(*self.case.words, "-o", str(self.output))
            return "absent"
        table = self.output / "results.csv"
        assert not table.exists() or table.read_bytes() == self.whole["results.csv"]
        rows = found.data.to_numpy()[:, : len(found.data.columns)].tobytes()
        assert self.whole["results.npy"][128 : 128 + len(rows)] == rows, "other rows"
        self.ask("run", "--resume", str(self.output))
        return "resumed"


def contents(place: Path) -> dict[str, bytes]:
    """What counts of a file or folder: rows of runs, whole files of other commands."""
    if (place / "run.json").exists():
        return {name: (place / name).read_bytes() for name in ("results.npy", "results.csv")}
    if place.is_dir():
        files = (file for file in place.iterdir() if not file.name.startswith("."))
        return {file.name: file.read_bytes() for file in files}
    return {place.name: place.read_bytes()} if place.exists() else {}


def others() -> list[Path]:
    """All processes but this one."""
    return [p for p in Path("/proc").glob("[0-9]*") if p.name != str(os.getpid())]


def environment(process: Path) -> str:
    """Of a process; "" if it is gone."""
    try:
        return (process / "environ").read_text(errors="replace")
    except OSError:
        return ""
