"""Stiffness of one layer of a swept gear: hexahedra between two transverse sections.

All layers of a gear are one layer turned about the axis.  With the displacements of each section
in axes that turn with the section, all layers have the same matrix.
"""

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from herringbone.core import ParameterError
from herringbone.gears.finite_elements.section import Section

_POINTS = 4
"""Polynomial order that the quadrature integrates exactly: 3 x 3 x 3 points."""


@dataclass(frozen=True)
class Layer:
    """Stiffness of the elements of a layer, in axes that turn with its sections.

    Unknowns are numbered: those of the lower section, those between the sections, those of the
    upper section in the order of the lower one.

    Attributes:
        matrices: of the elements, shape (elements, 60, 60) [N/m].
        places: number of the unknown of each of their rows, -1 where it is held; (elements, 60).
        centers: of the elements in the lower section, shape (elements, 2) [m].
        unknowns: number of the unknown of each node and direction in a section, -1 where the node
            is held or has none, shape (nodes, 3).
        size: number of the unknowns of a section.
        inner: number of the unknowns between two sections.
    """

    matrices: np.ndarray
    places: np.ndarray
    centers: np.ndarray
    unknowns: np.ndarray
    size: int
    inner: int

    @property
    def stride(self) -> int:
        """From an unknown to that of the next layer."""
        return self.size + self.inner


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
    fem = scikit_fem()
    elasticity = fem.models.elasticity
    element = fem.ElementVector(fem.ElementHexS2())
    basis = fem.Basis(_mesh(fem, section, thickness, twist), element, intorder=_POINTS)
    axes = _axes(element, twist)
    matrices = axes.T @ _matrices(basis, *elasticity.lame_parameters(young, poisson)) @ axes
    node, level, _ = _places(section, basis.dofs, element)
    level = np.where(np.isin(node, section.bore), -1, level)
    lower, middle, upper = (_rows(node, level, i) for i in range(3))
    numbers = np.full(node.size, -1)
    numbers[np.r_[lower, middle, upper]] = np.arange(lower.size + middle.size + upper.size)
    unknowns = np.full((section.points.shape[1], 3), -1)
    unknowns[node[lower[::3]]] = np.arange(lower.size).reshape(-1, 3)
    centers = section.points[:, section.nodes[:, 1, 1]].T
    places = numbers[basis.element_dofs].T
    return Layer(matrices, places, centers, unknowns, lower.size, middle.size)


def _rows(node: np.ndarray, level: np.ndarray, wanted: int) -> np.ndarray:
    """Rows of one level, by node, three directions each."""
    rows = np.flatnonzero(level == wanted)
    return rows[np.argsort(node[rows], kind="stable")]


def _matrices(basis: Any, first: float, second: float) -> np.ndarray:  # noqa: ANN401 (skfem's)
    """Stiffness (elements, 60, 60) of linear elasticity with Lame's parameters [N/m].

    All rows at once, where skfem's own assembly takes each pair of rows by itself.
    """
    slopes = np.array([shape[0].grad for shape in basis.basis]) * np.sqrt(basis.dx)
    strain = 0.5 * (slopes + slopes.swapaxes(1, 2))
    volume = np.trace(strain, axis1=1, axis2=2).transpose(1, 0, 2)
    strain = strain.reshape(len(strain), -1, *basis.dx.shape).transpose(2, 0, 1, 3)
    strain = strain.reshape(*strain.shape[:2], -1)
    return 2.0 * second * (strain @ strain.mT) + first * (volume @ volume.mT)


def _axes(element: Any, twist: float) -> np.ndarray:  # noqa: ANN401 (skfem's)
    """(60, 60) displacements of an element's rows from those in axes that turn with the section."""
    height = element.doflocs[:, 2]
    axes = np.eye(height.size)
    for row in range(0, height.size, 3):
        axes[row : row + 2, row : row + 2] = _turn(twist * height[row])
    return axes


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
