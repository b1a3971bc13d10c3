r"""Compliance of a tooth at its candidate contact points, without the local deformation.

Unit loads act along the flank's normal at a grid of points: stations of the path of contact in
every section of the mesh.  The displacement under a concentrated load has no limit as a mesh is
refined, so each deflection is measured at a depth: where the line of the load, in the transverse
section, meets the axis of the tooth.  There it converges.  The rest, between flank and depth, is
the local deformation of a line contact, and has a closed form (see
`herringbone.gears.stiffness.slices`; C. Weber, The deflection of loaded gears, DSIR Report 3,
1949).

Loads at the flank and measures at the depth are different functionals, so their matrix is symmetric
up to the local field only: by 4 % of the largest entry for a spur gear, by 13 % at a helix of 30
degrees.  The symmetric part is kept, as a compliance has to be (Betti).

The closed form is that of a half-space, while a tooth is twice as thick as its depth: against
plane-strain elements that resolve the contact's pressure (FZG C gears, 200 N/mm, ten contacts from
root to tip) the deflection of one tooth comes out 1 to 2 % too small.

What mesh, contact and phases leave (27/81 pair, m_n 3.5 mm, 30 deg, b 47.3 mm; secant stiffness at
2252 N per half, 200 N m, and ten times as much; last column: largest difference of harmonics above
the tenth, of the mean), see `finite_elements.convergence`:

    default (8 x 3 x 2, 23 layers, 120 points) against   mean %    H1    H2    H3    H4 %   above %
    46 layers                                  200 N m     0.24   0.43  0.44  0.20  0.22     0.009
                                              2000 N m     0.27   0.76  0.90  0.35  1.35     0.012
    128 phases                                2000 N m     0.00   0.00  0.03  0.01  0.07     0.004
    240 points across the face                2000 N m     0.00  -0.04 -0.22  0.07  0.42     0.000
    480 points across the face                2000 N m    -0.01  -0.04 -0.23  0.05  0.33     0.001
    twice the elements in the section, both of 6 layers:
                                               200 N m     0.43   0.34  0.53  0.00  0.57     0.000
                                              2000 N m     0.47   0.40  0.71  0.15  1.62     0.000

What that changes in the bearing forces of the test rig (rms of the alternating part, 200 N m; see
`herringbone.benchmarks.table_refinement`):

    default against                    800     1000     1200     1500 r/min
    46 layers                         0.16     0.09     0.10     0.27 %
    128 phases                        0.02     0.01     0.01     0.02 %
    240 points across the face       -0.06     0.05     0.02    -0.13 %
    480 points across the face       -0.06     0.04     0.01    -0.14 %

With half of the layers the mean moves by twice as much (0.43 %, then 0.24 %): the layers' error is
of first order, that of the whole mesh about 1.3 %.  Harmonics above the tenth are there (0.07 %, at
the eleventh): a line without corner contact enters at once.

Twice the stations change the mean by 0.01 %.  The body is a full ring, held at the hub radius: a
sector held at its cut sides depends on where it is cut (k +25 to +50 % for 3 to 5 teeth).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from herringbone.gears.finite_elements.blocks import Profile, Resolution
from herringbone.gears.finite_elements.dissection import stack_compliance
from herringbone.gears.finite_elements.layer import layer_stiffness
from herringbone.gears.finite_elements.section import Section, mesh_section
from herringbone.gears.finite_elements.unit_loads import sweep_lead, unit_loads
from herringbone.gears.geometry.gear_pair import GearPair

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

STATIONS = 9
"""Candidate points along the path of contact."""
UNKNOWNS = 100_000
"""Degrees of freedom of one gear that the default number of layers does not exceed."""
_LAYER = 0.6
"""Default thickness of a layer, in normal modules."""
_FEWEST_LAYERS = 8


@dataclass(frozen=True)
class ToothCompliance:
    """Compliance of one tooth under normal forces on its flank.

    Attributes:
        path: stations, distances from the start of the path of contact, shape (s,) [m].
        face: sections, positions along the face width, shape (k,) [m].
        matrices: deflection of a point (rows) of the tooth q places ahead under a unit force at a
            point (columns), station fastest, shape (q, k s, k s) [m/N].
        asymmetry: largest difference that was removed to make it symmetric, over the largest entry.
        unknowns: degrees of freedom of the mesh.
    """

    path: np.ndarray
    face: np.ndarray
    matrices: np.ndarray
    asymmetry: float
    unknowns: int

    def weights(self, path: np.ndarray, face: np.ndarray) -> np.ndarray:
        """Weights of the stations in any points: cubic along the path, linear along the face.

        Args:
            path: positions on the path of contact, shape (n,) [m].
            face: positions along the face width, shape (n,) [m].

        Returns:
            Shape (n, k s) [1].
        """
        layer = self.face[1] - self.face[0]
        below = np.clip((face / layer).astype(int), 0, self.face.size - 2)
        share = face / layer - below
        along = self._splines(path)
        weights = np.zeros((path.size, self.face.size, self.path.size))
        rows = np.arange(path.size)
        weights[rows, below] = (1.0 - share)[:, None] * along
        weights[rows, below + 1] = share[:, None] * along
        return weights.reshape(path.size, -1)

    @cached_property
    def _splines(self) -> "CubicSpline":
        from scipy.interpolate import CubicSpline  # noqa: PLC0415 (lazy)

        return CubicSpline(self.path, np.eye(self.path.size))


def layer_count(pair: GearPair, resolution: Resolution, section: Section) -> int:
    """Layers along the face width.

    As given, or one per 0.6 normal modules, at least 8, at most 100 000 degrees of freedom.
    """
    if resolution.layers is not None:
        return resolution.layers
    wanted = max(_FEWEST_LAYERS, round(pair.face_width / (_LAYER * pair.normal_module)))
    edge, corner = (np.setdiff1d(nodes, section.bore).size for nodes in _serendipity(section))
    return min(wanted, int((UNKNOWNS - 3 * edge) / (3 * (edge + corner))))


def _serendipity(section: Section) -> tuple[np.ndarray, np.ndarray]:
    """Nodes of the section that carry unknowns in it, and halfway to the next section."""
    corners = section.nodes[:, ::2, ::2]
    edges = np.r_[section.nodes[:, 1, ::2].ravel(), section.nodes[:, ::2, 1].ravel()]
    return np.r_[corners.ravel(), edges], corners


def teeth_ahead(pair: GearPair) -> int:
    """Largest distance of two teeth in contact at the same time, in pitches."""
    return math.floor(pair.total_contact_ratio)


def tooth_mesh(pair: GearPair, gear: int, resolution: Resolution, ahead: int = 0) -> Section:
    """Transverse section of the pinion (0) or wheel (1), with teeth ahead of the loaded one.

    Raises:
        ParameterError: the section cannot be meshed.
    """
    profile = Profile(
        pair.tooth_profile(gear).points.T, pair.number_of_teeth[gear], pair.hub_radius[gear]
    )
    ahead = max(1, ahead)
    return mesh_section(profile, resolution, *((1, ahead) if gear == 0 else (ahead, 1)))


def tooth_compliance(
    pair: GearPair,
    gear: int,
    resolution: Resolution,
    ahead: int = 0,
    progress: Callable[[float], None] = lambda done: None,
) -> ToothCompliance:
    """Compliance of a tooth of the pinion (0) or wheel (1).

    Args:
        pair: gear pair.
        gear: 0 pinion, 1 wheel.
        resolution: of the mesh.
        ahead: how many teeth ahead of the loaded one are measured as well.
        progress: called with the share of the work done.

    Raises:
        ParameterError: the section cannot be meshed, or scikit-fem is missing.
    """
    section = tooth_mesh(pair, gear, resolution, ahead)
    layers = layer_count(pair, resolution, section)
    thickness = pair.face_width / layers
    twist = sweep_lead(pair, gear) * thickness
    layer = layer_stiffness(section, thickness, twist, pair.youngs_modulus, pair.poissons_ratio)
    path = np.linspace(0.0, pair.path_of_contact.length, STATIONS)
    loads, measures = unit_loads(pair, gear, section, layer.unknowns, path, ahead)
    full = stack_compliance(layer, layers, loads, measures, progress)
    sections, points = layers + 1, (layers + 1) * STATIONS
    full = full.reshape(sections, -1, STATIONS, points).transpose(1, 0, 2, 3)
    full = full.reshape(-1, points, points)
    own = full[0]
    asymmetry = float(np.abs(own - own.T).max() / np.abs(own).max())
    full[0] = 0.5 * (own + own.T)
    return ToothCompliance(
        path,
        np.linspace(0.0, pair.face_width, layers + 1),
        full,
        asymmetry,
        (layers + 1) * layer.size + layers * layer.inner,
    )
