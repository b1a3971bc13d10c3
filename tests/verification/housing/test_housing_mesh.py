"""Finite elements of the default housing on a coarse mesh: geometry, seats, sensors, modes."""

import json
import math
import sys
from dataclasses import replace

import numpy as np
import pytest
from support.finite_elements import require_gmsh

from herringbone.commands.main import main
from herringbone.core import HerringboneError
from herringbone.core.places.paths import component_folder
from herringbone.housing import read_housing
from herringbone.housing.eigenmodes import Factorisation, eigenmodes
from herringbone.housing.welded.build import build_housing
from herringbone.housing.welded.design import read_design
from herringbone.housing.welded.mesher import mesh_housing

require_gmsh()
from herringbone.housing.welded.finite_elements import PLATES, FiniteElements  # noqa: E402 (needs both)
from herringbone.housing.welded.mode_shares import mode_shares  # noqa: E402

FILE = component_folder("modal_housing") / "welded_housing.toml"
DESIGN = read_design(FILE)
D = DESIGN.dimensions
PUBLISHED_HZ = [248.24, 447.29, 608.32, 620.89]
MESH_SIZE = 0.06
COARSE_HZ = [263.0, 470.0, 647.6, 660.0]
"""On this mesh, by gmsh 4.15; the elements are as long as five plates are thick."""


@pytest.fixture(scope="module")
def model() -> FiniteElements:
    return FiniteElements(DESIGN, mesh_housing(D, MESH_SIZE))


@pytest.fixture(scope="module")
def factorisation(model) -> Factorisation:
    return Factorisation(model.stiffness)


@pytest.fixture(scope="module")
def modes(model, factorisation):
    return eigenmodes(model.stiffness, model.mass, 8, factorisation=factorisation)


def test_frequencies(modes):
    """Another version of gmsh makes another mesh: 1 %. A coarse mesh is too stiff."""
    np.testing.assert_allclose(modes.frequency_hz[:4], COARSE_HZ, rtol=0.01)
    assert (modes.frequency_hz[:4] > PUBLISHED_HZ).all()


def test_mass(model):
    """Plates by hand: the mass without bosses, ribs and their bores is 8 % less."""
    x0, x1 = D.box_x
    length, width = x1 - x0, 2 * D.half_width
    inner = length - 2 * D.end_wall
    height = D.axis_height + D.cover_height
    volume = length * width * (height + D.floor + D.cover) - inner * D.inner_width * height
    volume += (length + 2 * D.base_overhang_x) * (width + 2 * D.base_overhang_z) * D.base_plate
    volume -= len(D.bolts) * math.pi / 4 * D.bolt_diameter**2 * D.base_plate
    volume += 4 * D.foot_height * D.foot_length * D.foot_thickness
    rim = (length + 2 * D.flange_width) * (width + 2 * D.flange_width) - length * width
    volume += rim * 2 * D.flange_thickness
    plain = volume * DESIGN.material.density
    assert 1.02 * plain < model.total_mass < 1.12 * plain
    on_free = model.mass[: model.mass.shape[0] // 3, : model.mass.shape[0] // 3].sum()
    assert 0.99 * model.total_mass < on_free < model.total_mass


def test_surface(model):
    """What does not radiate: cavity, bores, bolt holes, underside of the base plate."""
    x0, x1 = D.box_x
    a, b = x1 - x0 - 2 * D.end_wall, D.axis_height + D.cover_height
    c = D.inner_width
    discs = math.pi / 2 * (D.pinion_bore**2 + D.wheel_bore**2)
    cavity = 2 * (a * b + b * c + c * a) - discs
    bores = 2 * math.pi * (D.pinion_bore + D.wheel_bore) * (D.side_wall + D.boss_length)
    holes = len(D.bolts) * math.pi * D.bolt_diameter * D.base_plate
    base = (x1 - x0 + 2 * D.base_overhang_x) * 2 * (D.half_width + D.base_overhang_z)
    base -= len(D.bolts) * math.pi / 4 * D.bolt_diameter**2
    solid = model.solid
    silent = solid.area(solid.boundary()) - solid.area(model.radiating_facets)
    # Ten edges around a circle: its circumference is 1.6 % short.
    assert silent == pytest.approx(cavity + bores + holes + base, rel=0.003)


def test_seats(model):
    """A seat's motion is the mean over its bore, and its force has resultant one there."""
    for k, point in enumerate(model.points[:4]):
        x, diameter = D.bores[point.name.split("_")[0]]
        area = math.pi * diameter * (D.side_wall + D.boss_length)
        assert point.area == pytest.approx(area, rel=0.02)  # ten edges around a circle
        assert point.position[0] == x
        assert (point.position[2] > 0) == point.name.endswith("left")
        nodes = np.concatenate([model.solid.nodes.T[axis] for axis in range(3)])[model.free]
        mean = model.seat_input[:, 3 * k : 3 * k + 3].T @ nodes
        np.testing.assert_allclose(mean, point.position, atol=1e-4)
    assert np.abs(model.seat_input.sum(axis=0) - 1.0).max() < 1e-12


def test_sensors(model):
    """A above, B away from the wheel, C below the pinion axis, on the left boss face."""
    radius, face = D.pinion_bore / 2 + D.boss_wall / 2, D.half_width + D.boss_length
    expected = [[0, radius, face], [-radius, 0, face], [0, -radius, face]]
    nodes = model.solid.nodes.T.ravel()[model.free]
    np.testing.assert_allclose(model.sensor_output() @ nodes, np.ravel(expected), atol=1e-12)
    for point, position in zip(model.points[4:], expected, strict=True):
        np.testing.assert_allclose(point.position, position, atol=1e-12)


def test_sensors_that_lie_before_the_face_by_rounding():
    """Taken 1.6 nm behind it: 114 mm + 41 mm by parts that are no short binary numbers."""
    d = replace(D, boss_length=0.0413, side_wall=0.0137)
    model = FiniteElements(replace(DESIGN, dimensions=d), mesh_housing(d, MESH_SIZE))
    nodes = model.solid.nodes.T.ravel()[model.free]
    expected = np.ravel([point.position for point in model.points[4:]])
    np.testing.assert_allclose(model.sensor_output() @ nodes, expected, atol=2e-9)


def test_sensors_outside_of_the_mesh_are_refused_before_it_is_solved():
    """Chords of a boss of 4 mm, at ten edges around it, lie up to 2.4 mm within its outline."""
    d = replace(D, boss_wall=0.004)
    design = replace(DESIGN, dimensions=d, sensors=replace(DESIGN.sensors, zero_deg=41.0))
    begun = []
    with pytest.raises(HerringboneError) as caught:
        build_housing(design, mesh_size=MESH_SIZE, progress=begun.append)
    assert str(caught.value) == (
        "a sensor on the boss face lies outside of the mesh: boss_wall = 4 mm is too thin for its "
        "edges around the boss; take a smaller mesh size or a thicker boss_wall"
    )
    assert [text.split()[0] for text in begun] == ["mesh", "assemble"]


def test_seat_stiffness(model, factorisation):
    """The mesh is symmetric only roughly: left and right differ by less than 1 %."""
    compliance = model.seat_input.T @ factorisation.solve(model.seat_input)
    np.testing.assert_allclose(compliance, compliance.T, atol=1e-12 * compliance.max())
    pinion, other, wheel, far = 1e-6 / np.diag(compliance).reshape(4, 3)
    np.testing.assert_allclose(pinion, other, rtol=0.01)
    np.testing.assert_allclose(wheel, far, rtol=0.01)
    np.testing.assert_allclose([pinion, wheel], [[771, 728, 183], [846, 824, 147]], rtol=0.01)


def test_traction_over_a_part_of_the_bore_is_softer(model, factorisation):
    """Over 120 degrees, toward each side, along x or y: 0 to 14 % less stiffness."""
    solid, facets = model.solid, model.solid.boundary()
    middle = solid.corners(facets).mean(axis=1)
    on_bore = np.hypot(middle[:, 0], middle[:, 1]) < D.pinion_bore / 2 + 1e-6
    on_bore &= middle[:, 2] > D.inner_width / 2
    whole = np.diag(model.seat_input.T @ factorisation.solve(model.seat_input))
    ratios = []
    for angle in (0.0, np.pi, np.pi / 2, -np.pi / 2):
        axis = 0 if angle in {0.0, np.pi} else 1
        along = np.array([math.cos(angle), math.sin(angle)])
        part = on_bore & (middle[:, :2] @ along > 0.5 * np.hypot(middle[:, 0], middle[:, 1]))
        force = np.kron(np.eye(3)[axis], solid.mean_weights(facets[part]))[model.free]
        ratios.append(whole[axis] / (force @ factorisation.solve(force)))
    assert min(ratios) == pytest.approx(0.87, abs=0.02)
    assert max(ratios) < 1.0


def test_what_the_modes_do(model, modes):
    """Sway along the shafts, lateral rocking, bounce on the base plate, yaw; see HOUSING.md."""
    shares = mode_shares(model, *modes)
    total = shares.rigid.sum(axis=1) + shares.elastic + shares.base
    np.testing.assert_allclose(total, 1.0, atol=1e-12)
    np.testing.assert_allclose(sum(shares.strain.values()), 1.0, atol=1e-12)
    largest = shares.rigid[:4].max(axis=1)
    assert list(shares.rigid[:4].argmax(axis=1)) == [2, 0, 1, 4]
    np.testing.assert_allclose(largest, [0.71, 0.60, 0.78, 0.94], atol=0.02)
    assert shares.strain["base plate"][2] == pytest.approx(0.60, abs=0.03)
    assert shares.elastic[4] > 0.9  # side walls breathe
    assert list(shares.strain) == list(PLATES)


def test_rigid_translation_radiates(model):
    """Along z: either side's outline without the bores, and both faces of each foot."""
    form = model.solid.normal_form(model.radiating_facets)
    along_z = np.repeat([0.0, 0.0, 1.0], len(model.solid.nodes))
    length = D.box_x[1] - D.box_x[0]
    side = length * (D.floor + D.axis_height + D.cover_height + D.cover)
    side += (length + 2 * D.base_overhang_x) * D.base_plate
    side += 2 * D.flange_width * 2 * D.flange_thickness
    side -= math.pi / 4 * (D.pinion_bore**2 + D.wheel_bore**2)
    feet = 4 * 2 * D.foot_length * D.foot_height
    # Ten edges around a bore: its disc is 6 % small, that is 0.4 % of a side.
    assert along_z @ (form @ along_z) == pytest.approx(2 * side + feet, rel=0.006)


@pytest.fixture
def quick_file(tmp_path):
    """The default housing on the coarse mesh, for a low band."""
    text = FILE.read_text(encoding="utf-8")
    text = text.replace("mesh_size = 16.0", "mesh_size = 60.0")
    file = tmp_path / "quick.toml"
    file.write_text(text.replace("band_hz = 2000.0", "band_hz = 600.0"), encoding="utf-8")
    return file


def test_build_command(quick_file, tmp_path, monkeypatch, capsys, modes, model):
    monkeypatch.chdir(tmp_path)
    assert main(["housing", "build", str(quick_file), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["output"] == "results/quick"
    housing = read_housing(tmp_path / "results" / "quick")
    normal = housing.kind.count("normal")
    assert (
        housing.frequency_hz[normal - 1]
        <= 1.5 * 600.0
        < summary["certificate"]["next_frequency_hz"]
    )
    assert housing.kind[normal:] == ("residual",) * 12
    np.testing.assert_allclose(
        housing.frequency_hz[:normal], modes.frequency_hz[:normal], rtol=1e-8
    )
    assert set(housing.damping_ratio[:normal]) == {0.01}
    assert set(housing.damping_ratio[normal:]) == {0.05}
    assert housing.valid_to_hz == 600.0
    np.testing.assert_allclose(
        housing.static_compliance(), housing.static, atol=1e-10 * housing.static.max()
    )
    # Of a mode the elements give directly; its sign is free.
    k = 2
    shape = modes.shapes[:, k]
    gram = shape @ (model.radiating_form() @ shape)
    assert housing.gram[k, k] == pytest.approx(gram, rel=1e-6)
    assert np.linalg.eigvalsh(housing.gram).min() > -1e-12 * housing.gram.max()
    sensors = np.abs(model.sensor_output() @ shape)
    np.testing.assert_allclose(np.abs(housing.shapes[12:, k]), sensors, atol=1e-6 * sensors.max())
    assert summary["modes"][0]["rigid"]["Tz"] == pytest.approx(0.71, abs=0.02)


def test_build_prints_what_the_modes_do(quick_file, tmp_path, capsys):
    assert main(["housing", "build", str(quick_file), "-o", str(tmp_path / "box.zip")]) == 0
    text = capsys.readouterr().out
    assert "Housing of 141.9 kg, 27321 unknowns: 6 normal and 12 residual modes" in text
    assert "Tz 71, Rx 28" in text
    assert read_housing(tmp_path / "box.zip").frequency_hz.size == 18


def test_plates_that_do_not_touch():
    """What the file's checks let through, the mesher finds."""
    apart = replace(D, foot_position=D.half_width + 0.02)
    with pytest.raises(HerringboneError, match="the housing's plates make 2 separate solids"):
        mesh_housing(apart, MESH_SIZE)


def test_mesh_that_fails(monkeypatch, tmp_path, capsys):
    import gmsh

    def fail(dimension: int) -> None:
        raise Exception("Invalid boundary mesh")  # noqa: TRY002 (as gmsh does)

    monkeypatch.setattr(gmsh.model.mesh, "generate", fail)
    monkeypatch.chdir(tmp_path)
    assert main(["housing", "build"]) == 2
    assert capsys.readouterr().err == (
        "herringbone: gmsh cannot mesh the housing: Invalid boundary mesh; change the dimensions "
        "or the mesh size\n"
    )
    assert not list(tmp_path.iterdir())
    assert not gmsh.isInitialized()


@pytest.mark.parametrize(("module", "tool"), [("gmsh", "gmsh"), ("skfem", "scikit-fem")])
def test_missing_tool(monkeypatch, tmp_path, capsys, module, tool):
    """One line that says what to install; nothing is written."""
    monkeypatch.setitem(sys.modules, module, None)
    for name in ("elasticity", "finite_elements", "mode_shares"):
        monkeypatch.delitem(sys.modules, f"herringbone.housing.welded.{name}", raising=False)
    monkeypatch.chdir(tmp_path)
    assert main(["housing", "build"]) == 2
    line = capsys.readouterr().err
    assert tool in line
    assert "pip install 'herringbone[fe]'" in line
    assert line.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_bad_mesh_size(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["housing", "build", "--mesh-size", "16"]) == 2
    assert capsys.readouterr().err == (
        "herringbone: --mesh-size: mesh size 16 m: it must be from 0.005 to 0.2 m\n"
    )
