"""What is made once, though several test processes ask for it."""

import fcntl
from contextlib import contextmanager

from herringbone.core.places.paths import cache_folder


@contextmanager
def alone(what):
    """Context for one process at a time: what one test process builds, the others find built."""
    with (cache_folder("locks") / what).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # given back when the file is closed
        yield
