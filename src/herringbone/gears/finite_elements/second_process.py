"""One tooth computed by a process of its own, beside the other tooth.

The process runs this file: it takes the arguments of `tooth_compliance` from stdin and writes to
stdout the share of the work done, again and again, and at last the compliance; all pickled.
Not `multiprocessing`: that would run the user's script a second time.
"""

import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from threading import Thread

from herringbone.core.places.paths import PACKAGE
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.gears.finite_elements.blocks import Resolution
from herringbone.gears.finite_elements.compliance import ToothCompliance, tooth_compliance
from herringbone.gears.geometry.gear_pair import GearPair

Job = tuple[GearPair, int, Resolution, int]
"""Arguments of `tooth_compliance`, without `progress`."""
_MODULE = "herringbone.gears.finite_elements.second_process"
_POLL = 0.3
"""Time between two calls of `progress` [s]."""


class SecondProcess:
    """Compliance of a tooth, computed elsewhere; a context, at whose end the process is gone.

    Args:
        job: what to compute.

    Attributes:
        done: share of the work done.
    """

    def __init__(self, job: Job) -> None:
        self._job = job
        self.done = 0.0
        self._found: ToothCompliance | None = None

    def __enter__(self) -> "SecondProcess":
        path = [str(PACKAGE.parent), os.environ.get("PYTHONPATH", "")]
        self._process = subprocess.Popen(
            [sys.executable, "-m", _MODULE],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, path))},
        )
        self._reader = Thread(target=self._talk, daemon=True)
        self._reader.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._process.kill()
        self._process.wait()
        self._reader.join()

    def _talk(self) -> None:
        """Give it the job and take what it says, up to its end; it may die at any moment."""
        source, target = self._process.stdout, self._process.stdin
        assert source and target
        with source, suppress(OSError, EOFError, pickle.UnpicklingError):
            with target:
                pickle.dump(self._job, target)
            while not isinstance(content := pickle.load(source), ToothCompliance):
                self.done = content
            self._found = content

    def result(self, progress: Callable[[float], None]) -> ToothCompliance:
        """Wait for it; if the process failed, the tooth is computed here.

        Args:
            progress: called with the share of the work done.

        Raises:
            ParameterError: see `tooth_compliance`.
        """
        while self._reader.is_alive():
            self._reader.join(_POLL)
            progress(self.done)
        return self._found or tooth_compliance(*self._job, progress)


def _send(content: object) -> None:
    pickle.dump(content, sys.stdout.buffer)
    sys.stdout.buffer.flush()


def main() -> None:
    """What the process does."""
    job: Job = pickle.load(sys.stdin.buffer)
    with one_blas_thread():
        _send(tooth_compliance(*job, _send))


if __name__ == "__main__":
    main()
