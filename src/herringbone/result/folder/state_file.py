"""The file of a checkpoint: arrays by name, whole or not there."""

import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from herringbone.result.folder.names import CHECKPOINT, OLD
from herringbone.result.folder.writing import refused, replacing

_DAMAGE = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile, zlib.error)


def write_state(folder: Path, state: Mapping[str, np.ndarray]) -> None:
    """Keep a checkpoint; the one before stays as well. Raises HerringboneError."""
    file = folder / CHECKPOINT
    try:
        if file.exists():
            file.replace(folder / (CHECKPOINT + OLD))
    except OSError as error:
        raise refused(error, file) from error
    with replacing(file, text=False) as stream:
        np.savez(stream, allow_pickle=False, **state)


def read_state(folder: Path, rows: int) -> dict[str, np.ndarray] | None:
    """The last but one checkpoint, or the last one, after which there are rows to compare.

    Args:
        folder: of the run.
        rows: that are there.

    Returns:
        None if there is none, or what there is is damaged.
    """
    for name in (CHECKPOINT + OLD, CHECKPOINT):
        try:
            with np.load(folder / name, allow_pickle=False) as found:
                state = {key: found[key] for key in found.files}
            if int(state["rows"]) < rows:
                return state
        except _DAMAGE:
            continue
    return None


def remove_states(folder: Path) -> None:
    """Remove checkpoints; raises HerringboneError."""
    for name in (CHECKPOINT, CHECKPOINT + OLD):
        try:
            (folder / name).unlink()
        except FileNotFoundError:
            continue
        except OSError as error:
            raise refused(error, folder / name) from error
