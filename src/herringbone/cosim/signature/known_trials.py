"""Outcomes of trials, kept by what they depend on, so that no process makes them again.

What is kept is what was seen: of a trial that is made again, to see whether it gives the same, the
second outcome is kept beside the first. Of parts that do not repeat nothing is kept, and no refusal
that a crash or a deadline made. Outcomes that are made later stand beside kept ones only if the
first steps give the bits that they gave.
"""

import json
import logging
from collections import Counter
from collections.abc import Callable, Sequence

import numpy as np

from herringbone.core.caching.arrays import Kept, keep_arrays, kept_arrays
from herringbone.core.caching.keys import digest_of, kernels_key
from herringbone.core.caching.tried import tried_folder
from herringbone.cosim.signature.first_steps import FirstSteps
from herringbone.cosim.signature.trial import Refused

_FOLDER = "trials"
_SOURCES = (
    "herringbone.cosim.signature.laboratory",
    "herringbone.cosim.fmu.opening",
    "herringbone.cosim.starting.approached_part",
    "herringbone.cosim.units",
)
_AT_START, _AFTER, _FACTS, _REFUSED = "at start", "after", "facts", "refused"
_OF_FIRST = 3
"""How many of those stand in a file of which a part takes steps."""
_LOG = logging.getLogger("herringbone")


class KnownTrials:
    """Outcomes of the trials of a part from one start.

    Args:
        content: what the part depends on: its name, content of its FMU, values; empty: nothing is
            kept.
        start: where and how trials begin.
    """

    def __init__(self, content: Sequence[str], start: str) -> None:
        self._file = None
        if content:
            self._file = tried_folder(_FOLDER) / digest_of(kernels_key(*_SOURCES), *content, start)
        self._known: dict[str, Kept] = kept_arrays(self._file) if self._file else {}
        self._saved, self._unkept, self._asked = len(self._known), 0, Counter[str]()

    @property
    def count(self) -> int:
        """Trials that were made, also at other times."""
        return max(0, len(self._known) - _OF_FIRST) + self._unkept

    @property
    def first(self) -> FirstSteps | None:
        """What the first steps told; None: nothing is known; raises Refused if they were."""
        if _REFUSED in self._known:
            raise Refused(str(self._known[_REFUSED]))
        if _FACTS not in self._known:
            return None
        at_start, after = (np.array(self._known[name]) for name in (_AT_START, _AFTER))
        return FirstSteps(at_start, after, **json.loads(str(self._known[_FACTS])))

    def put_first(self, found: FirstSteps) -> None:
        """Put down what the first steps told; nothing is kept of a part that does not repeat."""
        facts = {"restores": found.restores, "repeats": found.repeats, "why": found.why}
        self._known |= {
            _AT_START: found.at_start,
            _AFTER: found.after,
            _FACTS: json.dumps(facts),
        }
        if not found.repeats:
            self._file = None

    def put_refusal(self, error: Refused) -> None:
        """Put down that the part refuses its first steps."""
        if not error.lost:
            self._known[_REFUSED] = str(error)
            self.save()

    def drop(self, name: str) -> None:
        """Forget what was kept, as the part does otherwise now; a line is logged."""
        if self._file:
            _LOG.warning(
                "%s: its first steps are not those that it took when trials of it were kept in %s, "
                "though its FMU is the same: some of what is told is of that time; they are made "
                "anew the next time", name, self._file.parent,
            )  # fmt: skip
            self._file.unlink(missing_ok=True)
        self._file = None

    def outcome(
        self, find: Callable[[], np.ndarray], what: str, h: float, given: np.ndarray
    ) -> np.ndarray:
        """Outcome of a trial, known or found now.

        Args:
            find: makes it; what it raises besides Refused is raised, and not kept.
            what: is read.
            h: step [s].
            given: inputs over time.

        Raises:
            Refused: the part refuses.
        """
        if not self._file:
            self._unkept += 1
            return find()
        asked = digest_of(f"{what} {h!r} {given.shape}", given.tobytes())
        self._asked[asked] += 1
        key = f"{asked} {self._asked[asked]}"
        if key not in self._known:
            try:
                self._known[key] = find()
            except Refused as error:
                if error.lost:
                    raise
                self._known[key] = str(error)
        found = self._known[key]
        if isinstance(found, str):
            raise Refused(found)
        return found.copy()

    def save(self) -> None:
        """Keep what was found, beside what others have kept meanwhile."""
        if self._file and len(self._known) > self._saved:
            keep_arrays(self._file, {**kept_arrays(self._file), **self._known})
            self._saved = len(self._known)
