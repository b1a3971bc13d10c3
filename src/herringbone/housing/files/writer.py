"""Writer of the neutral format, see `file_format`."""

import json
import os
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.components.resources.flat_csv_text import flat_csv_text
from herringbone.core import ResourceError
from herringbone.housing.files.file_format import (
    COMPLIANCES,
    FORMAT,
    GRAM,
    HEAD,
    MODES,
    OPTIONAL,
    SEAT_COLUMNS,
    SHAPES,
    UNITS,
    VERSION,
    digest,
)
from herringbone.housing.files.validation import check_housing, housing_warnings
from herringbone.housing.modal_model import SEAT_DOFS, ModalHousing


def write_housing(housing: ModalHousing, path: str | Path) -> list[str]:
    """Check and write a modal model; other files of an existing folder stay.

    Every file appears whole or not at all, housing.json last: an interrupted write is recognised
    by its hashes.

    Args:
        housing: the model.
        path: folder, or file that ends in .zip.

    Returns:
        What is doubtful about the model, one line each.

    Raises:
        ResourceError: refused by `check_housing`, or not writable; nothing has been written.
    """
    path = Path(path)
    check_housing(housing, path)
    files = _texts(housing)
    try:
        if path.suffix == ".zip":
            _write_zip(files, path)
        else:
            _write_folder(files, path)
    except OSError as error:
        raise ResourceError(f"cannot write {path}: {error.strerror or error}") from error
    return housing_warnings(housing)


def _write_zip(files: Mapping[str, str], path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        part = Path(scratch, path.name)
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, text in files.items():
                archive.writestr(name, text)
        os.replace(part, path)  # noqa: PTH105 (atomic on all platforms)


def _write_folder(files: Mapping[str, str], path: Path) -> None:
    path.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path) as scratch:
        for name, text in files.items():
            Path(scratch, name).write_text(text, encoding="utf-8", newline="\n")
        for name in files:
            os.replace(Path(scratch, name), path / name)  # noqa: PTH105 (atomic on all platforms)
    for name in OPTIONAL:
        if name not in files:
            (path / name).unlink(missing_ok=True)


def _texts(housing: ModalHousing) -> dict[str, str]:
    """Contents by file name, housing.json last."""
    files = {MODES: _modes_text(housing), SHAPES: _shapes_text(housing)}
    for attribute, name in COMPLIANCES.items():
        if (matrix := getattr(housing, attribute)) is not None:
            files[name] = compliance_text(matrix)
    if housing.gram is not None:
        files[GRAM] = flat_csv_text(
            "mode 1, gram kg^-1.m2",
            ("mode", *_mode_names(housing)),
            ((n, *row) for n, row in enumerate(housing.gram, 1)),
        )
    files[HEAD] = json.dumps(_head(housing, files), indent=1, ensure_ascii=False) + "\n"
    return files


def compliance_text(matrix: np.ndarray) -> str:
    """A matrix (12, 12) of static or residual compliance [m/N] as the text of its file."""
    return flat_csv_text(
        "compliance m/N",
        ("point", "dof", *SEAT_COLUMNS),
        ((*dof, *row) for dof, row in zip(SEAT_DOFS, matrix, strict=True)),
    )


def _mode_names(housing: ModalHousing) -> list[str]:
    return [f"m{n}" for n in range(1, housing.frequency_hz.size + 1)]


def _modes_text(housing: ModalHousing) -> str:
    modes = zip(housing.kind, housing.frequency_hz, housing.damping_ratio, strict=True)
    return flat_csv_text(
        "mode 1, frequency_hz Hz, damping_ratio 1",
        ("mode", "kind", "frequency_hz", "damping_ratio"),
        ((n, *mode) for n, mode in enumerate(modes, 1)),
    )


def _shapes_text(housing: ModalHousing) -> str:
    return flat_csv_text(
        "shape kg^-1/2",
        ("point", "dof", *_mode_names(housing)),
        ((*dof, *row) for dof, row in zip(housing.dofs, housing.shapes, strict=True)),
    )


def _head(housing: ModalHousing, files: Mapping[str, str]) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "version": VERSION,
        "units": UNITS,
        "frame": asdict(housing.frame),
        "normalisation": "mass",
        "boundary": housing.boundary,
        "damping": dict(housing.damping),
        "valid_to_hz": housing.valid_to_hz,
        "points": [asdict(point) for point in housing.points],
        "source": dict(housing.source),
        "certificate": dict(housing.certificate),
        "sha256": {name: digest(text.encode()) for name, text in files.items()},
    }
