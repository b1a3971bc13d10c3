"""The default housing against the published frequencies, and its record against its data.

Source: the thesis, table 4.2. Nothing else of its housing is published.
"""

import re

import numpy as np
import pytest
from support.finite_elements import require_gmsh

from herringbone.core.places.paths import component_folder
from herringbone.housing import default_housing

require_gmsh()
from herringbone.housing.welded import default_data  # noqa: E402 (needs the extra fe)
from herringbone.housing.welded.design import read_design  # noqa: E402

HOUSING = default_housing()
RECORD = default_data.RECORD.read_text(encoding="utf-8")


def rows(title: str) -> list[list[str]]:
    """Cells of the first table below a title of HOUSING.md."""
    table = RECORD.split(f"## {title}")[1].split("\n\n|", 1)[1].split("\n\n")[0]
    lines = [line.strip("| ").split(" | ") for line in table.splitlines()]
    return lines[2:]


def test_four_frequencies_within_one_percent():
    published = [248.24, 447.29, 608.32, 620.89]
    np.testing.assert_allclose(HOUSING.frequency_hz[:4], published, rtol=0.01)
    assert [f for f, _ in default_data.PUBLISHED] == published


def test_what_the_data_offer():
    assert HOUSING.valid_to_hz == 2000.0
    assert HOUSING.certificate["error_bound"] <= 0.05
    assert HOUSING.kind.count("residual") == 12
    assert HOUSING.frequency_hz[HOUSING.kind.count("normal") - 1] > 0.95 * 1.5 * 2000.0
    assert HOUSING.seats == ("pinion_left", "pinion_right", "wheel_left", "wheel_right")
    difference = HOUSING.static_compliance() - HOUSING.static
    assert np.abs(difference).max() <= 1e-10 * HOUSING.static.max()
    assert np.linalg.eigvalsh(HOUSING.gram).min() > -1e-12 * HOUSING.gram.max()
    assert "calibrated to the published frequencies" in HOUSING.source["description"]


def test_dimensions_are_those_of_the_file():
    design = read_design(default_data.DESIGN)
    assert HOUSING.source["mesh"]["size_m"] == design.mesh_size
    for name, value in HOUSING.source["dimensions_m"].items():
        assert value == getattr(design.dimensions, name), name


def test_thesis_modes_are_made_from_the_data(tmp_path):
    default_data.write_thesis_modes(HOUSING, tmp_path)
    for name in ("thesis_modes.csv", "thesis_shapes.csv"):
        committed = component_folder("modal_housing") / "resources" / name
        assert (tmp_path / name).read_bytes() == committed.read_bytes()


def test_record_has_the_figures_of_the_data():
    found = rows("Frequencies and labels")
    assert [row[3] for row in found] == [f"{f:.2f}" for f in HOUSING.frequency_hz[:4]]
    assert [row[4] for row in found] == ["+0.43", "-0.05", "+0.51", "-0.24"]
    stiffness = 1e-6 / np.diag(HOUSING.static).reshape(4, 3)
    for row, values in zip(rows("Static stiffness at the seats [N/um]"), stiffness, strict=True):
        assert row[1:] == [f"{k:.0f}" for k in values]
    bound = f"{100 * HOUSING.certificate['error_bound']:.2g}"
    assert re.search(rf"below {re.escape(bound)} % of the static\s+compliance", RECORD)


@pytest.mark.slow
def test_convergence_table():
    """Frequencies fall with the mesh size; the row of the data is theirs; two rows again.

    Another gmsh makes another mesh: 1 %.
    """
    table = {float(row[0]): [float(cell) for cell in row[2:]] for row in rows("Convergence")}
    assert [size * 1e-3 for size in table] == pytest.approx(default_data.MESH_SIZES)
    assert (np.diff(list(table.values()), axis=0) < 0.0).all()
    assert table[16.0] == pytest.approx(HOUSING.frequency_hz[:4], abs=0.006)
    design = read_design(default_data.DESIGN)
    for size, _, frequency_hz in default_data.convergence(design, (0.060, 0.042)):
        np.testing.assert_allclose(frequency_hz, table[round(1e3 * size)], rtol=0.01)
