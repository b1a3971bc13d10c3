"""What is hardly meant is said once: units, supports, seats, weights, matrices in wrong order."""

import logging
from dataclasses import replace

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from support.files.fe_files import NODES, SEATS
from support.housing import small_housing

from herringbone.core import HerringboneError, ResourceError
from herringbone.core.places.paths import component_folder
from herringbone.housing import read_housing
from herringbone.housing.files.plausibility import implausible
from herringbone.housing.files.validation import housing_warnings
from herringbone.housing.importers import import_housing
from herringbone.housing.importers.seat_file import read_seats

HOUSING = small_housing(static=None)


def test_good_housings_are_plausible():
    assert list(implausible(HOUSING)) == []
    assert list(implausible(read_housing(component_folder("modal_housing") / "resources"))) == []


@pytest.mark.parametrize(("factor", "noted"), [(1.0, 0), (10.0, 0), (100.0, 1), (1e-3, 1)])
def test_stiffness_of_another_order(factor, noted):
    """Shapes in g^-1/2 instead of kg^-1/2 are 31 times as large, in t^-1/2 a 31st."""
    lines = list(implausible(replace(HOUSING, shapes=factor * HOUSING.shapes)))
    assert len(lines) == noted
    assert all("are lengths, masses or shapes of another unit?" in line for line in lines)


def test_left_seats_on_the_right():
    """Both shafts the wrong way round; left is +z."""
    mirrored = tuple(replace(p, position=(*p.position[:2], -p.position[2])) for p in HOUSING.points)
    lines = list(implausible(replace(HOUSING, points=mirrored)))
    assert [line.partition(" ")[0] for line in lines] == ["pinion_left", "wheel_left"]
    assert all("left is +z" in line for line in lines)


def test_modes_of_a_housing_that_is_not_held():
    kind = ("rigid", "rigid", *HOUSING.kind[2:])
    frequency = np.array([0.0, 0.0, *HOUSING.frequency_hz[2:]])
    (line,) = implausible(replace(HOUSING, kind=kind, frequency_hz=frequency))
    assert line.startswith("2 modes are at 0 Hz, though its boundary is 'base fixed'")


def test_two_seats_at_one_place():
    shapes = HOUSING.shapes.copy()
    shapes[6:9] = shapes[0:3]
    line = "seats pinion_left and wheel_left move alike in all modes: are they the same nodes?"
    doubtful = replace(HOUSING, shapes=shapes)
    assert list(implausible(doubtful)) == [line]
    assert housing_warnings(doubtful).count(line) == 1


@pytest.fixture
def seats(tmp_path):
    def write(old="", new=""):
        assert old in SEATS
        file = tmp_path / "seats.toml"
        file.write_text(SEATS.replace(old, new) if old else SEATS)
        return file

    return write


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("weights = [1, 2, 1]", "weights = [1, 2, -1]",
         "seat pinion_left: node 3 has the weight -1; weights are shares of a mean"),
        ("[7, 8, 9]", "[7, 8, 6]", "seats pinion_right and wheel_left share the node 6"),
    ],
)  # fmt: skip
def test_doubtful_seats(seats, caplog, old, new, said):
    with caplog.at_level(logging.WARNING):
        read_seats(seats())
        assert caplog.text == ""
        read_seats(seats(old, new))
    assert caplog.text.count(said) == 1


@pytest.mark.parametrize("ratio", ["0", "1", "2", "-0.01"])
def test_damping_ratios_of_seats(seats, ratio):
    with pytest.raises(ResourceError, match=r"seats\.toml: damping ratio .* between 0 and 1"):
        read_seats(seats("ratio = 0.02", f"ratio = {ratio}"))


def test_matrices_in_the_wrong_order(tmp_path, seats):
    size = 3 * NODES
    for name, diagonal in (("K", 4e4), ("M", 2e-3)):
        scipy.io.mmwrite(tmp_path / f"{name}.mtx", sp.coo_array(diagonal * np.eye(size)))
    file = seats("] }", "], position = [200, 30, 7] }")
    files = [tmp_path / "M.mtx", tmp_path / "K.mtx"]
    with pytest.raises(HerringboneError, match="are they in the wrong order"):
        import_housing(files, file, band_hz=100.0, tolerance=0.9, most_modes=64)
    import_housing(files[::-1], file, band_hz=100.0, tolerance=0.9, most_modes=64)
