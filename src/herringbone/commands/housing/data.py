"""`herringbone housing reduce` and `import`: modal data made smaller, and brought in."""

import argparse
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
from tqdm import tqdm

from herringbone.commands.housing.asked import asked_by, band_for, changes
from herringbone.commands.options import refuse_given
from herringbone.commands.output import check_writable, say, show
from herringbone.components.registry import component_for
from herringbone.core import HerringboneError
from herringbone.core.declaring.roles import Role
from herringbone.core.wording import percent
from herringbone.housing import ModalHousing, read_housing, write_housing
from herringbone.housing.files.file_format import DATA
from herringbone.housing.importers import import_housing, is_matrix
from herringbone.housing.reduction.error import check_certificate, drive_point_errors
from herringbone.housing.reduction.reduced_housing import (
    certified_bound,
    reduce_housing,
    with_residual_modes,
)

_DECADES, _POINTS = 1.3, 800
_MOST_MODES = component_for(Role.HOUSING).declaration.vectors[0].capacity


def reduce_command(options: argparse.Namespace) -> int:
    """Reduce modal data, write them with their certificate and a picture beside the full data."""
    full = read_housing(options.data)
    complete = with_residual_modes(full)
    asked = asked_by(options, complete)
    band = band_for(options, asked, full.valid_to_hz)
    stem = options.data.name.removesuffix(".zip")
    output = options.output or Path("results") / f"{stem}-{band:g}Hz"
    if output.resolve() == options.data.resolve():
        raise HerringboneError(f"-o {output} would overwrite the full data; choose another place")
    check_writable(_folder(output))
    reduced = reduce_housing(full, band_hz=band, tolerance=options.tolerance)
    certified = reduced.certificate != full.certificate
    if reduced.frequency_hz.size < full.frequency_hz.size and full.residual is None:
        of = {DATA: str(options.data.resolve())}
        reduced = replace(reduced, certificate={**reduced.certificate, **of})
    frequency_hz = band * np.logspace(-_DECADES, 0.0, _POINTS)
    errors = drive_point_errors(complete, reduced, frequency_hz)
    if certified:
        check_certificate(reduced, band, float(errors.max()))
    static = np.diag(complete.static_compliance())
    difference = float(np.abs(np.diag(reduced.static_compliance()) / static - 1.0).max())
    _write(reduced, output)
    picture = _folder(output) / f"{output.name.removesuffix('.zip')}.png"
    _draw(complete, reduced, frequency_hz, errors, picture)
    figures = {
        "oscillators": reduced.frequency_hz.size,
        "normal_modes": reduced.kind.count("normal"),
        "residual_modes": reduced.kind.count("residual"),
        "full_oscillators": full.frequency_hz.size,
        "pseudo_modes_of_residual": complete.frequency_hz.size - full.frequency_hz.size,
        "band_hz": band,
        "tolerance": options.tolerance,
        "error_bound": _bound(reduced, band),
        "certified": certified,
        "error_against_data": float(errors.max()),
        "static_difference": difference,
        "files": [str(output), str(picture)],
    }
    if asked is not None:
        figures["changes"] = changes(asked, reduced)
    show(json.dumps(figures) if options.json else _text(figures))
    return 0


def _bound(housing: ModalHousing, band: float) -> float | None:
    """Certified error bound up to a band [Hz]; None if the data have no certificate."""
    certified = housing.certificate.get("error_bound") is not None
    return certified_bound(housing, band) if certified else None


def _text(figures: dict) -> str:
    before, after = figures["full_oscillators"], figures["oscillators"]
    pseudo, bound = figures["pseudo_modes_of_residual"], figures["error_bound"]
    counts = f"{figures['normal_modes']} normal and {figures['residual_modes']} residual modes"
    if figures["certified"]:
        lines = [
            f"{before} oscillators became {after}: {counts}",
            f"Receptance at the seats up to {figures['band_hz']:g} Hz: error certified below "
            f"{percent(bound)} of the static compliance (tolerance "
            f"{100 * figures['tolerance']:g} %), {percent(figures['error_against_data'])} "
            "against the data",
            f"Static compliance at the seats differs by {figures['static_difference']:.1e}",
        ]
        if pseudo:
            lines[1] += f", whose residual matrix counts as {pseudo} pseudo modes"
    else:
        lines = [f"All {before} oscillators, {counts}, are needed to {figures['band_hz']:g} Hz"]
        if pseudo:
            lines[0] = (
                f"All {before} oscillators are needed to {figures['band_hz']:g} Hz; with {pseudo} "
                f"pseudo modes of the residual matrix there are {after}: {counts}"
            )
        if bound:
            lines[0] += f"; certified before to {percent(bound)}"
        elif pseudo:
            lines.append("Nothing is certified; the static compliance is that of the data")
    lines += [
        f"{name}: changed by {percent(found['error'])}, worst output {found['worst']}: "
        f"{percent(found['worst_error'])}"
        for name, found in figures.get("changes", {}).items()
    ]
    return "\n".join([*lines, "Files: " + ", ".join(figures["files"])])


def _draw(
    full: ModalHousing,
    reduced: ModalHousing,
    frequency_hz: np.ndarray,
    errors: np.ndarray,
    file: Path,
) -> None:
    from herringbone.plotting.housing_reduction import reduction_picture  # noqa: PLC0415 (lazy)

    picture = reduction_picture(
        frequency_hz,
        full.receptance(frequency_hz),
        reduced.receptance(frequency_hz),
        (full.static_compliance(), reduced.static_compliance()),
        errors,
        certified_bound(reduced, float(frequency_hz[-1])),
        (full.frequency_hz.size, reduced.frequency_hz.size),
    )
    try:
        picture.savefig(file)
    except OSError as error:
        raise HerringboneError(f"cannot write {file}: {error.strerror}") from error


def import_command(options: argparse.Namespace) -> int:
    """Import a housing of another program, write it in the neutral format."""
    output = options.output or Path("results") / options.file[0].stem
    if not is_matrix(options.file[0]):
        why = (
            f"of matrices, which are reduced; modes, as those of {options.file[0]}, are taken as "
            "they are, good to valid_to_hz of the seat file"
        )
        refuse_given(options, ("band", "tolerance"), why)
    check_writable(_folder(output))
    with tqdm(disable=None, bar_format="[{elapsed}] {desc}") as bar:
        housing = import_housing(
            options.file,
            options.seats,
            band_hz=options.band,
            tolerance=options.tolerance,
            most_modes=_MOST_MODES,
            progress=bar.set_description_str,
        )
    _write(housing, output)
    compliance = np.diag(housing.static_compliance()).tolist()
    figures = {
        "oscillators": housing.frequency_hz.size,
        "normal_modes": housing.kind.count("normal"),
        "frequency_hz": housing.frequency_hz[:8].tolist(),
        "static_stiffness_N_per_um": [1e-6 / c if c > 0.0 else None for c in compliance],
        "valid_to_hz": housing.valid_to_hz,
        "error_bound": housing.certificate.get("error_bound"),
        "files": [str(output)],
    }
    show(json.dumps(figures) if options.json else _import_text(figures))
    return 0


def _import_text(figures: dict) -> str:
    bound = figures["error_bound"]
    certified = "" if bound is None else f", error certified below {percent(bound)}"
    return "\n".join([
        f"{figures['oscillators']} oscillators, {figures['normal_modes']} of them normal modes, "
        f"good to {figures['valid_to_hz']:g} Hz{certified}",
        "Lowest [Hz]: " + ", ".join(f"{f:.2f}" for f in figures["frequency_hz"]),
        "Static stiffness x, y, z of each seat [N/um]: "
        + ", ".join(
            "none" if k is None else f"{k:.0f}" for k in figures["static_stiffness_N_per_um"]
        ),
        "Files: " + ", ".join(figures["files"]),
    ])  # fmt: skip


def _folder(output: Path) -> Path:
    return output.parent if output.suffix == ".zip" else output


def _write(housing: ModalHousing, output: Path) -> None:
    for warning in write_housing(housing, output):
        say(f"herringbone: note: {warning}")
    if housing.frequency_hz.size > _MOST_MODES:
        say(
            f"herringbone: note: {housing.frequency_hz.size} oscillators; the component takes "
            f"{_MOST_MODES}: lower --band or raise --tolerance of 'herringbone housing reduce'"
        )
