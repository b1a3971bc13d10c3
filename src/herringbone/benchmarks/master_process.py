"""Run an .ssp file in another master: `python master_process.py MASTER FILE STEP COUNT REQUEST`.

Run as a file, in a process that holds this master and nothing else: they write to the terminal, may
end the process, and let threads wait for each other, which other libraries' busy threads speed up.
REQUEST is a JSON file: names of the outputs to record, `instance.variable`, or none; for ecos the
parameter set and the CSV file to write. Prints the time of one macro step [s].
"""

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any


def _timed(step: Callable[[int], object], count: int) -> float:
    step(1)
    begin = time.perf_counter()
    step(count)
    return (time.perf_counter() - begin) / count


def _libcosim(file: str, step: float, count: int, request: dict[str, Any]) -> float:
    """Records time series in memory."""
    from libcosimpy.CosimEnums import CosimVariableType  # noqa: PLC0415
    from libcosimpy.CosimExecution import CosimExecution  # noqa: PLC0415
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level  # noqa: PLC0415
    from libcosimpy.CosimObserver import CosimObserver  # noqa: PLC0415

    del step  # it stands in the file
    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_ssp_file(ssp_path=file)
    observer = CosimObserver.create_time_series()
    execution.add_observer(observer=observer)
    names = set(request["names"])
    for slave in execution.slave_infos():
        for variable in execution.slave_variables(slave.index):
            name = f"{slave.name.decode()}.{variable.name.decode()}"
            if name in names:
                names.remove(name)
                observer.start_time_series(slave.index, variable.reference, CosimVariableType.REAL)
    if names:
        raise ValueError(f"there is no {min(names)}")
    return _timed(lambda n: execution.step(step_count=n), count)


def _ecos(file: str, step: float, count: int, request: dict[str, Any]) -> float:
    """Records to a CSV file, the only recorder it has."""
    from ecospy import EcosSimulation  # noqa: PLC0415

    with EcosSimulation(ssp_path=file, step_size=step) as simulation:
        if names := [name.replace(".", "::", 1) for name in request["names"]]:
            simulation.add_csv_writer(request["csv"], identifiers=names)
        simulation.init(parameter_set=request["parameter_set"])
        seconds = _timed(simulation.step, count)
        simulation.terminate()
    return seconds


_MASTERS = {"libcosim": _libcosim, "ecos": _ecos}

if __name__ == "__main__":
    master, file, size, number, request_file = sys.argv[1:]
    wanted = json.loads(Path(request_file).read_text(encoding="utf-8"))
    seconds = _MASTERS[master](file, float(size), int(number), wanted)
    sys.stdout.write(f"\n{seconds!r}\n")
