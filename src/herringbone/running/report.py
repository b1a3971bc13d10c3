"""What a run leaves for people: a summary to read, pictures, and the table."""

import json
from dataclasses import replace
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.result.result import Result
from herringbone.running.summary import summary_text

_TEXT, _SUMMARY = "summary.txt", "summary.json"


def write_report(
    result: Result,
    folder: str | Path,
    *,
    parquet: bool = False,
    shown: str | Path | None = None,
) -> Result:
    """Write results.csv, pictures, summary.txt and summary.json into a folder, made if needed.

    What takes longest and is least needed comes last: the pictures. The summary is there before.

    Args:
        result: of a run.
        folder: where the files go. Those of an earlier run are replaced; what that run had and
            this one has not, such as a picture of its torques, is removed.
        parquet: write results.parquet as well.
        shown: how the folder is called in `files`; as it is if not given.

    Returns:
        The result with `files` filled in.

    Raises:
        HerringboneError: a file cannot be written.
    """
    from herringbone.plotting import PICTURES, write_pictures  # noqa: PLC0415 (matplotlib: lazy)

    folder, shown = Path(folder), Path(folder if shown is None else shown)
    names = ["results.csv", *(["results.parquet"] if parquet else []), _TEXT, _SUMMARY]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "results.parquet").unlink(missing_ok=True)
        for picture in ("overview", *PICTURES):
            for file in (folder / f"{picture}.png", *folder.glob(f"{picture}.*.png")):
                file.unlink(missing_ok=True)
        result.to_csv(folder / names[0])
        if parquet:
            result.to_parquet(folder / names[1])
        result = replace(result, files=tuple(str(shown / name) for name in names))
        write_summary(result, folder)
        pictures = write_pictures(result, folder)
    except OSError as error:
        raise _refused(error, folder) from error
    drawn = (str(shown / picture.name) for picture in pictures)
    result = replace(result, files=(*result.files, *drawn))
    write_summary(result, folder)
    return result


def write_summary(result: Result, folder: str | Path) -> None:
    """Write summary.txt and summary.json into a folder.

    Raises:
        HerringboneError: a file cannot be written.
    """
    folder = Path(folder)
    content = result.summary() | {
        "parameters": dict(result.info.parameters),
        "resources": dict(result.info.resources),
    }
    try:
        (folder / _TEXT).write_text(summary_text(result), encoding="utf-8")
        text = json.dumps(content, indent=2) + "\n"
        (folder / _SUMMARY).write_text(text, encoding="utf-8")
    except OSError as error:
        raise _refused(error, folder) from error


def _refused(error: OSError, folder: Path) -> HerringboneError:
    return HerringboneError(
        f"cannot write {error.filename or folder}: {error.strerror}; choose another folder"
    )
