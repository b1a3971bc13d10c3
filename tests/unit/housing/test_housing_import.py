"""Importers: each format is read back to its digits; one line for each defect."""

import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp
from support.fe_files import (
    NODES,
    SEATS,
    dmig_text,
    frame_model,
    frd_text,
    grid_text,
    modes_of,
    op4_text,
    text_2414,
)

from herringbone.components.ports import HALVES
from herringbone.core import HerringboneError
from herringbone.core.places.paths import component_folder
from herringbone.housing.files.writer import compliance_text
from herringbone.housing.importers import import_housing
from herringbone.housing.importers.dmig import read_dmig
from herringbone.housing.importers.frd import read_frd
from herringbone.housing.importers.mode_set import real_shape
from herringbone.housing.importers.op4 import read_op4
from herringbone.housing.importers.seat_file import read_seats
from herringbone.housing.importers.uff import read_uff

BAND = 500.0


@pytest.fixture(scope="module")
def model():
    return frame_model()


@pytest.fixture
def seats(tmp_path):
    (tmp_path / "seats.toml").write_text(SEATS)
    return tmp_path / "seats.toml"


@pytest.fixture
def placed(seats):
    """Seats of matrices, which have no coordinates."""
    seats.write_text(SEATS.replace("] }", "], position = [200, 30, 7] }"))
    return seats


def load(files, seats, **options):
    given = {"band_hz": BAND, "tolerance": 1e-12, "most_modes": 64} | options
    return import_housing(files if isinstance(files, list) else [files], seats, **given)


def refusal(action) -> str:
    with pytest.raises(HerringboneError) as caught:
        action()
    assert "\n" not in str(caught.value)
    return str(caught.value)


def seat_input(model):
    """(36, 12) by hand: gearbox x is y of the file, gearbox y is -x."""
    weights = {"pinion_left": {0: 0.25, 1: 0.5, 2: 0.25}}
    for n, name in enumerate(HALVES[1:], 1):
        weights[name] = dict.fromkeys(range(3 * n, 3 * n + 3), 1 / 3)
    found = np.zeros((3 * NODES, 12))
    for (n, name), axis in product(enumerate(HALVES), range(3)):
        of_file, sign = ((1, 1.0), (0, -1.0), (2, 1.0))[axis]
        for node, weight in weights[name].items():
            found[3 * node + of_file, 3 * n + axis] = sign * weight
    return found


def exact_receptance(model, frequency_hz):
    """Undamped, in m/N, by a solve in the file's units (mm, t, N)."""
    stiffness, mass, _ = model
    b = seat_input(model)
    return 1e-3 * b.T @ np.linalg.solve(stiffness - (2 * np.pi * frequency_hz) ** 2 * mass, b)


def assert_same_receptance(housing, model, rtol):
    undamped = replace(housing, damping_ratio=0.0 * housing.damping_ratio)
    for f in (0.0, 150.0, 460.0):
        expected = exact_receptance(model, f)
        found = undamped.receptance(np.array([f]))[0].real
        np.testing.assert_allclose(found, expected, atol=rtol * np.abs(expected).max())


# Matrix Market


@pytest.fixture
def matrix_files(tmp_path, model):
    files = [tmp_path / name for name in ("K.mtx", "M.mtx", "B.mtx")]
    scipy.io.mmwrite(files[0], sp.coo_array(model[0]), precision=17, symmetry="symmetric")
    scipy.io.mmwrite(files[1], sp.coo_array(model[1]), precision=17, symmetry="symmetric")
    scipy.io.mmwrite(files[2], seat_input(model), precision=17)
    return files


def test_matrix_market(matrix_files, placed, model):
    """36 unknowns fit whole, so the receptance is exact but for rounding."""
    housing = load(matrix_files[:2], placed)
    assert_same_receptance(housing, model, 1e-10)
    assert housing.boundary == "fixed"
    assert housing.valid_to_hz == BAND
    assert set(housing.damping_ratio) == {0.02}
    frequency, shapes = modes_of(model)
    np.testing.assert_allclose(housing.frequency_hz, frequency, rtol=1e-10)
    expected = np.abs(shapes[11, 2]) / np.sqrt(1e3)  # t^-1/2
    np.testing.assert_allclose(np.abs(housing.shape("A", "z")), expected, rtol=1e-8)


def test_matrix_market_with_labels(matrix_files, placed, model, tmp_path):
    """Rows in another order, named by a file."""
    order = np.random.default_rng(1).permutation(3 * NODES)
    for file, matrix in zip(matrix_files[:2], model[:2], strict=True):
        scipy.io.mmwrite(file, sp.coo_array(matrix[np.ix_(order, order)]), precision=17)
    (tmp_path / "rows.dof").write_text("".join(f"{r // 3 + 1}.{r % 3 + 1}\n" for r in order))
    placed.write_text(placed.read_text() + '[matrix]\nrows = "rows.dof"\n')
    assert_same_receptance(load(matrix_files[:2], placed), model, 1e-10)


def test_matrix_market_with_seat_input(matrix_files, model):
    """Without a seat file the matrices are in SI units: here those of the file, kg and m."""
    housing = load(matrix_files, None)
    expected = 1e3 * exact_receptance(model, 0.0)
    np.testing.assert_allclose(housing.static_compliance(), expected, rtol=1e-9)
    assert housing.source["positions"] == "not given"


# CalculiX


@pytest.fixture
def frd(tmp_path, model):
    def write(**options):
        path = tmp_path / "modes.frd"
        path.write_text(frd_text(*modes_of(model), model[2], **options))
        return path

    return write


@pytest.mark.parametrize("short", [False, True])
def test_frd_to_its_digits(frd, model, short):
    frequency, shapes = modes_of(model)
    found = read_frd(frd(short=short))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5e-7)  # 7 digits of its square
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)  # 6 digits
    np.testing.assert_allclose(found.coordinates, model[2], rtol=5.1e-6)
    np.testing.assert_array_equal(found.node, np.arange(1, NODES + 1))


def test_frd_becomes_a_housing(frd, seats, model):
    housing = load(frd(), seats)
    assert_same_receptance(housing, model, 3e-5)
    assert housing.kind == ("normal",) * 36
    expected = model[2][3:6].mean(axis=0) - [100, 0, 0]
    expected = 1e-3 * np.array([expected[1], -expected[0], expected[2]])
    np.testing.assert_allclose(housing.points[1].position, expected, rtol=1e-5)
    assert housing.frame.origin == (0.1, 0.0, 0.0)
    assert housing.source["tool"] == "CalculiX 2.20"


BAD_FRD = [
    (" 9999", "", "is truncated: the end mark 9999 is missing"),
    ("    1C", "    9C", "is no CalculiX result file"),
    (f"{'':37}1", f"{'':37}2", "it is binary; ask for ASCII output"),
    ("-4  DISP", "-4  TEMP", "it has no modal displacements; ask for *NODE FILE with U"),
    ("1PGM                1.0", "1PGM                0.0", "mode 1: modal mass 0; the mode has no"),
    (" -1         2", " -1         x", "is malformed"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD_FRD)
def test_bad_frd(frd, old, new, expected):
    path = frd()
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    assert expected in refusal(lambda: read_frd(path))


def test_modes_need_seats(frd, seats):
    assert "Give --seats SEATS.toml" in refusal(lambda: load(frd(), None))
    seats.write_text(SEATS.replace("valid_to_hz = 500", ""))
    assert "valid_to_hz is missing" in refusal(lambda: load(frd(), seats))
    seats.write_text(SEATS.replace("[4, 5, 6]", "[4, 5, 99]"))
    assert "seat pinion_right: the model has no node 99" in refusal(lambda: load(frd(), seats))


def test_static_compliance_completes_few_modes(tmp_path, seats, model):
    """Eight of 36 modes with the exact statics: pseudo modes carry the rest, positive."""
    frequency, shapes = modes_of(model)
    (tmp_path / "few.frd").write_text(frd_text(frequency[:8], shapes[..., :8], model[2]))
    static = exact_receptance(model, 0.0)
    (tmp_path / "static.csv").write_text(compliance_text(static))
    seats.write_text('static = "static.csv"\n' + SEATS)
    housing = load(tmp_path / "few.frd", seats)
    assert housing.kind.count("residual") <= 12
    # Negative parts of a residual that the file's 6 digits leave are cut off.
    np.testing.assert_allclose(
        housing.static_compliance(), static, atol=2e-5 * np.abs(static).max()
    )
    (tmp_path / "static.csv").write_text(compliance_text(0.1 * static))
    text = refusal(lambda: load(tmp_path / "few.frd", seats))
    assert "the modes are softer than the static compliance" in text


# Universal files


@pytest.fixture
def pyuff():
    return pytest.importorskip("pyuff", reason="pyuff is in the extra `import`")


def node_set(pyuff, coordinates):
    ones = np.ones(NODES, dtype=int)
    return pyuff.prepare_2411(
        np.arange(1, NODES + 1), ones, ones, ones, *coordinates.T, return_full_dict=True
    )


def shape_sets(pyuff, frequency, shapes, *, mass=2.0, zeta=0.03, eta=0.0):
    for n, f in enumerate(frequency):
        yield pyuff.prepare_55(
            id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE",
            model_type=1, analysis_type=2, data_ch=2, spec_data_type=8, data_type=2,
            n_data_per_node=3, load_case=1, mode_n=n + 1, freq=f, modal_m=mass,
            modal_damp_vis=zeta, modal_damp_his=eta, node_nums=np.arange(1, NODES + 1),
            r1=shapes[:, 0, n], r2=shapes[:, 1, n], r3=shapes[:, 2, n],
        )  # fmt: skip


def complex_sets(pyuff, frequency, shapes, angle, zeta=0.03):
    """Shapes turned by `angle` [rad] each, with the modal A of unit modal mass."""
    turn = np.exp(1j * angle)
    for n, f in enumerate(frequency):
        w = 2 * np.pi * f
        w_d = w * np.sqrt(1 - zeta**2)
        turned = shapes[:, :, n] * turn
        yield pyuff.prepare_55(
            id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE",
            model_type=1, analysis_type=3, data_ch=2, spec_data_type=8, data_type=5,
            n_data_per_node=3, load_case=1, mode_n=n + 1, eig=-zeta * w + 1j * w_d,
            modal_a=2j * w_d * np.mean(turn) ** 2, modal_b=0j, node_nums=np.arange(1, NODES + 1),
            r1=turned[:, 0], r2=turned[:, 1], r3=turned[:, 2],
        )  # fmt: skip


@pytest.fixture
def write_uff(pyuff, tmp_path, model):
    def write(*sets):
        path = tmp_path / "modes.unv"
        pyuff.UFF(str(path)).write_sets([node_set(pyuff, model[2]), *sets], "overwrite")
        return path

    return write


def test_uff_55_to_its_digits(pyuff, write_uff, seats, model):
    """Shapes of modal mass 2 are scaled to 1; six digits."""
    frequency, shapes = modes_of(model)
    path = write_uff(*shape_sets(pyuff, frequency, np.sqrt(2.0) * shapes))
    found = read_uff(path, read_seats(seats))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5.1e-6)
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)
    np.testing.assert_allclose(found.coordinates, model[2], rtol=1e-14)
    np.testing.assert_array_equal(found.damping_ratio, 0.03)
    housing = load(path, seats)
    assert_same_receptance(housing, model, 1e-4)
    assert housing.damping["source"] == "file"


@pytest.mark.parametrize(("zeta", "eta", "expected"), [(0, 0.05, 0.025), (0, 0, 0.02)])
def test_uff_damping(pyuff, write_uff, seats, model, zeta, eta, expected):
    """Half the loss factor; without either the seat file's 2 %."""
    path = write_uff(*shape_sets(pyuff, *modes_of(model), zeta=float(zeta), eta=float(eta)))
    np.testing.assert_allclose(load(path, seats).damping_ratio, expected, rtol=1e-5)


def test_complex_modes_that_are_nearly_real(pyuff, write_uff, seats, model):
    frequency, shapes = modes_of(model)
    path = write_uff(*complex_sets(pyuff, frequency, shapes, 0.7))
    found = read_uff(path, read_seats(seats))
    np.testing.assert_allclose(np.abs(found.shapes), np.abs(shapes), rtol=2e-5, atol=1e-4)
    np.testing.assert_allclose(found.frequency, frequency, rtol=1e-5)
    np.testing.assert_allclose(found.damping_ratio, 0.03, rtol=1e-4)


def test_complex_modes_are_refused(pyuff, write_uff, seats, model):
    """Phases between 0 and 180 degrees from node to node."""
    frequency, shapes = modes_of(model)
    angle = np.linspace(0.0, np.pi, NODES)[:, None]
    path = write_uff(*complex_sets(pyuff, frequency, shapes, angle))
    text = refusal(lambda: read_uff(path, read_seats(seats)))
    assert re.search(r"mode 1: the shape is complex, phase collinearity 0\.\d+ < 0.95", text)


def test_phase_collinearity_of_a_line_and_a_circle():
    line = np.exp(0.4j) * np.array([1.0, -2.0, 0.5])
    shape, factor = real_shape(line, "mode 1")
    np.testing.assert_allclose(factor * shape, line)
    circle = np.exp(2j * np.pi * np.arange(8) / 8)
    assert "collinearity 0.00" in refusal(lambda: real_shape(circle, "mode 1"))


def test_uff_2414_to_its_digits(pyuff, write_uff, seats, model):
    frequency, shapes = modes_of(model)
    path = write_uff()
    with path.open("a") as file:
        file.write("\n".join(text_2414(frequency, shapes)) + "\n")
    found = read_uff(path, read_seats(seats))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5.1e-6)
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)
    np.testing.assert_array_equal(found.damping_ratio, 0.04)


def test_bad_uff(pyuff, write_uff, seats, model):
    frequency, shapes = modes_of(model)
    given = read_seats(seats)

    def text(path):
        return refusal(lambda: read_uff(path, given))

    unscaled = write_uff(*shape_sets(pyuff, frequency, shapes, mass=0.0))
    assert "mode 1: modal mass 0; the mode has no scale" in text(unscaled)
    path = write_uff(*shape_sets(pyuff, frequency, shapes))
    whole = path.read_text()
    path.write_text(whole[: len(whole) - 300])
    assert "is truncated: the last data set does not end" in text(path)
    path.write_text(whole.replace("    -1", "    -2"))
    assert "is no universal file" in text(path)
    path.write_text("\n".join(whole.splitlines()[2 * NODES + 3 :]))
    assert "no data set 15 or 2411 holds nodes" in text(path)
    assert "no data set 55 or 2414 holds normal modes" in text(write_uff())
    units = pyuff.prepare_164(
        units_code=1, units_description="SI", temp_mode=1, length=1.0, force=1.0, temp=1.0,
        temp_offset=273.15,
    )  # fmt: skip
    expected = "says that a unit of length is 1 m and of mass 1 kg; "
    assert expected in text(write_uff(units, *shape_sets(pyuff, frequency, shapes)))


# Nastran


@pytest.fixture
def dmig(tmp_path, model):
    def write(**options):
        lines = ["$ comment", *grid_text(model[2])]
        for name, matrix in zip(("KAAX", "MAAX"), model[:2], strict=True):
            lines += dmig_text(name, matrix, **options)
        path = tmp_path / "model.pch"
        path.write_text("\n".join([*lines, "ENDDATA", ""]))
        return path

    return write


@pytest.mark.parametrize(
    ("options", "rtol"), [({}, 6e-10), ({"large": False}, 6e-3), ({"free": True}, 1e-15)]
)
def test_dmig_to_its_digits(dmig, model, options, rtol):
    found = read_dmig(dmig(**options))
    for matrix, expected in zip((found.stiffness, found.mass), model[:2], strict=True):
        np.testing.assert_allclose(matrix.toarray(), expected, rtol=rtol)
    np.testing.assert_allclose(found.coordinates[3], model[2][2], rtol=6e-10)


def test_dmig_becomes_a_housing(dmig, seats, model):
    assert_same_receptance(load(dmig(), seats), model, 1e-7)


def test_bad_dmig(dmig):
    path = dmig()
    whole = path.read_text()

    def text(old, new):
        assert old in whole
        path.write_text(whole.replace(old, new))
        return refusal(lambda: read_dmig(path))

    assert "one matrix whose name begins with M is needed; it has KAAX" in text("MAAX", "KAAX")
    head = "DMIG    KAAX           0       6       2"
    assert "form 1, type 2; form 6" in text(head, head.replace("6", "1"))
    assert "form 6, type 4" in text(head, head[:-1] + "4")
    assert "DMIG KAAX has no header card" in text(head, "$")
    assert "is malformed" in text("DMIG*   MAAX" + " " * 27 + "1", "DMIG*   MAAX" + " " * 27 + "?")


@pytest.fixture
def op4(tmp_path, model):
    def write(kind="dense", matrices=model[:2]):
        path = tmp_path / "model.op4"
        lines = [
            li for n, m in zip(("KAA", "MAA"), matrices, strict=True) for li in op4_text(n, m, kind)
        ]
        path.write_text("\n".join(lines) + "\n")
        return path

    return write


@pytest.mark.parametrize("kind", ["dense", "sparse", "big"])
@pytest.mark.parametrize("triangle", [False, True])
def test_op4_is_exact(op4, model, kind, triangle):
    matrices = [np.tril(m) for m in model[:2]] if triangle else model[:2]
    found = read_op4(op4(kind, matrices))
    np.testing.assert_array_equal(found.stiffness.toarray(), model[0])
    np.testing.assert_array_equal(found.mass.toarray(), model[1])


def test_op4_becomes_a_housing(op4, placed, model):
    assert_same_receptance(load(op4(), placed), model, 1e-10)


def test_bad_op4(op4):
    path = op4()
    whole = path.read_text()

    def text(content):
        path.write_bytes(content)
        return refusal(lambda: read_op4(path))

    assert "is a binary OUTPUT4 file; write it formatted" in text(b"\x18\x00\x00\x00" * 9)
    assert "truncated in matrix KAA" in text(whole.encode()[:3000])
    assert "line 1 is no OUTPUT4 header" in text(b"hello\n")
    complex_one = whole.replace("       6       2KAA", "       6       4KAA")
    assert "matrix KAA has type 4; real ones" in text(complex_one.encode())
    assert "begins with M is needed; it has KAA, XAA" in text(whole.replace("MAA", "XAA").encode())


# Everything


def test_kinds_of_files(tmp_path, seats):
    def text(*names):
        return refusal(lambda: load([tmp_path / name for name in names], seats))

    assert "'.op2' cannot be imported; export DMIG cards" in text("a.op2")
    assert "'.odb' cannot be imported; export modes as a universal file" in text("a.odb")
    assert "'.xyz' cannot be imported; it takes .mtx, .frd" in text("a.xyz")
    assert "only Matrix Market takes several files" in text("a.frd", "b.frd")
    for name in ("a.frd", "a.unv", "a.op4", "a.pch"):
        pytest.importorskip("pyuff", reason="pyuff is in the extra `import`")
        assert f"cannot read {tmp_path / name}" in text(name)


def test_bad_matrices(matrix_files, placed, seats, tmp_path):
    stiffness, mass, _ = matrix_files
    small = tmp_path / "small.mtx"
    scipy.io.mmwrite(small, sp.eye_array(6).tocoo())

    def text(files, where=placed):
        return refusal(lambda: load(files, where))

    assert "small.mtx is (6, 6); both must be square and of the same size" in text(
        [stiffness, small]
    )
    assert "1 Matrix Market file(s); give stiffness, mass" in text([stiffness])
    assert "small.mtx is (6, 6); the seat input must be (36, 12)" in text([stiffness, mass, small])
    assert "where are the seats?" in text([stiffness, mass], None)
    mass.write_text(mass.read_text()[:200])
    assert "M.mtx is no valid Matrix Market file" in text([stiffness, mass])


def test_sample_of_seats():
    """What the sample says, in SI units."""
    sample = read_seats(component_folder("modal_housing") / "seats.toml")
    assert [s.name for s in sample.selections] == [*HALVES, "A"]
    assert (sample.length, sample.mass, sample.time) == (1e-3, 1e3, 1.0)
    np.testing.assert_allclose(sample.selections[2].weights, np.array([1, 2, 1, 2]) / 6)
    assert sample.valid_to_hz == 2000.0


BAD_SEATS = [
    ("[seats]", "[seat]", "the file has the unknown key 'seat'"),
    ('"mm"', '"inch"', "unit of length 'inch' is none of m, mm"),
    ("wheel_right = ", "wheel_back = ", "seat wheel_right is missing; give [seats.wheel_right]"),
    ("[4, 5, 6]", "[4, 5.5]", "seat pinion_right: 'nodes' must be a list of node numbers"),
    ("[1, 2, 1] }", "[1, 2] }", "seat pinion_left: weights is missing or not 3 finite numbers"),
    ("[1, 2, 1] }", "[1, -2, 1] }", "the weights must have a positive sum"),
    ("[100, 0, 0]", "[100, 0]", "frame origin is missing or not 3 finite numbers"),
    ('["z"]', '["n"]', "sensor A: dof 'n' is none of x, y, z"),
    ("ratio = 0.02", 'ratio = "low"', "damping ratio is missing or not one finite number"),
    ("[frame]", "[frame", "cannot read"),
]


@pytest.mark.parametrize(("old", "new", "expected"), BAD_SEATS)
def test_bad_seats(seats, old, new, expected):
    assert old in SEATS
    seats.write_text(SEATS.replace(old, new))
    text = refusal(lambda: read_seats(seats))
    assert expected in text
    assert str(seats) in text
