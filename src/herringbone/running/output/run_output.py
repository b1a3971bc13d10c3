"""The folder of a run, from the claim before it starts to its last file."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from herringbone.core import HerringboneError
from herringbone.core.places.files import not_utf8
from herringbone.core.wording import option
from herringbone.cosim.rows.stream import Streaming
from herringbone.cosim.structure.system import System
from herringbone.result.folder.checked_store import ReplayError
from herringbone.result.folder.names import State, remove_results
from herringbone.result.folder.run_file import RunFile
from herringbone.result.folder.store import Store
from herringbone.result.folder.writing import refused
from herringbone.result.result import Result
from herringbone.running.output.claim import Claim, FolderLock, claimed
from herringbone.running.output.resumed import Resumed
from herringbone.running.output.settings import key_of, settings_of
from herringbone.running.reporting.report import finish_report, store_result, write_summary
from herringbone.scenes import Scene


@dataclass
class RunOutput:
    """Where a run goes.

    Args:
        folder: None: `results/SYSTEM-SCENE`.
        overwrite: whatever is there may be replaced.
        parquet: write results.parquet as well.
        pictures: draw them.
        asked: options of the command, for `--resume`.
        system: what the default folder calls the system.
        resumed: the run in the folder goes on.

    Attributes:
        shown: the folder, as it was given.
        notes: lines that the user should read.
    """

    folder: Path | None = None
    overwrite: bool = False
    parquet: bool = False
    pictures: bool = True
    asked: Mapping[str, Any] = field(default_factory=dict)
    system: str = ""
    resumed: Resumed | None = None

    def __post_init__(self) -> None:
        self._start = Path.cwd()  # FMUs may change it
        self.shown = self.folder or Path("results")
        self.notes: list[str] = []
        self._run = RunFile(State.RUNNING, (), {})
        self._lock: FolderLock | None = None
        self._store: Store | None = None
        self._written: tuple[str, ...] = ()

    @property
    def path(self) -> Path:
        """The folder, wherever FMUs have gone."""
        return self._start / self.shown

    def claim(self, system: System, scene: Scene, options: object) -> None:
        """Choose the folder and keep others out of it, before anything is computed or written.

        Raises:
            HerringboneError: another run is there, or writes there, or a name is not UTF-8.
        """
        self._check_names()
        settings = settings_of(system, scene, options)
        key = key_of(settings)
        if self.resumed is not None:
            self._lock = FolderLock(self.path)
            self.resumed.check(settings)
            self._run = self.resumed.run
            return
        wanted = self.folder or Path("results") / f"{self.system or system.name}-{scene.name}"
        named = self.folder is not None
        claim = Claim(self._start / wanted, named, key, settings, self.overwrite)
        self._lock = claimed(claim)
        self.shown = wanted
        if self._lock.folder != claim.folder:  # it got a number; "." has no name to change
            self.shown = wanted.with_name(self._lock.folder.name)
            self.notes.append(
                f"results go to {self.shown}: {wanted} holds a run of other settings, or of an "
                f"older version; {option('overwrite', True)} overwrites it"
            )
        self._run = RunFile(
            State.RUNNING, (), {}, key=key, settings=settings, asked=self.asked,
            folder=str(self._start),
        )  # fmt: skip

    def _check_names(self) -> None:
        """Refuse names that the files of a run would tell and no text can hold."""
        if name := not_utf8(self.path):
            raise HerringboneError(
                f"cannot write {self.path}: the name {name} is not UTF-8; choose another folder"
            )
        for value in self.asked.values():
            for given in value if isinstance(value, list) else [value]:
                if name := not_utf8(Path(str(given))):
                    raise HerringboneError(f"the name {name} is not UTF-8; rename it")

    def stream(self, start: Result, every: int = 1, *, keeps_all: bool = False) -> Streaming:
        """Where the rows of the run go.

        With the first of them, what another run has left in the folder is removed.

        Args:
            start: all that is known of the result before there are rows.
            every: so many records make a row.
            keeps_all: all records stay in memory as well.

        Raises:
            HerringboneError: the folder cannot be written.
        """
        if self.resumed is not None:
            state = None if keeps_all else self.resumed.state
            self._store = self.resumed.store(start, state)
            return Streaming(self._store, every, keeps_all, state)
        self._store = Store(self.path, self._run, start, self._empty)
        return Streaming(self._store, every, keeps_all)

    def _empty(self) -> None:
        try:
            remove_results(self.path)
        except OSError as error:
            raise refused(error, self.path) from error

    def seen(self, result: Result) -> Result:
        """The result of a long run, with an overview of it all, and a note on what is shown."""
        if self._store is None or len(result.data) == self._store.rows:
            return result
        table = self._store.table
        since, rows = float(result.data.iloc[0, 0]), len(result.data)
        note = (
            f"figures are taken from {since:.6g} s on, the last {rows} of {table.rows} records; "
            f"{self.shown} has all"
        )
        return replace(result.noted(note), whole=table.overview(), before=table.before(rows))

    def write(self, result: Result) -> None:
        """Write all files; a better run replaces the one before.

        Raises:
            HerringboneError: a file cannot be written.
        """
        if self._store is None:
            self._empty()
            self._store = store_result(result, self.path, self._run)
        store, self._store = self._store, None
        try:
            self._written = finish_report(
                store, result, self.shown, parquet=self.parquet, pictures=self.pictures
            ).files
        except HerringboneError as error:
            rest = ", and --resume writes the rest" if self.asked else ""
            raise HerringboneError(f"{error}; all records are in {self.shown}{rest}") from error
        finally:
            store.close()
        self._run = store.run

    def complete(self, result: Result) -> Result:
        """Add what was found out since, and say that nothing will follow.

        Returns:
            The result with its files.

        Raises:
            HerringboneError: a file cannot be written.
        """
        result = replace(result, files=self._written)
        write_summary(result, self.path, self._run, complete=True)
        self.close()
        return result

    def close(self) -> None:
        """Let others write into the folder."""
        if self._store is not None:
            self._store.close()
        if self._lock is not None:
            self._lock.release()

    @contextmanager
    def explaining(self) -> Iterator[None]:
        """Context whose errors say what is there of a run that could not go on."""
        try:
            yield
        except HerringboneError as error:
            store = self._store
            if store is None or not store.rows or isinstance(error, ReplayError):
                raise
            last = float(store.table.last(1).iloc[0, 0])
            go_on = ", and --resume goes on from there" if self.asked else ""
            raise HerringboneError(
                f"{error}; {store.rows} records up to {last:.6g} s are in {self.shown}{go_on}"
            ) from error
