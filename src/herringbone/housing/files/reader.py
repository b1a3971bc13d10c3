"""Reader of the neutral format, see `file_format`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from herringbone.components.resources.flat_csv import read_flat_csv
from herringbone.components.resources.modal_data import (
    check_mode_columns,
    read_mode_table,
    read_shape_table,
)
from herringbone.core import ResourceError
from herringbone.core.places.files import is_folder
from herringbone.core.reading.archives import open_archive
from herringbone.core.reading.structured import read_json
from herringbone.core.reading.texts import AnyPath, read_bytes
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
from herringbone.housing.files.validation import check_housing
from herringbone.housing.modal_model import SEAT_DOFS, Frame, ModalHousing, Point

_NOTES = ("source", "certificate")


def read_housing(path: str | Path) -> ModalHousing:
    """Read and check a modal model.

    Args:
        path: folder or .zip file.

    Raises:
        ResourceError: a file is missing, malformed or not the one that was hashed, or the model is
            refused by `check_housing`.
    """
    path = Path(path)
    if is_folder(path):
        return _read(path, path)
    with open_archive(path, "a folder or a readable zip file") as archive:
        return _read(archive.root, path)


def _read(root: AnyPath, path: Path) -> ModalHousing:
    """The model whose files lie in a folder, or in an archive."""
    head = read_json(root / HEAD)
    try:
        _check_head(head)
        points = tuple(_point(item) for item in _field(head, "points", list))
        frame = _frame(head.get("frame", {}))
        hashes = _field(head, "sha256", dict)
        valid_to_hz = float(_field(head, "valid_to_hz", (int, float)))
        damping = _field(head, "damping", dict)
        source, certificate = (_field({name: {}} | head, name, dict) for name in _NOTES)
        _check_certificate(certificate)
    except ResourceError as error:
        raise ResourceError(f"{root / HEAD}: {error}") from None
    _check_hashes(root, hashes)
    kind, frequency_hz, damping_ratio = read_mode_table(root / MODES)
    rows, values = read_shape_table(root / SHAPES)
    housing = ModalHousing(
        kind,
        frequency_hz,
        damping_ratio,
        points,
        _in_order(rows, values, points, root),
        valid_to_hz,
        damping,
        str(head.get("boundary", "")),
        source,
        frame,
        **{name: _optional_compliance(root / file, hashes) for name, file in COMPLIANCES.items()},
        gram=_read_gram(root / GRAM, hashes),
        certificate=certificate,
    )
    check_housing(housing, path)
    return housing


def _field(head: Mapping[str, Any], name: str, kind: type | tuple[type, ...]) -> Any:  # noqa: ANN401
    if name not in head:
        raise ResourceError(f"'{name}' is missing")
    if not isinstance(head[name], kind) or isinstance(head[name], bool):
        raise ResourceError(f"'{name}' = {head[name]!r} has the wrong type")
    return head[name]


def _check_head(head: Mapping[str, Any]) -> None:
    if head.get("format") != FORMAT or head.get("version") != VERSION:
        raise ResourceError(
            f"format '{head.get('format')}', version '{head.get('version')}'; "
            f"'{FORMAT}', version '{VERSION}' is read"
        )
    units = _field(head, "units", dict)
    for quantity, unit in UNITS.items():
        if units.get(quantity) != unit:
            raise ResourceError(f"unit of {quantity} is '{units.get(quantity)}'; it must be {unit}")
    if head.get("normalisation") != "mass":
        raise ResourceError(
            f"normalisation '{head.get('normalisation')}'; only mass-normalised shapes ('mass') "
            "have a scale; unscaled ones, as from operational modal analysis, cannot be used"
        )


def _check_certificate(certificate: Mapping[str, Any]) -> None:
    for name in ("error_bound", "band_hz", "next_frequency_hz"):
        value = certificate.get(name)
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if value is not None and not (number and value >= 0.0):
            raise ResourceError(f"'certificate' has {name} = {value!r}; it must be a number")
    if certificate.get("error_bound") and not certificate.get("band_hz"):
        raise ResourceError("'certificate' has an error_bound without band_hz")


def _point(item: object) -> Point:
    if not isinstance(item, dict):
        raise ResourceError(f"point {item!r} must be an object")
    try:
        position: Any = tuple(float(x) for x in item.get("position", (0.0, 0.0, 0.0)))
        dofs = tuple(map(str, _field(item, "dofs", list)))
        area = float(item.get("area", 0.0))
    except (TypeError, ValueError):
        raise ResourceError(
            f"point {item.get('name')}: position and area must be numbers"
        ) from None
    return Point(
        str(_field(item, "name", str)),
        str(_field(item, "role", str)),
        position,
        dofs,
        str(item.get("coupling", "rbe3")),
        area,
    )


def _frame(item: Mapping[str, Any]) -> Frame:
    default = Frame()
    try:
        origin: Any = tuple(float(x) for x in item.get("origin", default.origin))
        rows = item.get("rotation", default.rotation)
        rotation: Any = tuple(tuple(float(x) for x in row) for row in rows)
        return Frame(origin, rotation)
    except (AttributeError, TypeError, ValueError):
        raise ResourceError("'frame' needs origin (3 numbers) and rotation (3 x 3)") from None


def _check_hashes(root: AnyPath, hashes: Mapping[str, str]) -> None:
    for name in (MODES, SHAPES):
        if name not in hashes:
            raise ResourceError(f"{root / HEAD}: 'sha256' lacks {name}")
    for name, expected in hashes.items():
        if name not in {MODES, SHAPES, *OPTIONAL}:
            raise ResourceError(f"{root / HEAD}: 'sha256' names the unknown file {name}")
        found = digest(read_bytes(root / name))
        if found != expected:
            raise ResourceError(
                f"{root / name} is not the file that housing.json describes: its SHA-256 is "
                f"{found[:12]}..., not {str(expected)[:12]}...; write both again"
            )


def _in_order(
    rows: tuple[tuple[str, str], ...],
    values: np.ndarray,
    points: tuple[Point, ...],
    root: AnyPath,
) -> np.ndarray:
    wanted = [(point.name, dof) for point in points for dof in point.dofs]
    where = {row: i for i, row in enumerate(rows)}
    if missing := [" ".join(dof) for dof in wanted if dof not in where]:
        raise ResourceError(f"{root / SHAPES}: rows are missing for {', '.join(missing)}")
    if extra := [" ".join(row) for row in rows if row not in wanted]:
        raise ResourceError(
            f"{root / SHAPES}: rows {', '.join(extra)} belong to no point of housing.json"
        )
    return values[[where[dof] for dof in wanted]]


def _optional_compliance(file: AnyPath, hashes: Mapping[str, str]) -> np.ndarray | None:
    return read_compliance(file) if file.name in hashes else None


def read_compliance(file: AnyPath) -> np.ndarray:
    """Read a matrix (12, 12) of static or residual compliance [m/N]; raises ResourceError."""
    table, units = read_flat_csv(file, ("point", "dof"), {}, more="compliance")
    if units.get("compliance") != "m/N":
        raise ResourceError(f"{file}: unit '{units.get('compliance', 'none')}'; it must be m/N")
    rows = list(zip(table["point"], table["dof"], strict=True))
    if rows != list(SEAT_DOFS) or tuple(table)[2:] != SEAT_COLUMNS:
        raise ResourceError(f"{file}: rows and columns must be {', '.join(SEAT_COLUMNS)}")
    return np.column_stack([table[name] for name in SEAT_COLUMNS])


def _read_gram(file: AnyPath, hashes: Mapping[str, str]) -> np.ndarray | None:
    if file.name not in hashes:
        return None
    table, units = read_flat_csv(file, (), {"mode": ("1",)}, more="gram")
    if units.get("gram") != "kg^-1.m2":
        raise ResourceError(f"{file}: unit '{units.get('gram', 'none')}'; it must be kg^-1.m2")
    numbers = table.pop("mode")
    check_mode_columns(list(table), file)
    if (numbers != np.arange(1, numbers.size + 1)).any():
        raise ResourceError(f"{file}: give rows in the order of mode 1, 2, ...")
    return np.column_stack(list(table.values()))
