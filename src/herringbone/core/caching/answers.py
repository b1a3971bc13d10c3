"""Answers that the next process need not find again.

Those of commands are known as long as all files that they were read from are the same; those on
which runs depend, by a key.
"""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import Any

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import answer_key, digest_of, kernels_key, versions_of
from herringbone.core.caching.remembered import content_key
from herringbone.core.places.files import is_folder
from herringbone.core.places.noted import noting
from herringbone.core.places.paths import cache_root

FOLDER = "answers"
"""In the cache."""
_FOLDER, _NOTHING = "a folder", "nothing"


class Answers:
    """The answers to one question, of which the one that was found last is kept.

    Args:
        asked: everything that decides the answer, besides files, sources and what is installed.
    """

    def __init__(self, *asked: str) -> None:
        self._file = cache_root() / FOLDER / f"{answer_key(*asked)}.json"

    def known(self) -> Any:  # noqa: ANN401 (what was kept)
        """The answer that was kept; None if there is none, or a file has changed."""
        found = kept(self._file)
        if found is None or any(_state(file) != state for file, state in found["files"].items()):
            return None
        return found["answer"]

    @contextmanager
    def finding(self) -> Iterator["Found"]:
        """Context in which the answer is found; it is kept if it is handed over."""
        found = Found()
        with noting(found.see):
            yield found
        if found.answer is not None and found.files is not None:
            keep(self._file, {"files": found.files, "answer": found.answer})


class Found:
    """An answer, and the files that were asked for meanwhile.

    Attributes:
        answer: as JSON may hold it; None: there is none to be kept.
        files: their states before they were read, by path; None if one has changed since.
    """

    def __init__(self) -> None:
        self.answer: Any = None
        self.files: dict[str, str] | None = {}
        self._lock, self._looking = RLock(), False

    def see(self, path: str) -> None:
        """Note the state of a file; what was made meanwhile is as it was made."""
        with self._lock:
            if self.files is None or self._looking:
                return
            self._looking = True  # which asks for the file, too
            try:
                state = _state(path)
            finally:
                self._looking = False
            if self.files.get(path, state) in {state, _NOTHING}:
                self.files[path] = state
            else:
                self.files = None


class FirstAsked:
    """What a process asks first, which its next one will ask, too.

    Later answers are found and not kept: sweeps have thousands.

    Args:
        sources: modules that find the answers.
    """

    _MOST = 4
    _LIBRARIES = "numpy", "scipy"

    def __init__(self, *sources: str) -> None:
        self._sources, self._left = sources, self._MOST

    def __call__(self, key: str, find: Callable[[], Any]) -> Any:  # noqa: ANN401 (what is found)
        """The answer under a key, as JSON has it; what `find` raises is raised, and not kept."""
        self._left -= 1
        if self._left < 0:
            return find()
        whole = digest_of(key, kernels_key(*self._sources), *versions_of(*self._LIBRARIES))
        file = cache_root() / FOLDER / f"{whole}.json"
        known = kept(file)
        if known is None:
            keep(file, known := json.loads(json.dumps({"answer": find()})))
        return known["answer"]


def _state(path: str) -> str:
    """Content of a file; whether there is a folder, or nothing."""
    file = Path(path)
    return content_key(file) or (_FOLDER if is_folder(file) else _NOTHING)
