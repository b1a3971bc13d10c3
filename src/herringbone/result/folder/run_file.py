"""`run.json`: how far a folder is, its columns, how it was asked for, and its result."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from herringbone.core import ResourceError
from herringbone.result.folder.formatted import read_formatted
from herringbone.result.folder.names import FORMAT, RUN, State
from herringbone.result.folder.typed import as_json, from_json
from herringbone.result.folder.writing import write_text


@dataclass(frozen=True)
class RunFile:
    """What stands in `run.json`.

    Attributes:
        state: how far the folder is.
        columns: of `results.npy`, the time first.
        units: unit by column.
        others: types of the columns of `others.jsonl`, as NumPy calls them, by name.
        key: of the run's settings, see `running.output.settings`; "" if they are not known.
        settings: digests by name, which make the key; they tell what is different.
        asked: options of the command, for `--resume`.
        folder: in which the command was given.
        result: all about the result but its rows, as `typed.as_json` has it.
        format: version of the folder.
    """

    state: State
    columns: tuple[str, ...]
    units: Mapping[str, str]
    others: Mapping[str, str] = field(default_factory=dict)
    key: str = ""
    settings: Mapping[str, str] = field(default_factory=dict)
    asked: Mapping[str, Any] = field(default_factory=dict)
    folder: str = ""
    result: Mapping[str, Any] = field(default_factory=dict)
    format: int = FORMAT


def write_run_file(folder: Path, content: RunFile) -> None:
    """Write `run.json`; raises HerringboneError."""
    write_text(folder / RUN, json.dumps(as_json(content), indent=1, ensure_ascii=False) + "\n")


def read_run_file(folder: Path) -> RunFile | None:
    """What stands in `run.json`; None if there is none.

    Raises:
        ResourceError: it cannot be read, or is of a later format.
    """
    file = folder / RUN
    found = read_formatted(file, FORMAT)
    if found is None:
        return None
    try:
        return from_json(RunFile, found)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise ResourceError(f"{file} is damaged: {error}") from error
