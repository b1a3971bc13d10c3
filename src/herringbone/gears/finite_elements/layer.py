"""Stiffness of one layer of a swept gear: hexahedra between two transverse sections.

All layers of a gear are one layer turned about the axis.  With the displacements of each section
in axes that turn with the section, all layers have the same matrix.
"""

from dataclasses import dataclass
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from herringbone.core import ParameterError
from herringbone.gears.finite_elements.section import Section

if TYPE_CHECKING:
    from scipy import sparse

_POINTS = 4
"""Polynomial order that the quadrature integrates exactly: 3 x 3 x 3 points."""


@dataclass(frozen=True)
class Layer:
    """Stiffness of a layer over the displacements of its two sections.

    Attributes:
        lower: block of the lower section, shape (n, n) [N/m].
        upper: block of the upper section, shape (n, n) [N/m].
        coupling: rows of the lower, columns of the upper section, shape (n, n) [N/m].
        unknowns: number of the unknown of each node and direction in a section, -1 where the node
            is held or has none, shape (nodes, 3).
        inner: number of unknowns between the sections, which are condensed.
    """

    lower: np.ndarray
    upper: np.ndarray
    coupling: np.ndarray
    unknowns: np.ndarray
    inner: int


def layer_stiffness(
    section: Section, thickness: float, twist: float, young: float, poisson: float
) -> Layer:
    """Stiffness of a layer of twenty-node hexahedra on a 27-node geometry.

    Args:
        section: mesh of the lower section; nodes on the bore are held.
        thickness: of the layer along the gear axis [m].
        twist: rotation of the upper against the lower section, positive towards +x [rad].
        young: Young's modulus [Pa].
        poisson: Poisson's ratio [1].

    Raises:
        ParameterError: scikit-fem is missing.
    """
    matrix, node, level = _assembled(section, thickness, twist, young, poisson)
    level = np.where(np.isin(node, section.bore), -1, level)
    lower, middle, upper = (_rows(node, level, i) for i in range(3))
    ends = np.r_[lower, upper]
    inner = matrix[middle][:, middle].toarray()
    link = matrix[middle][:, ends].toarray()
    full = matrix[ends][:, ends].toarray()
    full -= link.T @ cho_solve(cho_factor(inner, overwrite_a=True), link, check_finite=False)
    n = lower.size
    unknowns = np.full((section.points.shape[1], 3), -1)
    unknowns[node[lower[::3]]] = np.arange(n).reshape(-1, 3)
    return Layer(full[:n, :n], full[n:, n:], full[:n, n:], unknowns, middle.size)


def _rows(node: np.ndarray, level: np.ndarray, wanted: int) -> np.ndarray:
    """Rows of one level, by node, three directions each."""
    rows = np.flatnonzero(level == wanted)
    return rows[np.argsort(node[rows], kind="stable")]


def _assembled(
    section: Section, thickness: float, twist: float, young: float, poisson: float
) -> "tuple[sparse.csr_matrix, np.ndarray, np.ndarray]":
    """Stiffness in axes that turn with the section; section node and level of each row."""
    from scipy import sparse  # noqa: PLC0415 (lazy)

    fem = scikit_fem()
    elasticity = fem.models.elasticity
    mesh = _mesh(fem, section, thickness, twist)
    element = fem.ElementVector(fem.ElementHexS2())
    basis = fem.Basis(mesh, element, intorder=_POINTS)
    node, level, direction = _places(section, basis.dofs, element)
    matrix = elasticity.linear_elasticity(*elasticity.lame_parameters(young, poisson)).assemble(
        basis
    )
    turn = _turn(twist * level / 2)
    plane = np.flatnonzero(direction < 2)
    partner = np.where(direction == 0, 1, -1)[plane] + plane
    axes = sparse.eye(matrix.shape[0], format="lil")
    axes[plane, plane] = turn[0, 0, plane]
    axes[plane, partner] = turn[direction[plane], 1 - direction[plane], plane]
    axes = axes.tocsr()
    return (axes.T @ matrix @ axes).tocsr(), node, level


def scikit_fem() -> ModuleType:
    """The library.

    Raises:
        ParameterError: it is not installed.
    """
    try:
        import skfem.models.elasticity  # noqa: PLC0415 (an extra: only when it is needed)
    except ImportError as error:
        raise ParameterError(
            f"finite elements take scikit-fem, which does not load ({error}); "
            "pip install 'herringbone[fe]'"
        ) from None
    return skfem


def _mesh(fem: ModuleType, section: Section, thickness: float, twist: float) -> Any:  # noqa: ANN401 (skfem's)
    """27-node hexahedra of the layer."""
    used, number = np.unique(section.nodes[:, ::2, ::2], return_inverse=True)
    number = number.reshape(-1, 2, 2)
    corners = fem.ElementHex1.doflocs.astype(int)
    cells = np.stack([number[:, a, b] + c * used.size for a, b, c in corners])
    flat = section.points[:, used]
    vertices = np.hstack([np.vstack([flat, np.full(used.size, z)]) for z in (0.0, thickness)])
    mesh = fem.MeshHex2.from_mesh(fem.MeshHex(vertices, cells))
    node, level, _ = _places(section, fem.Dofs(mesh, fem.ElementHex2()), fem.ElementHex2)
    points = np.empty_like(mesh.doflocs)
    points[:2] = np.einsum("abn,bn->an", _turn(twist * level / 2), section.points[:, node])
    points[2] = thickness * level / 2
    return fem.MeshHex2(points, mesh.t)


def _places(
    section: Section,
    dofs: Any,  # noqa: ANN401 (skfem's)
    element: Any,  # noqa: ANN401 (skfem's)
) -> tuple[np.ndarray, ...]:
    """Section node, level (0, 1, 2) and direction (0, 1, 2) of each degree of freedom."""
    where = np.round(2 * element.doflocs).astype(int)
    node = np.stack([section.nodes[:, a, b] for a, b, _ in where])
    level = np.broadcast_to(where[:, 2:], node.shape)
    direction = np.broadcast_to(np.arange(len(where))[:, None] % 3, node.shape)
    _, first = np.unique(dofs.element_dofs, return_index=True)
    return tuple(values.ravel()[first] for values in (node, level, direction))


def _turn(angle: np.ndarray) -> np.ndarray:
    """Rotations towards +x, shape (2, 2, n)."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, s], [-s, c]])
