r"""Load and contact pressure over the flank, from the contact lines over a mesh period.

A line load w normal to the flank presses with the largest pressure of a line contact (Hertz)

    p_H = sqrt(w E' / (pi rho)),    E' = E / (2 (1 - nu^2)),
    rho = rho_1 rho_2 / (rho_1 + rho_2) / cos(beta_b),

both gears of one material; rho_1 and rho_2 are the distances of the contact from the base tangent
points. Roughness, the film of oil and the edges of the contact are left out.

Largest values of relieved flanks do not depend on the number of slices (0.5 %). Without relief the
teeth's corners enter at full load: coupled slices show 490 to 590 MPa there, by their number (27/81
pair, 200 N m).

The map is what passes over the flank in a mesh period: the phases of the line that stands there.
"""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from herringbone.gears.geometry.gear_pair import GearPair
from herringbone.gears.stiffness.contact_slices import LineLoad

_PATHS, _FACES = 49, 48
MEANS = "means over strips of the flank"
"""What the maps show."""
_FEW = 0.4
"""Points of a strip, over the mean, that are only those of slices cut by the ends of the path."""


class LoadedLines(Protocol):
    """A mesh that knows the load on its contact lines: of every method."""

    def line_load(self, phase: float, force: float) -> LineLoad:
        """Load on the lines at a phase and a normal force [N]."""


@dataclass(frozen=True)
class FlankLoad:
    """Load on the flank of one half; the maps are means over strips, the largest values of points.

    Attributes:
        path: (m,) from the start of the path of contact, the root of the pinion's teeth [m].
        face: (k,) along the face; where face coordinates begin: `axial_position` [m].
        line_load: (m, k) normal load per length of contact line [N/m].
        pressure: (m, k) p_H [Pa].
        largest_line_load: of all points and phases [N/m].
        largest_pressure: of all points and phases [Pa].
        where: path and face of the largest pressure [m].
    """

    path: np.ndarray
    face: np.ndarray
    line_load: np.ndarray
    pressure: np.ndarray
    largest_line_load: float
    largest_pressure: float
    where: tuple[float, float]


def relative_curvature(pair: GearPair, path: np.ndarray) -> np.ndarray:
    """rho [m] of the contact, in the normal section.

    Args:
        pair: gear pair.
        path: from the start of the path of contact [m]; outside of it the value at its end.
    """
    points = pair.path_of_contact
    pinion = points.start + np.clip(path, 0.0, points.length)
    wheel = points.tangent_length - pinion
    return pinion * wheel / points.tangent_length / math.cos(pair.base_helix_angle)


def contact_pressure(pair: GearPair, path: np.ndarray, line_load: np.ndarray) -> np.ndarray:
    """p_H [Pa] of line loads [N/m] at places on the path of contact [m]."""
    modulus = 0.5 * pair.youngs_modulus / (1.0 - pair.poissons_ratio**2)
    return np.sqrt(line_load * modulus / (math.pi * relative_curvature(pair, path)))


def flank_load(
    mesh: LoadedLines, pair: GearPair, phases: np.ndarray, forces: np.ndarray
) -> FlankLoad:
    """Load on the flank of one half over a mesh period.

    Args:
        mesh: of the pair.
        pair: gear pair.
        phases: (n,) equidistant over a mesh period.
        forces: (n,) normal forces of the half [N].
    """
    at = zip(phases.tolist(), forces.tolist(), strict=True)
    lines = [mesh.line_load(phase, force) for phase, force in at]
    path, face, load = (
        np.concatenate([getattr(line, name) for line in lines]) for name in ("path", "face", "load")
    )
    pressure = contact_pressure(pair, path, load)
    worst = int(np.argmax(pressure))
    grid = np.linspace(0.0, pair.length_of_path_of_contact, _PATHS)
    columns = _columns(face / pair.face_width)
    faces = (np.arange(columns) + 0.5) * pair.face_width / columns
    table = _table(grid, _strips(path, face / pair.face_width, load, columns))
    return FlankLoad(
        grid,
        faces,
        table,
        contact_pressure(pair, grid[:, None], table),
        float(load.max()),
        float(pressure[worst]),
        (float(path[worst]), float(face[worst])),
    )


def _columns(face: np.ndarray) -> int:
    """Strips of the face (0 to 1), so many that each has points of whole slices."""
    columns = _FACES
    while columns > 1:
        count = np.bincount(_strip(face, columns), minlength=columns)
        if count.min() > _FEW * count.mean():
            break
        columns //= 2
    return columns


def _strip(face: np.ndarray, columns: int) -> np.ndarray:
    """Number of the strip that points are in."""
    return np.minimum((face * columns).astype(int), columns - 1)


def _strips(
    path: np.ndarray, face: np.ndarray, load: np.ndarray, columns: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Path and load of the points in each strip of the face, sorted by the path."""
    strip = _strip(face, columns)
    order = np.lexsort((path, strip))
    ends = np.searchsorted(strip[order], np.arange(1, columns))
    return list(zip(np.split(path[order], ends), np.split(load[order], ends), strict=True))


def _table(grid: np.ndarray, strips: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Mean load around each place of the grid, shape (m, k); linear where no point lies.

    Corners that touch outside the path of contact are not on the map.
    """
    columns = []
    for path, load in strips:
        step = grid[1] - grid[0]
        bins = np.rint(path / step).astype(int)
        on_path = (bins >= 0) & (bins < grid.size)
        count = np.bincount(bins[on_path], minlength=grid.size)
        total = np.bincount(bins[on_path], weights=load[on_path], minlength=grid.size)
        seen = count > 0
        columns.append(np.interp(grid, grid[seen], total[seen] / count[seen]))
    return np.stack(columns, axis=1)


def axial_position(pair: GearPair, side: int, face: np.ndarray) -> np.ndarray:
    """Distance [m] of face coordinates from the middle of the pair, + to the left.

    Contact lines run ahead at the end of their face coordinate: in a double-helical pair whose left
    half has a positive helix angle that is the inner end, at the gap, for the flank that carries
    when the pinion drives.

    Args:
        pair: gear pair.
        side: 0 left, 1 right.
        face: face coordinates [m].
    """
    inner = face if pair.helix_angle < 0.0 else pair.face_width - face
    sign = 1.0 if side == 0 else -1.0
    return sign * (0.5 * pair.gap_width + inner)
