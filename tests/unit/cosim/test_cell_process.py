"""Cells end with all that their FMUs have started, and after a number of uses."""

import sys
import threading
from pathlib import Path

import pytest
from support.foreign.c_flange import c_flange
from support.foreign.helpers import start_helper, start_helper_and_exit

from herringbone.cosim.cell import pool
from herringbone.cosim.cell.policy import foreign_fmu_policy
from herringbone.cosim.cell.process import CellLost
from herringbone.cosim.fmu.opening import applied, open_fmu

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="cells need Linux")


def descriptors():
    return len(list(Path("/proc/self/fd").iterdir()))


def test_what_an_fmu_starts_ends_with_its_cell(tmp_path):
    """Else it holds the cell's output, and with it a thread and a descriptor of the master."""
    file = c_flange(tmp_path, "ROTOR")
    with foreign_fmu_policy(in_process=False):
        applied(file, start_helper)
        threads, open_ = set(threading.enumerate()), descriptors()
        applied(file, start_helper)
        with pytest.raises(CellLost, match="with exit code 3"):
            applied(file, start_helper_and_exit)
    assert set(threading.enumerate()) <= threads
    assert descriptors() == open_


def test_a_cell_is_used_a_limited_number_of_times(tmp_path, monkeypatch):
    """Each run loads another copy of the library, which stays in memory."""
    monkeypatch.setattr(pool, "_MOST_USES", 2)
    file, cells = c_flange(tmp_path, "ROTOR"), []
    with foreign_fmu_policy(in_process=False):
        for _ in range(3):
            part = open_fmu("rotor", file)
            cells.append(part._cell)
            part.close()
    assert [cell is cells[0] for cell in cells] == [True, True, False]
