"""The folder of a study: what was asked, chains that are done, and the table in the end.

A chain is written whole under its address or not at all, so that whatever was killed, the chains
that are there are right; see `docs/sweeps.md`.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from herringbone.core import HerringboneError, OutcomeKind, ResourceError
from herringbone.core.caching.keys import digest_of
from herringbone.core.places.files import PART, is_file
from herringbone.core.wording import option
from herringbone.result.folder.formatted import read_formatted
from herringbone.result.folder.names import STUDY, State, remove_study
from herringbone.result.folder.run_file import RunFile, read_run_file
from herringbone.result.folder.writing import refused, write_text
from herringbone.result.result import Result
from herringbone.running.output.claim import FolderLock
from herringbone.running.reporting.report import store_result
from herringbone.studies.keys import Chain
from herringbone.studies.working.chain import FAILED, Done, read_so_far
from herringbone.studies.working.so_far import Row, SoFar

FORMAT = 1
_VERSIONS = {"versions", "studies"}
"""Settings that tell who has computed."""
_TRIED_AGAIN = {FAILED, OutcomeKind.PART_FAILED.value}
CHAINS, SERIES = "chains", "series"
_CPU, _UNITS, _ROWS = "cpu_s", "units", "rows"


class StudyFolder:
    """A folder that one study at a time writes into.

    Args:
        folder: is made if it is not there.

    Raises:
        HerringboneError: it cannot be made, or another process writes into it.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._lock = FolderLock(folder)
        try:
            (folder / CHAINS).mkdir(exist_ok=True)
            for part in (*folder.glob(f".*{PART}"), *(folder / CHAINS).glob(f".*{PART}")):
                part.unlink(missing_ok=True)
        except OSError as error:
            self._lock.release()
            raise refused(error, folder) from error

    def close(self) -> None:
        """Let others write."""
        self._lock.release()

    def claim(self, asked: Mapping[str, Any], *, overwrite: bool) -> None:
        """Begin or go on with a study.

        Args:
            asked: what tells studies apart, for JSON.
            overwrite: the table of another study may be replaced; it goes at once, with its
                pictures.

        Raises:
            HerringboneError: another study is there, or its table cannot be removed.
        """
        content = {"format": FORMAT, **asked}
        known = read_study(self.folder)
        if known is not None and known != content and not overwrite:
            raise HerringboneError(
                f"{self.folder} holds {_other(known, content)}; choose another folder, or "
                f"{option('overwrite', True)}: chains that both have are not computed again"
            )
        if known != content:
            try:
                remove_study(self.folder)
            except OSError as error:
                raise refused(error, self.folder) from error
        write_text(self.folder / STUDY, json.dumps(content, indent=1) + "\n")

    def _file(self, chain: Chain) -> Path:
        return self.folder / CHAINS / f"{chain.key}.json"

    def has(self, chain: Chain, *, series: bool) -> bool:
        """True if a chain is done, with its rows over time if these are asked for.

        A point of its own that a part has failed is tried again: it may have died for want of
        memory, or have come too late on a machine that had other things to do.
        """
        found = self._read(chain) if is_file(self._file(chain)) else None
        if found is None or (len(found.rows) == 1 and found.rows[0].outcome in _TRIED_AGAIN):
            return False
        return not series or all(map(self._has_series, chain.keys))

    def _has_series(self, key: str) -> bool:
        run = read_run_file(self.series(key))
        return run is not None and run.state is State.COMPLETE

    def series(self, key: str) -> Path:
        """Folder of the rows over time of a point."""
        return self.folder / SERIES / key

    def write(self, chain: Chain, done: Done) -> None:
        """Keep a chain; raises HerringboneError."""
        for place, result in done.series.items():
            self._write_series(self.series(chain.keys[place]), result)
        body = {
            _CPU: done.cpu,
            _UNITS: done.units,
            _ROWS: [asdict(row) for row in done.rows],
        }
        text = json.dumps(body)
        write_text(self._file(chain), f"{digest_of(text)}\n{text}\n")
        SoFar(self.so_far(chain)).remove()

    def _write_series(self, folder: Path, result: Result) -> None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise refused(error, folder) from error
        store = store_result(result, folder, RunFile(State.RUNNING, (), {}))
        try:
            store.write(result, State.COMPLETE)
        finally:
            store.close()

    def read(self, chain: Chain) -> Done:
        """A chain that is there; raises ResourceError if it is not any more."""
        found = self._read(chain)
        if found is None:
            raise ResourceError(f"{self._file(chain)} is gone or damaged; run the sweep again")
        return found

    def _read(self, chain: Chain) -> Done | None:
        try:
            digest, _, text = self._file(chain).read_text(encoding="utf-8").partition("\n")
        except (OSError, ValueError):
            return None
        text = text.removesuffix("\n")
        if digest != digest_of(text):
            return None
        body = json.loads(text)
        rows = tuple(Row(**row) for row in body[_ROWS])
        return Done(rows, body[_UNITS], body[_CPU])

    def so_far(self, chain: Chain) -> Path:
        """File of the rows of a chain that is not whole, see `SoFar`."""
        return self.folder / CHAINS / f"{chain.key}.rows"

    def all(self, chains: list[Chain], *, whole: bool = True) -> Iterator[tuple[Chain, Done]]:
        """Chains one after the other, of which one is in memory at a time.

        Args:
            chains: of the study.
            whole: all are there; else of others the points that are there so far.
        """
        for chain in chains:
            if whole or is_file(self._file(chain)):
                yield chain, self.read(chain)
            elif done := read_so_far(self.so_far(chain)):
                count = len(done.rows)
                yield Chain(chain.numbers[:count], chain.keys[:count]), done


def read_study(folder: Path) -> dict[str, Any] | None:
    """What stands in `study.json`; None if there is none.

    Raises:
        ResourceError: it cannot be read, or is of a later format.
    """
    return read_formatted(folder / STUDY, FORMAT)


def _other(known: Mapping[str, Any], asked: Mapping[str, Any]) -> str:
    """What a folder holds in place of what is asked for."""
    of_both = known.get("settings"), asked.get("settings")
    old, new = (of if isinstance(of, dict) else {} for of in of_both)
    apart = [n for n, v in new.items() if old.get(n) != v]
    what = [n for n, v in asked.items() if known.get(n) != v and n not in {"key", "settings"}]
    if apart and not what and _VERSIONS.issuperset(apart):
        return "this study as another version of the package, or of a library, computed it"
    return f"another study ({', '.join([*what, *apart]) or 'settings'})"
