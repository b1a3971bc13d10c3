"""Shapes of the lowest modes on the surface of the shipped housing, for pictures.

`python -m herringbone.housing.welded.surface_shapes` takes some ten seconds, with the extra `fe`.
It writes, beside the housing's data, `surface/nodes.csv` (places, displacements of the modes) and
`surface/triangles.csv` (rows of nodes from 0), and `surface/shares.csv` with what the modes do.
The mesh is coarse, so that the files are small: frequencies are those of the housing's data, not of
this mesh, and the agreement of the shapes at seats and sensors is written with them.
"""

import sys
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from herringbone.components.registry import component_for
from herringbone.core.declaring.roles import Role
from herringbone.housing import read_housing
from herringbone.housing.eigenmodes import eigenmodes
from herringbone.housing.welded.design import read_design
from herringbone.housing.welded.finite_elements import FiniteElements
from herringbone.housing.welded.mesher import mesh_housing
from herringbone.housing.welded.mode_shares import RIGID_MOTIONS, mode_shares

FOLDER = "surface"
MODES = 4
_MESH_SIZE = 0.060
"""[m]: plates take one element, edges of the box eight."""
_AXES = "xyz"


class Surface(NamedTuple):
    """The surface of a housing and how modes move it.

    Attributes:
        places: (n, 3) of nodes [m].
        triangles: (k, 3) nodes.
        shapes: (n, 3, modes) mass-normalised [kg^-1/2].
        agreement: (modes,) modal assurance criterion of the motions of seats and sensors, against
            the housing's data [1].
    """

    places: np.ndarray
    triangles: np.ndarray
    shapes: np.ndarray
    agreement: np.ndarray


def main() -> None:
    """Write the three files."""
    component = component_for(Role.HOUSING)
    design = read_design(component.folder / "welded_housing.toml")
    known = read_housing(component.resources)
    model = FiniteElements(
        replace(design, mesh_size=_MESH_SIZE), mesh_housing(design.dimensions, _MESH_SIZE)
    )
    modes = eigenmodes(model.stiffness, model.mass, MODES)
    points = np.vstack([model.seat_input.T @ modes.shapes, model.sensor_output() @ modes.shapes])
    surface = surface_of(model, modes.shapes, _agreement(points, known.shapes[:, :MODES]))
    shares = mode_shares(model, modes.frequency_hz, modes.shapes)
    folder = component.folder / FOLDER
    folder.mkdir(exist_ok=True)
    command = f"# Made by: python -m {__spec__.name if __spec__ else __name__}\n"
    write_surface(surface, folder, command)
    columns = {name: shares.rigid[:, k] for k, name in enumerate(RIGID_MOTIONS)}
    columns |= {"elastic": shares.elastic, "base plate": shares.base}
    columns |= {f"strain: {name}": share for name, share in shares.strain.items()}
    columns |= {"agreement": surface.agreement}
    rows = np.column_stack(list(columns.values()))
    _write(folder / "shares.csv", command + "# units: 1\n", ["mode", *columns],
           [[str(k + 1), *(f"{x:.4f}" for x in row)] for k, row in enumerate(rows)])  # fmt: skip
    sys.stderr.write(f"{len(surface.places)} nodes, {len(surface.triangles)} triangles\n")


def surface_of(model: FiniteElements, shapes: np.ndarray, agreement: np.ndarray) -> Surface:
    """The surface of a model, without the nodes in the middle of edges.

    Args:
        model: finite elements.
        shapes: (f, m) of its free unknowns.
        agreement: (m,), see `Surface`.
    """
    mesh, count = model.solid.mesh, len(model.solid.nodes)
    facets = mesh.facets.T[model.solid.boundary()]
    used, triangles = np.unique(facets, return_inverse=True)
    places = mesh.p.T[used]
    by_place = {tuple(place): k for k, place in enumerate(np.round(model.solid.nodes, 9))}
    rows = [by_place[tuple(place)] for place in np.round(places, 9)]
    moved = model.full(shapes).reshape(3, count, -1)[:, rows].transpose(1, 0, 2)
    return Surface(places, triangles.reshape(-1, 3), moved, agreement)


def write_surface(surface: Surface, folder: Path, head: str) -> None:
    """Write nodes and triangles: places to 0.1 mm, shapes to four digits of the largest."""
    count = surface.shapes.shape[2]
    digits = 1e-4 * np.abs(surface.shapes).max()
    decimals = max(0, int(np.ceil(-np.log10(digits))))
    names = [f"m{k + 1}_{axis}" for k in range(count) for axis in _AXES]
    shapes = surface.shapes.transpose(0, 2, 1).reshape(len(surface.places), -1)
    _write(folder / "nodes.csv", head + "# units: x m, y m, z m, others kg^-1/2\n",
           [*_AXES, *names],
           [[*(f"{x:.4f}" for x in place), *(f"{x:.{decimals}f}" for x in row)]
            for place, row in zip(surface.places, shapes, strict=True)])  # fmt: skip
    _write(folder / "triangles.csv", head, ["a", "b", "c"],
           [[str(k) for k in row] for row in surface.triangles])  # fmt: skip


def _write(file: Path, head: str, names: list[str], rows: list[list[str]]) -> None:
    lines = [",".join(names), *(",".join(row) for row in rows)]
    file.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")


def _agreement(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Modal assurance criterion (modes,) of shapes (points, modes).

    Source: R. J. Allemang, The modal assurance criterion, Sound and Vibration 37 (2003).
    """
    both = np.einsum("ij,ij->j", one, other) ** 2
    return both / (np.einsum("ij,ij->j", one, one) * np.einsum("ij,ij->j", other, other))


if __name__ == "__main__":
    main()
