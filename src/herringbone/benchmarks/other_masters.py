"""Other masters on the same .ssp file: `python -m herringbone.benchmarks.other_masters`.

In a process of its own, because these masters write to the terminal and may end the process.
Arguments: master, file, step [s], number of macro steps. Prints the time of one macro step [s];
all outputs that the file shows are observed.
"""

import importlib.util
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.cosim.ssp_write import PARAMETER_SET

PACKAGES = {"ecos": "ecospy", "libcosim": "libcosimpy"}
"""Python package of each master."""


def environment() -> dict[str, str]:
    """Environment for these masters: the wheel of tbb, on which ecos depends, is found."""
    libraries = f"{Path(sys.prefix) / 'lib'}{os.pathsep}{os.environ.get('LD_LIBRARY_PATH', '')}"
    return {**os.environ, "LD_LIBRARY_PATH": libraries}


def macro_step(master: str, file: Path, step: float, count: int) -> float | None:
    """Time of a macro step [s] in another master; None if its package is not installed.

    Raises:
        HerringboneError: the master fails.
    """
    if importlib.util.find_spec(PACKAGES[master]) is None:
        return None
    done = subprocess.run(
        [sys.executable, "-m", __name__, master, str(file), repr(step), str(count)],
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


def _libcosim(file: Path, step: float, count: int) -> float:
    from libcosimpy.CosimExecution import CosimExecution  # noqa: PLC0415
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level  # noqa: PLC0415
    from libcosimpy.CosimObserver import CosimObserver  # noqa: PLC0415

    del step  # it stands in the file
    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_ssp_file(ssp_path=str(file))
    execution.add_observer(observer=CosimObserver.create_last_value())
    execution.step(step_count=1)
    begin = time.perf_counter()
    execution.step(step_count=count)
    return (time.perf_counter() - begin) / count


def _ecos(file: Path, step: float, count: int) -> float:
    from ecospy import EcosSimulation  # noqa: PLC0415

    with EcosSimulation(ssp_path=str(file), step_size=step) as simulation:
        simulation.init(parameter_set=PARAMETER_SET)
        simulation.step(1)
        begin = time.perf_counter()
        simulation.step(count)
        seconds = time.perf_counter() - begin
        simulation.terminate()
    return seconds / count


_MASTERS: dict[str, Callable[[Path, float, int], float]] = {"libcosim": _libcosim, "ecos": _ecos}

if __name__ == "__main__":
    name, path, size, number = sys.argv[1:]
    sys.stdout.write(f"\n{_MASTERS[name](Path(path), float(size), int(number))!r}\n")
