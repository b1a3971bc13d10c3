"""Linear elasticity on quadratic tetrahedra.

Displacements are ordered by axis: unknown `axis * nodes + node`. The stiffness is put together from
the scalar products of derivatives, H_ab = integral dN_i/dx_a dN_j/dx_b dV:

    K_ab = lambda H_ab + mu H_ba + delta_ab mu (H_xx + H_yy + H_zz)

which is some eight times as fast as a form of vectors. lambda and mu are Lame's constants.

Source: O. C. Zienkiewicz, R. L. Taylor, The Finite Element Method, vol. 1, chapters 2 and 8.
"""

import numpy as np
import scipy.sparse as sp
from skfem import Basis, BilinearForm, ElementTetP2, FacetBasis, LinearForm, MeshTet

from herringbone.housing.welded.design import Material
from herringbone.housing.welded.mesher import Mesh

_STIFFNESS_DEGREE, _MASS_DEGREE = 2, 4  # of the integrands: the quadratures are exact


@BilinearForm
def _derivatives(u, v, w):  # noqa: ANN001, ANN202 (scikit-fem's own types)
    return v.grad[w["a"]] * u.grad[w["b"]]


@BilinearForm
def _product(u, v, w):  # noqa: ANN001, ANN202
    return u * v


@BilinearForm
def _normal_product(u, v, w):  # noqa: ANN001, ANN202
    return w.n[w["a"]] * w.n[w["b"]] * u * v


@LinearForm
def _integral(v, w):  # noqa: ANN001, ANN202
    return v


class Solid:
    """An elastic solid.

    Attributes:
        mesh: scikit-fem's mesh.
        material: of all elements.
        nodes: (n, 3) positions of vertices and edge middles [m].
    """

    def __init__(self, mesh: Mesh, material: Material) -> None:
        """Take a mesh as it is."""
        self.mesh = MeshTet(mesh.points.T.copy(), mesh.tetrahedra.T.copy())
        self.material = material
        self._basis = Basis(self.mesh, ElementTetP2(), intorder=_STIFFNESS_DEGREE)
        self.nodes = self._basis.doflocs.T

    @property
    def volume(self) -> float:
        """[m3]."""
        return float(self._basis.dx.sum())

    def stiffness(self, elements: np.ndarray | None = None) -> sp.csr_array:
        """Stiffness matrix (3 n, 3 n) [N/m] of all elements, or of some by index."""
        basis = self._basis if elements is None else self._basis.with_elements(elements)
        young, poisson = self.material.young_modulus, self.material.poisson_ratio
        mu = young / (2 * (1 + poisson))
        lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        h = {(a, b): _derivatives.assemble(basis, a=a, b=b) for a in range(3) for b in range(a, 3)}
        h |= {(b, a): matrix.T for (a, b), matrix in h.items() if a != b}
        blocks = {(a, b): lame * h[a, b] + mu * h[b, a] for a, b in h}
        shear = mu * (h[0, 0] + h[1, 1] + h[2, 2])
        return _blocks(blocks | {(a, a): blocks[a, a] + shear for a in range(3)})

    def mass(self, elements: np.ndarray | None = None) -> sp.csr_array:
        """Consistent mass matrix (3 n, 3 n) [kg] of all elements, or of some by index."""
        basis = Basis(self.mesh, ElementTetP2(), intorder=_MASS_DEGREE, elements=elements)
        scalar = self.material.density * _product.assemble(basis)
        return sp.csr_array(sp.block_diag([scalar] * 3, format="csr"))

    def boundary(self) -> np.ndarray:
        """Indices of the facets on the surface."""
        return self.mesh.boundary_facets()

    def corners(self, facets: np.ndarray) -> np.ndarray:
        """Corners (k, 3, 3) [m] of facets: facet, corner, axis."""
        return self.mesh.p.T[self.mesh.facets.T[facets]]

    def nodes_on(self, facets: np.ndarray) -> np.ndarray:
        """Indices of the nodes on facets."""
        return self._basis.get_dofs(facets).flatten()

    def mean_weights(self, facets: np.ndarray) -> np.ndarray:
        """Weights (n,) of the area mean over facets, which sum to one.

        They are also the nodal forces of a uniform traction with resultant one.
        """
        weights = _integral.assemble(self._on(facets))
        return weights / weights.sum()

    def area(self, facets: np.ndarray) -> float:
        """Area of facets [m2]."""
        return float(self._on(facets).dx.sum())

    def normal_form(self, facets: np.ndarray) -> sp.csr_array:
        """Form (3 n, 3 n) of the products of normal components: integral (u.n) (v.n) dA [m2]."""
        basis = self._on(facets)
        products = {
            (a, b): _normal_product.assemble(basis, a=a, b=b) for a in range(3) for b in range(a, 3)
        }
        return _blocks(products | {(b, a): matrix for (a, b), matrix in products.items()})

    def interpolation(self, points: np.ndarray) -> sp.csr_array:
        """Displacements (3 p, 3 n) at points (p, 3) [m] of the solid: row `axis * p + point`.

        Raises:
            ValueError: a point lies outside of the mesh.
        """
        return sp.csr_array(sp.block_diag([self._basis.probes(points.T)] * 3, format="csr"))

    def _on(self, facets: np.ndarray) -> FacetBasis:
        return FacetBasis(self.mesh, ElementTetP2(), facets=facets, intorder=_MASS_DEGREE)


def _blocks(matrices: dict[tuple[int, int], sp.sparray]) -> sp.csr_array:
    """Matrix of unknowns by axis from its blocks."""
    return sp.csr_array(
        sp.block_array([[matrices[a, b] for b in range(3)] for a in range(3)], format="csr")
    )
