"""What a run leaves for people: a summary to read, pictures, and the table."""

import json
from dataclasses import replace
from pathlib import Path

from herringbone.analysis.figures.standstill import has_pictures
from herringbone.core.process.one_thread import one_blas_thread
from herringbone.core.run_table import TableColumns
from herringbone.result.folder.names import (
    FORMAT,
    OTHERS,
    PARQUET,
    ROWS,
    RUN,
    SUMMARY,
    TABLE,
    TEXT,
    UNITS,
    State,
    remove_results,
)
from herringbone.result.folder.result_file import stored_result
from herringbone.result.folder.run_file import RunFile, write_run_file
from herringbone.result.folder.store import Store
from herringbone.result.folder.typed import as_json
from herringbone.result.folder.writing import refused, replacing, write_text
from herringbone.result.result import TIME, Result
from herringbone.result.tables import parquet_library, write_csv, write_parquet, write_units
from herringbone.running.reporting.physical import physical_results
from herringbone.running.reporting.summary import summary_text


def write_report(
    result: Result,
    folder: str | Path,
    *,
    parquet: bool = False,
    shown: str | Path | None = None,
) -> Result:
    """Write a result into a folder, made if needed; see `docs/results_folder.md`.

    Args:
        result: of a run, with all its rows.
        folder: where the files go. Those of an earlier run are replaced; what that run had and
            this one has not, such as a picture of its torques, is removed.
        parquet: write results.parquet as well.
        shown: how the folder is called in `files`; as it is if not given.

    Returns:
        The result with `files` filled in.

    Raises:
        HerringboneError: a file cannot be written.
    """
    folder, shown = Path(folder), Path(folder if shown is None else shown)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        remove_results(folder)
    except OSError as error:
        raise refused(error, folder) from error
    store = store_result(result, folder, RunFile(State.RUNNING, (), {}))
    try:
        result = finish_report(store, result, shown, parquet=parquet)
    finally:
        store.close()
    write_summary(result, folder, store.run, complete=True)
    return result


def store_result(result: Result, folder: Path, run: RunFile) -> Store:
    """The rows of a result that is in memory, in an empty folder; raises HerringboneError."""
    store = Store(folder, run, result)
    reals = result.signals
    others = [name for name in result.data.columns if name not in {TIME, *reals}]
    types = {name: result.data[name].dtype.name for name in others}
    units = {name: result.units[name] for name in others}
    store.begin(TableColumns(tuple(reals), tuple(result.units[n] for n in reals), types, units))
    store.append(
        result.data[TIME].to_numpy(float),
        result.data[reals].to_numpy(float),
        result.data[others].astype(object).to_numpy().tolist(),
    )
    return store


def finish_report(
    store: Store, result: Result, shown: Path, *, parquet: bool = False, pictures: bool = True
) -> Result:
    """Write what follows from rows that are all there.

    What takes longest and is least needed comes last: the pictures. The summary is there before.

    Args:
        store: has the rows.
        result: of the run; of a long one with its last rows.
        shown: how the folder is called.
        parquet: write results.parquet as well.
        pictures: draw them.

    Returns:
        The result with `files` filled in.

    Raises:
        HerringboneError: a file cannot be written.
    """
    folder, table = store.folder, store.table
    names = [TABLE, *([PARQUET] if parquet else []), TEXT, SUMMARY, RUN, ROWS, UNITS]
    names += [OTHERS] if table.others else []
    if parquet:
        parquet_library()
    store.write(result, State.ROWS)
    with replacing(folder / UNITS) as stream:
        write_units(stream, store.run.units)
    with replacing(folder / TABLE) as stream:
        write_csv(stream, [*table.columns, *table.others], table.pieces())
    if parquet:
        with replacing(folder / PARQUET, text=False) as stream:
            write_parquet(stream, table.pieces())
    result = replace(result, files=tuple(str(shown / name) for name in names))
    write_summary(result, folder, store.run)
    if not (pictures and has_pictures(result)):
        return result
    from herringbone.plotting import write_pictures  # noqa: PLC0415 (matplotlib: lazy)

    with one_blas_thread():
        drawn = [str(shown / picture.name) for picture in write_pictures(result, folder)]
    return replace(result, files=(*result.files, *drawn))


def write_summary(result: Result, folder: Path, run: RunFile, *, complete: bool = False) -> None:
    """Write summary.txt, summary.json and run.json into a folder.

    Args:
        result: of the run.
        folder: of the run.
        run: what stands in run.json so far.
        complete: nothing will follow.

    Raises:
        HerringboneError: a file cannot be written.
    """
    with one_blas_thread():
        figures, text = physical_results(result), summary_text(result)
    content = {
        "format": FORMAT,
        "complete": complete,
        **result.summary(),
        "figures": figures,
        "units": dict(result.units),
        "parameters": dict(result.info.parameters),
        "resources": dict(result.info.resources),
    }
    write_text(folder / TEXT, text)
    state = State.COMPLETE if complete else State.ROWS
    write_run_file(folder, replace(run, state=state, result=stored_result(result)))
    write_text(folder / SUMMARY, json.dumps(as_json(content), indent=2) + "\n")
