"""A study is computed once, in chains that survive whatever is killed."""

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from support.studies import Cheap

import herringbone as hb
from herringbone.commands.main import main
from herringbone.core import HerringboneError, ParameterError, ResourceError
from herringbone.core.places.paths import module_path
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.studies.expected import longest_period
from herringbone.studies.working import processes
from herringbone.studies.working.chain import Done, Row
from herringbone.studies.working.processes import WorkerProcesses

SPEEDS = [100.0 * k for k in range(1, 9)]
TORQUES = [1.0, 2.0, 3.0]


def swept(folder: Path | None = None, **options) -> hb.Sweep:
    wanted = {"speed": SPEEDS, "torque": TORQUES, "workers": 1, "evaluator": Cheap(), **options}
    return hb.sweep("gearbox", output=folder, **wanted)


@pytest.fixture(scope="module")
def serial():
    return swept().table


def test_chains_follow_from_the_study(serial):
    x = serial["x"].to_numpy().reshape(3, 8)
    assert np.array_equal(x[0], x[1])  # torque does nothing; each speed line begins anew
    alone = swept(evaluator=Cheap(longest=1)).table["x"]
    assert alone[0] == serial["x"][0]
    assert alone[7] != serial["x"][7]  # from its neighbour it comes elsewhere


def test_workers_do_not_change_a_bit_even_if_one_dies(tmp_path, serial):
    swept(tmp_path / "one")
    evaluator = Cheap(deadly=500.0, mark=str(tmp_path / "mark"))
    assert swept(tmp_path / "two", workers=2, evaluator=evaluator).table.equals(serial)
    assert (tmp_path / "mark").exists()
    with ThreadPoolExecutor(2) as executor:
        swept(tmp_path / "threads", executor=executor)
    one = (tmp_path / "one" / "table.csv").read_bytes()
    for other in ("two", "threads"):
        assert (tmp_path / other / "table.csv").read_bytes() == one


class Counting(ThreadPoolExecutor):
    """Keeps how many chains come at once."""

    def __init__(self):
        super().__init__(2)
        self.pieces = []

    def submit(self, fn, /, *args):
        self.pieces.append(len(args[0]))
        return super().submit(fn, *args)


def test_an_executor_takes_cheap_chains_in_pieces(tmp_path):
    """96, of which two are measured before: 94 // 32 at once."""
    asked = {"speed": [10.0 * k for k in range(1, 33)], "evaluator": Cheap(longest=1)}
    with Counting() as executor:
        found = swept(executor=executor, **asked)
    assert found.table.equals(swept(**asked).table)
    assert set(executor.pieces[:-1]) == {2}
    assert sum(executor.pieces) == 94


def test_only_what_is_missing_is_computed(tmp_path):
    log = tmp_path / "log"
    first = swept(tmp_path / "study", evaluator=Cheap(log=str(log)))
    done = log.read_text()
    file = next((tmp_path / "study" / "chains").iterdir())
    file.write_text(file.read_text().replace("completed", "compleTed"))
    second = swept(tmp_path / "study", evaluator=Cheap(log=str(log)))
    assert second.table.equals(first.table)
    again = log.read_text().removeprefix(done).split()
    assert len(again) == 8  # a damaged chain
    with pytest.raises(HerringboneError, match="another study"):
        swept(tmp_path / "study", torque=[1.0], evaluator=Cheap(log=str(log)))
    study = tmp_path / "study" / "study.json"
    content = json.loads(study.read_text())
    content["settings"]["versions"] = "of before"
    study.write_text(json.dumps(content))
    with pytest.raises(HerringboneError, match="this study as another version of the package"):
        swept(tmp_path / "study", evaluator=Cheap(log=str(log)))
    before = log.read_text()
    swept(tmp_path / "study", torque=[1.0], evaluator=Cheap(log=str(log)), overwrite=True)
    assert log.read_text() == before  # the same chain


def test_no_parquet_table_of_another_study_stays(tmp_path):
    """Not where the new study writes none."""
    pytest.importorskip("pyarrow")
    swept(tmp_path, parquet=True)
    assert len(pd.read_parquet(tmp_path / "table.parquet")) == 24
    swept(tmp_path, torque=[1.0], overwrite=True)
    assert not (tmp_path / "table.parquet").exists()
    assert len(pd.read_csv(tmp_path / "table.csv")) == 8


def test_a_failed_point_is_a_row():
    table = swept(torque=[1.0], evaluator=Cheap(refused=300.0)).table
    assert table["outcome"].tolist() == ["completed"] * 2 + ["failed"] + ["completed"] * 5
    assert table["message"][2] == "300 is refused"
    assert np.isnan(table["x"][2])
    assert np.isfinite(table["x"][3])


def test_a_point_that_stands_alone_and_failed_is_tried_again(tmp_path):
    """A part may have died for want of memory; what a chain of several has is not lost for that."""
    for longest, tried in ((1, {"300.0"}), (None, set())):
        log, folder = tmp_path / f"log-{longest}", tmp_path / f"study-{longest}"
        refusing = Cheap(longest=longest, refused=300.0, log=str(log))
        first = swept(folder, torque=[1.0], evaluator=refusing).table
        done = log.read_text()
        again = swept(folder, torque=[1.0], evaluator=refusing).table
        assert again.equals(first)
        assert set(log.read_text().removeprefix(done).split()) == tried


def test_a_chain_that_kills_all_workers_is_said(monkeypatch):
    monkeypatch.setattr(processes, "_ATTEMPTS", 1)
    with pytest.raises(HerringboneError, match="died of the same chain"):
        swept(workers=2, evaluator=Cheap(deadly=500.0))


SCRIPT = """
import sys
from pathlib import Path
from support.studies import Cheap
import herringbone as hb
hb.sweep("gearbox", speed=[100.0 * k for k in range(1, 9)], torque=[1.0, 2.0, 3.0], workers=2,
         evaluator=Cheap(seconds=0.05), output=Path(sys.argv[1]))
"""


def test_a_killed_parent_leaves_chains_that_are_right(tmp_path, serial):
    environment = {**os.environ, "PYTHONPATH": module_path()}
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(tmp_path)], env=environment, start_new_session=True
    )
    while not list(tmp_path.glob("chains/*.json")):
        assert process.poll() is None
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert not (tmp_path / "table.csv").exists()
    with pytest.raises(ResourceError, match=r"holds a sweep, not a run: herringbone.read_table"):
        hb.load(tmp_path)
    with pytest.raises(ResourceError, match=r"has no table.csv: it holds no sweep, or one that"):
        hb.read_table(tmp_path)
    found = swept(tmp_path, evaluator=Cheap(seconds=0.05))
    assert found.table.equals(serial)


class Twofold(Exception):
    """Cannot be made again from its arguments alone, as some of libraries."""

    def __init__(self, what, where):
        super().__init__(f"{what} {where}")


def test_places_of_modules_that_are_gone_are_left_out(monkeypatch, tmp_path):
    """A variable of the environment has at most 128 kB, and each Python FMU leaves a folder."""
    gone = [str(tmp_path / f"gone_{number}") for number in range(2000)]
    monkeypatch.setattr(sys, "path", [*sys.path, *gone])
    with WorkerProcesses(1) as executor:
        assert executor.submit(abs, -2).result(60.0) == 2


def raising():
    raise Twofold("lost", "there")


def test_what_a_process_sends_is_told_though_it_cannot_be_read():
    """Nobody would be there to answer otherwise, and a study would wait for ever."""
    with WorkerProcesses(1) as executor:
        first, then = executor.submit(raising), executor.submit(abs, -2)
        with pytest.raises(HerringboneError, match=r"a process of the study: .*missing 1 required"):
            first.result(60.0)
        assert then.result(60.0) == 2


_FORKED = """
import os, sys
from pathlib import Path
from threading import Event, Thread
from herringbone.running.output.claim import FolderLock
from herringbone.studies.working.forked import can_fork
from herringbone.studies.working.processes import WorkerProcesses

def held():
    numbers = [entry.name for entry in Path("/proc/self/fd").iterdir()]
    files = [Path("/proc/self/fd", n) for n in numbers]
    return os.getppid(), [str(f.readlink()) for f in files if f.exists() or f.is_symlink()]

assert can_fork()
waiting = Event()
thread = Thread(target=waiting.wait)
thread.start()
assert not can_fork()
waiting.set()
thread.join()
lock = FolderLock(Path(sys.argv[1]))
executor = WorkerProcesses(2, forked=True)
parent, files = executor.submit(held).result()
assert parent == os.getpid()
assert sys.argv[1] not in files
assert sum(name.startswith("pipe:") for name in files) == 2, files
lock.release()
FolderLock(Path(sys.argv[1])).release()
executor.shutdown()
"""


def test_a_forked_worker_holds_nothing_of_its_parent(tmp_path):
    """Neither the lock of a folder nor the pipes of its sibling; and a thread is not copied."""
    with (tmp_path / "errors").open("w") as errors:
        done = subprocess.run([sys.executable, "-c", _FORKED, tmp_path], check=False, stderr=errors)
    assert done.returncode == 0, (tmp_path / "errors").read_text()


def test_an_interrupted_sweep_has_a_table_of_its_points_so_far(tmp_path):
    """Seven of ten: a line of five that is whole, and two of the other."""
    reached, told = [], []

    def progress(points):
        reached.append(points)
        if sum(reached) == 7:
            raise KeyboardInterrupt

    wanted = {"speed": [10.0, 20.0, 30.0, 40.0, 50.0], "torque": [1.0, 2.0], "workers": 1}
    with pytest.raises(KeyboardInterrupt):
        hb.sweep(
            "gearbox", evaluator=Cheap(), output=tmp_path, told=told.append, progress=progress,
            **wanted,
        )  # fmt: skip
    assert "interrupted: 7 of 10 points are in" in told[-1]
    found = pd.read_csv(tmp_path / "table.csv")
    whole = hb.sweep("gearbox", evaluator=Cheap(), output=tmp_path, **wanted).table
    assert found["x"].tolist() == whole["x"].tolist()[:7]
    assert not list((tmp_path / "chains").glob(".*"))


def test_nothing_of_another_study_stays_when_one_is_cut_off(tmp_path):
    """Its table and pictures would be taken for those of the study that `study.json` tells."""
    wanted = {"output": tmp_path, "workers": 1, "overwrite": True}
    hb.sweep("gearbox", evaluator=Cheap(), speed=[1.0, 2.0], parquet=True, **wanted)
    for name in ("levels.png", "tornado.x.png", "mine.png"):
        (tmp_path / name).touch()

    def progress(points):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hb.sweep("gearbox", evaluator=Cheap(), speed=[3.0], progress=progress, **wanted)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["chains", "mine.png", "study.json"]
    with pytest.raises(ResourceError, match=r"has no table\.csv: .* one that was cut off"):
        hb.read_table(tmp_path)
    assert main(["plot", str(tmp_path)]) == 2


def test_long_periods_are_told():
    rows = (Row("steady", "", {"period_meshes": 1.0}), Row("steady", "", {"period_meshes": 1633.0}))
    assert longest_period([Done(rows, {}, 1.0)]) == 1633.0
    assert longest_period([Done((Row("failed", "", {}),), {}, 1.0)]) == 0.0


ONE_CHAIN = """
import sys
from pathlib import Path
from support.studies import Cheap
import herringbone as hb
from herringbone.studies.working import so_far
so_far._EVERY = 0.0
hb.sweep("gearbox", speed=[100.0 * k for k in range(1, 9)], torque=[1.0], workers=1,
         evaluator=Cheap(deadly=500.0, log=sys.argv[2], mark=sys.argv[3]),
         output=Path(sys.argv[1]))
"""


@pytest.mark.parametrize("half", [False, True])
def test_a_chain_goes_on_where_it_was_killed(tmp_path, serial, half):
    """Half: its last row had no time to come to its end; the point before is not lost by that."""
    folder, log, mark = (str(tmp_path / name) for name in ("study", "log", "mark"))
    environment = {**os.environ, "PYTHONPATH": module_path()}
    code = subprocess.run(
        [sys.executable, "-c", ONE_CHAIN, folder, log, mark], env=environment, check=False
    ).returncode
    assert code == -signal.SIGKILL
    if half:
        (rows,) = Path(folder).glob("chains/*.rows")
        with rows.open("a") as stream:
            stream.write('[4, {"outcome": "compl')
    Path(log).unlink()
    found = swept(Path(folder), torque=[1.0], evaluator=Cheap(deadly=500.0, mark=mark, log=log))
    assert found.table.equals(serial.iloc[:8])
    computed = [float(line) for line in Path(log).read_text().split()]
    assert computed == [*SPEEDS[:2], *SPEEDS[:2], *SPEEDS[4:]]  # the first ones tell the cost
    assert [file.suffix for file in Path(folder, "chains").iterdir()] == [".json"]


def test_several_gear_pairs_are_told_apart():
    found = hb.sweep("back_to_back", speed=[100.0], workers=1, evaluator=Cheap())
    assert found.of.startswith("mesh frequency and orders of first.gear_mesh, ")
    assert swept(torque=[1.0]).of == ""


def test_a_variable_has_one_name_and_one_value():
    """Rows would claim the values of the other name."""
    damping, long = "gear_mesh.mesh_damping_ratio", "gearbox.gear_mesh.mesh_damping_ratio"
    with pytest.raises(ParameterError, match="are the same variable; give one of them"):
        hb.sweep("test_rig", vary={damping: [0.03, 0.05], long: [0.2, 0.3]})
    with pytest.raises(ParameterError, match=f"{damping} is varied, and set besides"):
        hb.sweep("test_rig", vary={damping: [0.03, 0.05]}, values={damping: 0.2})


def test_a_system_itself_is_swept_as_the_one_of_its_name(tmp_path, serial):
    """Same content, same rows: in other processes, and of a folder that has them already.

    A System has no folder of scenes, as everywhere: a file says which one.
    """
    log, scene = tmp_path / "log", find_system("gearbox") / "scenes" / "loaded.toml"
    evaluator = Cheap(log=str(log))
    wanted = {"speed": SPEEDS, "torque": TORQUES, "evaluator": evaluator, "scene": scene}
    evaluated = []
    for system in (read_system("gearbox"), "gearbox"):
        found = hb.sweep(system, workers=2, output=tmp_path / "study", **wanted)
        assert found.table.equals(serial)
        evaluated.append(len(log.read_text().splitlines()))
    assert evaluated[0] == evaluated[1]


def test_a_table_is_read_back_bit_by_bit_with_the_units_of_the_sweep(tmp_path):
    """Pure numbers have the unit "" in memory, and "1" in the file."""
    found, read = swept(tmp_path), hb.read_table(tmp_path)
    pd.testing.assert_frame_equal(read.data, found.table, check_exact=True)
    assert read.units == found.units
    assert read.units["speed"] == "rad/s"
    assert read.units["x"] == "m"
    assert read.units["point"] == read.units["message"] == ""
    assert repr(read) == "StudyTable(points 24; table 6 columns)"
