"""Sweeps on many cores, killed, and long: `python -m campaigns.sweeps efficiency|kills|memory`.

efficiency [POINTS [T_END]]: transient points in this process, in two processes, and on a local Dask
cluster as docs/sweeps.md has it, if that is installed, whose workers are started anew, or forked;
the same bits, and serial CPU time over that of all processes. The share of wall time is that of an
idle machine only.
kills [COUNT [SEED]]: kill -9 of a worker or of the parent at random moments, then the same command
again: the same table, bit for bit.
memory [POINTS]: a cheap study of so many points; memory of the process over its course.
"""

import json
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from ctypes import CDLL
from importlib.util import find_spec
from pathlib import Path

_RUN = """
import json, sys, time
from pathlib import Path
import numpy as np
import herringbone as hb
from herringbone.studies.evaluators.transient import Transient

def main():
    how, folder, points, t_end = sys.argv[1:]
    folder, points, t_end = Path(folder), int(points), float(t_end)
    speeds = np.linspace(80.0, 300.0, points // 2).tolist()
    wanted = dict(speed=speeds, torque=[100.0, 200.0], t_end=t_end, evaluator=Transient(),
                  output=folder)
    begin = time.perf_counter()
    if how.startswith("dask"):
        import dask
        from dask.distributed import Client, LocalCluster
        dask.config.set({  # see docs/sweeps.md
            "distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "1s",
            "distributed.worker.multiprocessing-method": how.partition("-")[2] or "spawn",
        })
        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            with Client(cluster) as client:
                hb.sweep("test_rig", executor=client.get_executor(), **wanted)
    else:
        hb.sweep("test_rig", workers=int(how), **wanted)
    print(json.dumps(time.perf_counter() - begin))

if __name__ == "__main__":
    main()
"""
_KILLED = """
import sys
from pathlib import Path
from support.studies import Cheap
import herringbone as hb

hb.sweep("gearbox", speed=[10.0 * k for k in range(1, 41)], torque=[1.0 * k for k in range(1, 13)],
         workers=2, evaluator=Cheap(longest=8, seconds=0.004), output=Path(sys.argv[1]))
"""
_SUBREAPER = 36
"""PR_SET_CHILD_SUBREAPER of Linux."""
_LONG = """
import resource, sys
from pathlib import Path
from support.studies import Cheap
import herringbone as hb

def told(done, seen=[0, 0]):
    seen[0] += done
    if seen[0] >= seen[1]:
        seen[1] += int(sys.argv[2]) // 10
        size = int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()
        print(f"{seen[0]:7d} points {size / 2**20:8.1f} MiB", flush=True)

points = int(sys.argv[2])
hb.sweep("gearbox", speed=[0.5 * k for k in range(1, points + 1)], workers=int(sys.argv[3]),
         evaluator=Cheap(longest=1), output=Path(sys.argv[1]), progress=told)
"""


def _started(script: str, *arguments: object) -> subprocess.Popen:
    path = os.pathsep.join([str(Path.cwd()), *filter(None, sys.path)])
    return subprocess.Popen(
        [sys.executable, "-c", script, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def efficiency(folder: Path, points: int = 400, t_end: float = 0.2) -> int:
    """See above; number of tables with other bits."""
    script = folder / "run.py"
    script.write_text(_RUN)
    found = {}
    ways = ("1", "2", "dask", "dask-fork") if find_spec("dask") else ("1", "2")
    CDLL(None).prctl(_SUBREAPER, 1, 0, 0, 0)  # processes whose parents end are waited for here
    for how in ways:
        place, before = folder / how, _cpu_of_children()
        done = subprocess.run(
            [sys.executable, script, how, place, str(points), str(t_end)],
            capture_output=True,
            text=True,
            check=True,
        )
        with suppress(ChildProcessError):
            while True:
                os.wait()
        wall, cpu = json.loads(done.stdout.splitlines()[-1]), _cpu_of_children() - before
        found[how] = (place / "table.csv").read_bytes(), wall, cpu
        same = found[how][0] == found["1"][0]
        line = f"{how:9} {wall:8.1f} s wall {cpu:8.1f} s CPU, efficiency "
        line += f"{found['1'][2] / cpu:.3f} of CPU, {found['1'][1] / (2.0 * wall):.3f} of wall"
        sys.stdout.write(f"{line}; {'same bits' if same else 'OTHER BITS'}\n")
        sys.stdout.flush()
    return sum(table != found["1"][0] for table, _, _ in found.values())


def _cpu_of_children() -> float:
    """CPU time of all processes that have ended [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def kills(folder: Path, count: int = 50, seed: int = 1) -> int:
    """See above; number of tables with other bits."""
    chance, bad = random.Random(seed), 0
    begun = time.monotonic()
    assert _started(_KILLED, folder / "whole").wait() == 0
    length = time.monotonic() - begun
    whole = (folder / "whole" / "table.csv").read_bytes()
    victims = {"parent": 0, "worker": 0, "was through": 0}
    for number in range(count):
        place = folder / str(number)
        process = _started(_KILLED, place)
        time.sleep(chance.uniform(0.0, length))
        victim = chance.choice(["parent", "worker"])
        killed = _workers(process.pid) if victim == "worker" else [process.pid]
        if process.poll() is not None:
            victim = "was through"
        for pid in killed[: chance.randint(1, 2)]:
            with suppress(ProcessLookupError):  # it has ended since
                os.kill(pid, signal.SIGKILL)
        victims[victim] += 1
        process.wait()
        assert _started(_KILLED, place).wait() == 0
        bad += (place / "table.csv").read_bytes() != whole
    sys.stdout.write(f"{victims}: {bad} tables with other bits\n")
    return bad


def _workers(parent: int) -> list[int]:
    """Processes that a process has started."""
    try:
        tasks = Path(f"/proc/{parent}/task").iterdir()
        return [int(pid) for task in tasks for pid in (task / "children").read_text().split()]
    except OSError:  # it has ended
        return []


def memory(folder: Path, points: int = 10_000, workers: int = 1) -> int:
    """See above."""
    process = _started(_LONG, folder, points, workers)
    assert process.stdout
    for line in process.stdout:
        sys.stdout.write(line)
        sys.stdout.flush()
    return process.wait()


if __name__ == "__main__":
    known = {"efficiency": efficiency, "kills": kills, "memory": memory}
    numbers = [float(text) if "." in text else int(text) for text in sys.argv[2:]]
    with tempfile.TemporaryDirectory() as scratch:
        sys.exit(known[sys.argv[1]](Path(scratch), *numbers))
