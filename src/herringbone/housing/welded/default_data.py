"""Makes the data set of the shipped housing and its record HOUSING.md.

`python -m herringbone.housing.welded.default_data` takes some five minutes and 4 GB.

The published model (thesis, table 4.2) has four frequencies with labels; neither dimensions nor
shapes are published. The set thesis_modes.csv, thesis_shapes.csv is what the thesis used: the four
published frequencies, here with the first four shapes of the calibrated housing.
"""

import sys
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role
from herringbone.core.wording import percent
from herringbone.housing import ModalHousing, write_housing
from herringbone.housing.eigenmodes import eigenmodes
from herringbone.housing.welded.build import BuiltHousing, build_housing
from herringbone.housing.welded.design import HousingDesign, read_design
from herringbone.housing.welded.mesher import mesh_housing
from herringbone.housing.welded.mode_shares import ModeShares
from herringbone.housing.welded.published import PUBLISHED

COMPONENT = component_for(Role.HOUSING)
DESIGN = COMPONENT.folder / "welded_housing.toml"
RECORD = COMPONENT.folder / "HOUSING.md"
FOUND = (
    "axial sway: agrees",
    "lateral rocking, no twist: differs",
    "vertical bounce on the bending base plate: agrees in substance",
    "yaw, no axial sway: half agrees (it twists about y)",
)
"""What these modes do here, against the labels; see the shares."""
MESH_SIZES = (0.060, 0.042, 0.030, 0.022, 0.016, 0.012)
"""Of the convergence table [m]."""
_WIDTH = 100
_THESIS_NOTE = """\
# The four modes that the thesis used, at its published frequencies (table 4.2).
# Shapes: the first four normal modes of the calibrated housing, since none are published. Damping:
# assumed, 1 %. Static compliance at the seats is far too low: for comparison only.
"""


def main() -> None:
    """Make all files."""
    design = read_design(DESIGN)
    folder = COMPONENT.resources
    built = build_housing(design, progress=_say)
    write_housing(built.model, folder)
    write_thesis_modes(built.model, folder)
    rows = list(convergence(design, MESH_SIZES))
    RECORD.write_text(record(design, built, rows), encoding="utf-8")


def _say(text: str) -> None:
    sys.stderr.write(text + "\n")


def write_thesis_modes(housing: ModalHousing, folder: Path) -> None:
    """Write the thesis' set of four modes."""
    count = len(PUBLISHED)
    modes = [f"{n},normal,{f!r},0.01\n" for n, (f, _) in enumerate(PUBLISHED, 1)]
    (folder / "thesis_modes.csv").write_text(
        "# units: mode 1, frequency_hz Hz, damping_ratio 1\n" + _THESIS_NOTE
        + "mode,kind,frequency_hz,damping_ratio\n" + "".join(modes), encoding="utf-8",
    )  # fmt: skip
    rows = [
        ",".join([point, dof, *(repr(float(v)) for v in row[:count])]) + "\n"
        for (point, dof), row in zip(housing.dofs, housing.shapes, strict=True)
    ]
    (folder / "thesis_shapes.csv").write_text(
        "# units: shape kg^-1/2\n" + _THESIS_NOTE
        + ",".join(["point", "dof", *(f"m{n + 1}" for n in range(count))]) + "\n"
        + "".join(rows), encoding="utf-8",
    )  # fmt: skip


def convergence(
    design: HousingDesign, sizes: Iterable[float]
) -> Iterator[tuple[float, int, np.ndarray]]:
    """Mesh size [m], number of unknowns and the first four frequencies (4,) [Hz]."""
    from herringbone.housing.welded.finite_elements import FiniteElements  # noqa: PLC0415 (optional)

    for size in sizes:
        _say(f"mesh of {1e3 * size:g} mm")
        model = FiniteElements(
            replace(design, mesh_size=size), mesh_housing(design.dimensions, size)
        )
        modes = eigenmodes(model.stiffness, model.mass, len(PUBLISHED))
        yield size, model.stiffness.shape[0], modes.frequency_hz


def record(
    design: HousingDesign, built: BuiltHousing, rows: Sequence[tuple[float, int, np.ndarray]]
) -> str:
    """The text of HOUSING.md."""
    model, certificate = built.model, built.model.certificate
    options, size = design.modes, f"{1e3 * design.mesh_size:g} mm"
    normal = model.kind.count("normal")
    stiffness = 1e-6 / np.diag(np.asarray(model.static)).reshape(4, 3)
    sections = [
        "# The default housing",
        "This file is made by `python -m herringbone.housing.welded.default_data`, as are the data "
        "in `resources`. The dimensions are in `welded_housing.toml`; `herringbone housing build` "
        "makes the data from them.",
        "A welded housing of steel plates, **calibrated to the published frequencies**. The source "
        "gives four frequencies and labels, but no dimension: other housings have the same four "
        f"frequencies, and this one is not the housing of the source. {built.mass:.1f} kg; faces "
        "of the base bolt holes held; flange halves bonded; no shafts, no oil. Quadratic "
        f"tetrahedra of {size}, {built.unknowns} unknowns. Damping is assumed: "
        f"{options.damping_ratio:g} for normal modes, {options.residual_damping_ratio:g} for "
        "residual ones.",
        f"{normal} free-interface normal modes and {len(model.kind) - normal} residual attachment "
        f"modes. The receptance at the seats is certified up to {certificate['band_hz']:g} Hz: its "
        "error against the finite elements is below "
        f"{percent(certificate['error_bound'])} of the static compliance; statics are exact.",
        "## Frequencies and labels",
        _frequencies(built.shares),
        "The labels do not follow from the frequencies. A rigid box on springs that sways along "
        "the shafts at 248 Hz and rolls with axial sway at 621 Hz would have to be wider and "
        "lower, or be held nearer to the shafts.",
        "Shares of the kinetic energy (T: rigid translation, R: rigid rotation of the box above "
        "the base plate, about x toward the wheel, y up, z along the shafts) and of the strain "
        "energy, in %:",
        _shares(built.shares),
        "## Static stiffness at the seats [N/um]",
        _markdown(
            ["seat", "x", "y", "z"],
            [
                [name, *(f"{k:.0f}" for k in row)]
                for name, row in zip(model.seats, stiffness, strict=True)
            ],
        ),
        "The seat's force is a uniform traction over the bore. Spread over 120 degrees of it, the "
        "stiffness would be up to some 13 % less, which is more than the reduction leaves out.",
        "## Convergence",
        _markdown(
            ["mesh size [mm]", "unknowns", *(f"mode {n + 1} [Hz]" for n in range(len(PUBLISHED)))],
            [
                [f"{1e3 * size:g}", str(unknowns), *(f"{f:.2f}" for f in frequencies)]
                for size, unknowns, frequencies in rows
            ],
        ),
        "The rims of the held bolt holes are singular, hence the slow convergence; the dimensions "
        f"are calibrated at {size}.",
    ]
    return "\n\n".join(map(_wrapped, sections)) + "\n"


def _wrapped(text: str) -> str:
    return text if text.startswith("|") else textwrap.fill(text, _WIDTH, break_on_hyphens=False)


def _markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _frequencies(shares: ModeShares) -> str:
    rows = [
        [str(n), f"{f:.2f}", label, f"{own:.2f}", f"{100 * (own / f - 1):+.2f}", found]
        for n, ((f, label), own, found) in enumerate(
            zip(PUBLISHED, shares.frequency_hz, FOUND, strict=False), 1
        )
    ]
    return _markdown(["mode", "published [Hz]", "label", "here [Hz]", "%", "what it does"], rows)


def _shares(shares: ModeShares) -> str:
    head = [
        "Hz",
        *shares.motions,
        "elastic",
        "base plate",
        *(f"strain: {p}" for p in shares.strain),
    ]
    columns = [*shares.rigid.T, shares.elastic, shares.base, *shares.strain.values()]
    rows = [
        [f"{f:.1f}", *(f"{100 * column[k]:.0f}" for column in columns)]
        for k, f in enumerate(shares.frequency_hz)
    ]
    return _markdown(head, rows)


if __name__ == "__main__":
    main()
