"""Compiled loops and components stay within their arrays: numba checks every index."""

import os
import subprocess
import sys
from pathlib import Path

from herringbone.core.places.paths import CACHE_VARIABLE

TESTS = Path(__file__).parents[2]


def test_no_index_is_out_of_bounds(tmp_path):
    """With code of its own, in a process of its own. Unchecked, a write may end a later free()."""
    told = {"NUMBA_BOUNDSCHECK": "1", "NUMBA_OPT": "0", CACHE_VARIABLE: str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-m", "support.checked_loops"],
        cwd=TESTS, env={**os.environ, **told}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Error" not in done.stderr
