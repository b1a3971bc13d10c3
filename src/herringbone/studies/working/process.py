"""A process that computes: it takes pickled calls from stdin and writes what comes out to stdout.

It ends with its stdin, so also when its parent is killed, in the midst of a chain as well.
"""

import os
import pickle
import sys
from queue import SimpleQueue
from threading import Thread
from typing import BinaryIO, NoReturn


def main() -> None:
    """What the process does."""
    source = sys.stdin.buffer
    target = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what parts print is no answer
    serve(source, target)


def serve(source: BinaryIO, target: BinaryIO) -> NoReturn:
    """Do what is called for; the process ends with the source."""
    calls: SimpleQueue[tuple] = SimpleQueue()
    Thread(target=_listen, args=(source, calls), daemon=True).start()
    while True:
        function, args, kwargs = calls.get()
        found, raised = None, None
        try:
            found = function(*args, **kwargs)
        except Exception as error:  # it is raised where the call came from
            raised = error
        pickle.dump((found, raised), target)
        target.flush()


def _listen(source: BinaryIO, calls: SimpleQueue[tuple]) -> None:
    """Take calls until there are no more; nobody is there then who would take an answer."""
    while True:
        try:
            calls.put(tuple(pickle.load(source)))
        except (EOFError, OSError, pickle.UnpicklingError):
            os._exit(0)


if __name__ == "__main__":
    main()
