"""Processes with Python FMUs end as they are asked to; `campaigns.exits` tries a thousand."""

import os
import sys

import pytest
from campaigns.exits import try_exits


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="exit codes of signals, cores by affinity")
def test_process_exits(tmp_path):
    found, bad = try_exits(6, 5, len(os.sched_getaffinity(0)), tmp_path)
    assert not bad
    assert {how.partition(",")[0] for how in found} == {"close", "leave"}
