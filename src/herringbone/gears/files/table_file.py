"""Writer of the stiffness table that the component of a gear pair reads."""

import math
from pathlib import Path

from herringbone.core import HerringboneError
from herringbone.core.declaring.roles import SIDES
from herringbone.core.places.files import write_whole
from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.mesh_stiffness import MeshStiffness


def table_text(stiffness: MeshStiffness) -> str:
    """The table as CSV (grammar: `components.resources.stiffness_table`), origin in comments."""
    lines = [
        "# units: load N, phase 1, stiffness N/m",
        f"# pair: {fingerprint(stiffness.pair)}",
        *_uncertainty(stiffness),
        *(f"# {line}" for line in origin(stiffness)),
    ]
    lines.append("side,load,phase,stiffness")
    for side in SIDES:
        for load, row in zip(stiffness.loads, stiffness.secant, strict=True):
            lines += [
                f"{side},{load:.6f},{phase:.6f},{value:.7e}"
                for phase, value in zip(stiffness.phases, row, strict=True)
            ]
    return "\n".join(lines) + "\n"


def fingerprint(pair: GearPair) -> str:
    """Whose table it is: teeth, base radii [m], base helix angle [rad], face width [m]."""
    lengths = (*pair.base_radius, abs(pair.base_helix_angle), pair.face_width)
    numbers = (*pair.number_of_teeth, *(f"{x:.10g}" for x in lengths))
    return " ".join(map(str, numbers))


def origin(stiffness: MeshStiffness) -> list[str]:
    """What the table is of, and how it was computed."""
    pair, modification = stiffness.pair, stiffness.modification
    z1, z2 = pair.number_of_teeth
    x1, x2 = pair.profile_shift_coefficient
    relief = " and ".join(f"{1e6 * amount:g}" for amount in modification.tip_relief)
    return [
        "Secant stiffness (force / deflection, normal to the flank) of one half over its own normal"
        " force; both halves have the same.",
        f"Pair: z {z1}/{z2}, m_n {1e3 * pair.normal_module:g} mm, alpha_n "
        f"{math.degrees(pair.normal_pressure_angle):g} deg, beta "
        f"{math.degrees(pair.helix_angle):g} deg, x {x1:.4g}/{x2:.4g}, a "
        f"{1e3 * pair.center_distance:.4f} mm, b {1e3 * pair.face_width:g} mm per half.",
        f"Tip relief of pinion and wheel {relief} um over {1e3 * modification.relief_length:g} mm, "
        f"helix crowning {1e6 * modification.helix_crowning:g} um.",
        f"Method: {stiffness.method}.",
    ]


def _uncertainty(stiffness: MeshStiffness) -> list[str]:
    """How far the table may be from finite elements without limit of resolution."""
    bounds = stiffness.uncertainty
    if bounds is None:
        return []
    numbers = (bounds.mean, *bounds.harmonics.max(axis=0))
    return [
        f"# uncertainty: {' '.join(f'{value:.2g}' for value in numbers)}",
        "# Uncertainty: of the mean, and at most of mesh harmonics 1 to "
        f"{bounds.harmonics.shape[1]}, over the mean, against finite elements refined without end.",
    ]


def write_table(stiffness: MeshStiffness, file: str | Path) -> None:
    """Write the table.

    Raises:
        HerringboneError: the file cannot be written.
    """
    try:
        write_whole(Path(file), table_text(stiffness))
    except OSError as error:
        raise HerringboneError(f"cannot write {file}: {error.strerror}") from error
