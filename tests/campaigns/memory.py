"""Memory of runs by their length: `python -m campaigns.memory SECONDS,... [OPTION ...]`.

Prints the most that a run had in memory, its rows on the disk, and its time.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

_MIB = 1 << 20


def measured(seconds: float, options: list[str]) -> tuple[float, float]:
    """Most memory of a run, and its rows on the disk [MiB]."""
    with tempfile.TemporaryDirectory() as scratch:
        out = Path(scratch, "out")
        words = ["run", "test_rig", f"--t-end={seconds:g}", "-o", str(out), *options]
        process = subprocess.Popen(
            [sys.executable, "-m", "herringbone", *words], stdout=subprocess.DEVNULL
        )
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        assert process.returncode == 0
        most = used.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
        return most / _MIB, (out / "results.npy").stat().st_size / _MIB


if __name__ == "__main__":
    for text in sys.argv[1].split(","):
        started = time.monotonic()
        memory, rows = measured(float(text), sys.argv[2:])
        spent = time.monotonic() - started
        sys.stdout.write(f"{text} s: {memory:.0f} MiB, rows {rows:.0f} MiB, {spent:.0f} s\n")
        sys.stdout.flush()
