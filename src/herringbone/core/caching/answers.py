"""Answers of commands, known again as long as all files that they were read from are the same."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import RLock
from typing import Any

from herringbone.core.caching.files import keep, kept
from herringbone.core.caching.keys import answer_key
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


def _state(path: str) -> str:
    """Content of a file; whether there is a folder, or nothing."""
    file = Path(path)
    return content_key(file) or (_FOLDER if is_folder(file) else _NOTHING)
