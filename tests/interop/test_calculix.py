"""A housing solved by CalculiX and imported moves like the same mesh solved here."""

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp
from support.finite_elements import require_gmsh

import herringbone as hb
from herringbone.core.places.paths import component_folder
from herringbone.housing import write_housing
from herringbone.housing.eigenmodes import eigenmodes
from herringbone.housing.importers import import_housing
from herringbone.housing.welded.design import read_design
from herringbone.housing.welded.mesher import mesh_housing

require_gmsh()
from skfem import Basis, BilinearForm, ElementTetP2  # noqa: E402

from herringbone.housing.welded.finite_elements import FiniteElements  # noqa: E402 (needs gmsh)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed"),
]
MODES = 20
MESH_SIZE = 0.06
DAMPING = 0.01
_SWAP = [1, 0, 2, 3, 4, 6, 5, 8, 7, 9]
"""Nodes of a tetrahedron whose first two corners are exchanged."""


@pytest.fixture(scope="module")
def elements() -> FiniteElements:
    design = read_design(component_folder("modal_housing") / "welded_housing.toml")
    return FiniteElements(design, mesh_housing(design.dimensions, MESH_SIZE))


def deck(elements: FiniteElements) -> str:
    """Input of CalculiX in mm, t, N: quadratic tetrahedra, bolt holes fixed, MODES modes."""
    solid = elements.solid
    nodes, material = 1e3 * solid.nodes, solid.material
    corners = solid.nodes[solid._basis.element_dofs.T[:, :4]]
    turned = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    connectivity = solid._basis.element_dofs.T.copy()
    connectivity[turned] = connectivity[turned][:, _SWAP]
    count = len(nodes)
    held = np.setdiff1d(np.arange(count), elements.free[: elements.free.size // 3])
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(nodes.tolist(), 1)]
    lines += ["*ELEMENT, TYPE=C3D10, ELSET=BODY"]
    lines += [", ".join(map(str, [i, *(row + 1)])) for i, row in enumerate(connectivity, 1)]
    lines += [
        "*MATERIAL, NAME=STEEL",
        "*ELASTIC",
        f"{1e-6 * material.young_modulus:.12e}, {material.poisson_ratio}",
        "*DENSITY",
        f"{1e-12 * material.density:.12e}",
        "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL",
        "*BOUNDARY",
        *(f"{node + 1}, 1, 3" for node in held),
        "*STEP",
        "*FREQUENCY",
        str(MODES),
        "*NODE FILE",
        "U",
        "*END STEP",
    ]
    return "\n".join(lines) + "\n"


def seat_file(elements: FiniteElements) -> str:
    lines = ["valid_to_hz = 700", "[units]", 'length = "mm"', 'mass = "t"', "[seats]"]
    free = elements.free[: elements.free.size // 3]
    for k, point in enumerate(elements.points[:4]):
        weights = elements.seat_input[: free.size, 3 * k]
        used = np.flatnonzero(weights)
        nodes, shares = (free[used] + 1).tolist(), weights[used].tolist()
        lines.append(f"{point.name} = {{ nodes = {nodes}, weights = {shares} }}")
    return "\n".join(lines) + "\n"


@pytest.fixture(scope="module")
def imported(elements, tmp_path_factory):
    folder = tmp_path_factory.mktemp("calculix")
    (folder / "housing.inp").write_text(deck(elements))
    (folder / "seats.toml").write_text(seat_file(elements))
    run = subprocess.run(
        ["ccx", "housing"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert "Job finished" in run.stdout, run.stdout[-2000:]
    return import_housing(
        [folder / "housing.frd"], folder / "seats.toml", band_hz=2e3, tolerance=0.05, most_modes=64
    )


@BilinearForm
def product(u, v, w):
    return u * v


def mass_as_calculix(elements: FiniteElements) -> sp.csr_array:
    """Mass matrix by the 4-point rule that CalculiX takes for C3D10; ours is integrated exactly."""
    basis = Basis(elements.solid.mesh, ElementTetP2(), intorder=2)
    assert basis.dx.shape[1] == 4
    scalar = elements.solid.material.density * product.assemble(basis)
    whole = sp.block_diag([scalar] * 3, format="csr")
    return sp.csr_array(whole)[elements.free][:, elements.free]


@pytest.fixture(scope="module")
def expected(elements, imported):
    """The same modes, solved here."""
    own = eigenmodes(elements.stiffness, mass_as_calculix(elements), MODES)
    return replace(
        imported, frequency_hz=own.frequency_hz, shapes=elements.seat_input.T @ own.shapes
    )


def test_same_receptance(expected, imported):
    """All 144 entries up to 2 kHz, over the largest value of each: the file has 6 digits."""
    np.testing.assert_allclose(imported.frequency_hz, expected.frequency_hz, rtol=1e-6)
    frequency_hz = np.linspace(1.0, 2000.0, 1000)
    exact = expected.receptance(frequency_hz)
    difference = np.abs(imported.receptance(frequency_hz) - exact).max(axis=0)
    assert (difference <= 1e-4 * np.abs(exact).max(axis=0)).all()


def test_points(elements, imported):
    """Bores are polygons of straight-sided tetrahedra; their middle is the middle of the bore."""
    for found, point in zip(imported.points, elements.points[:4], strict=True):
        np.testing.assert_allclose(found.position, point.position, atol=1e-3)


def test_swapped_into_the_rig(expected, imported, tmp_path):
    """Written, read by the component, and run: the seats move as with the modes solved here."""
    velocities = []
    for name, housing in (("imported", imported), ("expected", expected)):
        write_housing(housing, tmp_path / name)
        tables = {
            f"modal_housing.{table}": str(tmp_path / name / f"{table}.csv")
            for table in ("modes", "shapes")
        }
        result = hb.run("test_rig", t_end=2e-3, step=1e-5, fmu="in-process", values=tables)
        velocities.append(result.data[result.channel("seat_velocity")].to_numpy())
    difference = np.abs(velocities[0] - velocities[1]).max()
    assert difference <= 1e-3 * np.abs(velocities[1]).max()
    assert np.abs(velocities[1]).max() > 1e-6
