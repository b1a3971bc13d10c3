"""Other masters on the same .ssp file, each in a process of its own: see `master_process`."""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.cosim.ssp.write import PARAMETER_SET

PACKAGES = {"ecos": "ecospy", "libcosim": "libcosimpy"}
"""Python package of each master."""
_SCRIPT = Path(__file__).with_name("master_process.py")


def environment() -> dict[str, str]:
    """Environment for these masters: the wheel of tbb, on which ecos depends, is found."""
    libraries = f"{Path(sys.prefix) / 'lib'}{os.pathsep}{os.environ.get('LD_LIBRARY_PATH', '')}"
    return {**os.environ, "LD_LIBRARY_PATH": libraries}


def macro_step(
    master: str, file: Path, step: float, count: int, names: Sequence[str] = ()
) -> float | None:
    """Time of a macro step [s] in another master; None if its package is not installed.

    Args:
        master: of `PACKAGES`.
        file: .ssp file.
        step: macro step [s].
        count: macro steps to measure.
        names: outputs to record, `instance.variable`.

    Raises:
        HerringboneError: the master fails.
    """
    if importlib.util.find_spec(PACKAGES[master]) is None:
        return None
    with tempfile.TemporaryDirectory() as scratch:
        request, csv = Path(scratch) / "request.json", str(Path(scratch) / "record.csv")
        wanted = {"names": list(names), "parameter_set": PARAMETER_SET, "csv": csv}
        request.write_text(json.dumps(wanted), encoding="utf-8")
        done = subprocess.run(
            [sys.executable, _SCRIPT, master, file, repr(step), str(count), request],
            env=environment(),
            capture_output=True,
            text=True,
            check=False,
        )
    lines = done.stdout.split()
    if done.returncode or not lines:
        raise HerringboneError(
            f"{master} fails: {(done.stderr.splitlines() or ['no message'])[-1]}"
        )
    return float(lines[-1])
