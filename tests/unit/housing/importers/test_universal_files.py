"""Modes as universal files (55, 2414), read back to their digits."""

import logging
import re
from itertools import chain

import numpy as np
import pytest
from support.files.fe_files import NODES, SEATS, modes_of, text_2414
from support.imported_housing import assert_same_receptance, load, refusal

from herringbone.housing.importers.mode_set import real_shape
from herringbone.housing.importers.seat_file import read_seats
from herringbone.housing.importers.uff import read_uff


@pytest.fixture
def pyuff():
    return pytest.importorskip("pyuff", reason="pyuff is in the extra `import`")


def node_set(pyuff, coordinates, *, first=1, def_cs=1, disp_cs=1):
    ones = np.ones(len(coordinates), dtype=int)
    return pyuff.prepare_2411(
        first + np.arange(len(coordinates)), def_cs * ones, disp_cs * ones, ones, *coordinates.T,
        return_full_dict=True,
    )  # fmt: skip


def shape_sets(pyuff, frequency, shapes, *, mass=2.0, zeta=0.03, eta=0.0, nodes=NODES, **more):
    for n, f in enumerate(frequency):
        yield pyuff.prepare_55(
            id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE",
            model_type=1, analysis_type=2, data_ch=2, spec_data_type=8, data_type=2,
            n_data_per_node=3, load_case=1, mode_n=n + 1, freq=f, modal_m=mass,
            modal_damp_vis=zeta, modal_damp_his=eta, node_nums=np.arange(1, nodes + 1),
            r1=shapes[:nodes, 0, n], r2=shapes[:nodes, 1, n], r3=shapes[:nodes, 2, n],
        ) | more  # fmt: skip


def complex_sets(pyuff, frequency, shapes, angle, zeta=0.03, sign=1):
    """Shapes turned by `angle` [rad] each, with the modal A of unit modal mass.

    `sign` -1: their conjugates, `angle` then being that of these.
    """
    turn = np.exp(1j * angle)
    for n, f in enumerate(frequency):
        w = 2 * np.pi * f
        w_d = w * np.sqrt(1 - zeta**2)
        turned = shapes[:, :, n] * turn
        yield pyuff.prepare_55(
            id1="NONE", id2="NONE", id3="NONE", id4="NONE", id5="NONE",
            model_type=1, analysis_type=3, data_ch=2, spec_data_type=8, data_type=5,
            n_data_per_node=3, load_case=1, mode_n=n + 1, eig=-zeta * w + 1j * sign * w_d,
            modal_a=2j * sign * w_d * np.mean(turn) ** 2, modal_b=0j,
            node_nums=np.arange(1, NODES + 1), r1=turned[:, 0], r2=turned[:, 1], r3=turned[:, 2],
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


@pytest.mark.parametrize("signs", [(1, -1), (-1, 1), (-1,)])
def test_pairs_of_conjugate_modes_are_one_mode(pyuff, write_uff, seats, model, signs):
    frequency, shapes = modes_of(model)
    each = [complex_sets(pyuff, frequency, shapes, 0.7 * s, sign=s) for s in signs]
    found = read_uff(write_uff(*chain(*each)), read_seats(seats))
    np.testing.assert_allclose(np.abs(found.shapes), np.abs(shapes), rtol=2e-5, atol=1e-4)
    np.testing.assert_allclose(found.frequency, frequency, rtol=1e-5)
    np.testing.assert_allclose(found.damping_ratio, 0.03, rtol=1e-4)


def test_a_line_tells_modes_that_are_not_read(pyuff, write_uff, seats, model, caplog):
    """Not of modes that are there as displacements, too."""
    frequency, shapes = modes_of(model)
    displacements = list(shape_sets(pyuff, frequency, shapes))
    accelerations = list(shape_sets(pyuff, frequency, shapes, spec_data_type=12))
    velocities = [item | {"analysis_type": 7} for item in complex_sets(pyuff, frequency, shapes, 0)]

    def lines(*sets):
        caplog.clear()
        read_uff(write_uff(*sets), read_seats(seats))
        return [record.getMessage() for record in caplog.records]

    with caplog.at_level(logging.WARNING, logger="herringbone"):
        assert lines(*displacements, *accelerations, *velocities) == []
        said = lines(*displacements[:3], *accelerations[3:20], *velocities[20:])
    assert "modes.unv: 17 data sets 55 of analysis type 2, specific data type 12, are" in said[0]
    assert "modes.unv: 16 data sets 55 of analysis type 7, specific data type 8, are" in said[1]
    assert len(said) == 2


def test_frequencies_below_zero(pyuff, write_uff, seats, model):
    path = write_uff(*shape_sets(pyuff, *modes_of(model), freq=-10.0, mode_n=0))
    assert "mode 1 has the frequency -10 Hz, below zero" in refusal(lambda: load(path, seats))


def test_frequencies_are_in_hz(pyuff, write_uff, seats, model):
    seats.write_text(SEATS.replace('mass = "t"', 'mass = "t"\ntime = "ms"'))
    path = write_uff(*shape_sets(pyuff, *modes_of(model)))
    expected = "seats.toml: a unit of time is 0.001 s; frequencies of universal files are in Hz"
    assert expected in refusal(lambda: load(path, seats))


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
        for other in (2, 9, 11, 12):  # stress, reaction force, velocity, acceleration
            file.write("\n".join(text_2414(frequency, 1e5 * shapes, result=other)) + "\n")
    found = read_uff(path, read_seats(seats))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5.1e-6)
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)
    np.testing.assert_array_equal(found.damping_ratio, 0.04)


def test_modes_with_two_values_a_node_are_refused(pyuff, write_uff, seats, model):
    frequency, shapes = modes_of(model)
    path = write_uff()
    whole = path.read_text()
    modes = "\n".join(text_2414(frequency, shapes[:, :2])) + "\n"
    last = modes.splitlines()[-2]
    for text, node in ((modes, 1), (modes.replace(last, last + last[:13], 1), 1)):
        path.write_text(whole + text)
        message = refusal(lambda: read_uff(path, read_seats(seats)))
        assert f"mode 1: node {node} has fewer than three values" in message


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


ELEMENTS = """    -1
  2412
         1       115         1         1         7        -1
         1         2         3
    -1
"""
"""A data set that is not read; its record ends as a mark does."""


@pytest.mark.parametrize(
    "written",
    [
        lambda text: "\n".join(line.ljust(80) for line in text.splitlines()),
        lambda text: text.replace("    -1\n", "    -1 \n"),
        lambda text: text.replace("    -1\n", "    -1\r\n"),
        lambda text: ELEMENTS + text,
        lambda text: text + ELEMENTS + ELEMENTS,
    ],
    ids=["padded, without last line end", "one blank", "mixed line ends", "-1 before", "-1 after"],
)
@pytest.mark.parametrize("kind", [55, 2414])
def test_marks_as_programs_write_them(pyuff, write_uff, seats, model, written, kind):
    """All modes are there, whatever stands beside a mark."""
    frequency, shapes = modes_of(model)
    path = write_uff(*(shape_sets(pyuff, frequency, shapes, mass=1.0) if kind == 55 else ()))
    if kind == 2414:
        path.write_text(path.read_text() + "\n".join(text_2414(frequency, shapes)) + "\n")
    path.write_bytes(written(path.read_text()).encode())
    found = read_uff(path, read_seats(seats))
    np.testing.assert_allclose(found.frequency, frequency, rtol=5.1e-6)
    np.testing.assert_allclose(found.shapes, shapes, rtol=5.1e-6)


def test_marks_that_do_not_pair(pyuff, write_uff, seats, model):
    """Two marks too many, so that data sets would be what stands between them."""
    path = write_uff(*shape_sets(pyuff, *modes_of(model)))
    path.write_text(f"    -1\n{path.read_text()}    -1\n")
    text = refusal(lambda: read_uff(path, read_seats(seats)))
    assert "modes.unv: data set 1 does not begin with its number" in text


def test_nodes_in_two_sets(pyuff, tmp_path, seats, model):
    """Node 6 stands in both."""
    path = tmp_path / "modes.unv"
    shapes = list(shape_sets(pyuff, *modes_of(model)))

    def write(other):
        halves = node_set(pyuff, model[2][:6]), node_set(pyuff, other[5:], first=6)
        pyuff.UFF(str(path)).write_sets([*halves, *shapes], "overwrite")

    write(model[2])
    position = model[2][9:].mean(axis=0) - [100, 0, 0]
    expected = 1e-3 * np.array([position[1], -position[0], position[2]])
    np.testing.assert_allclose(load(path, seats).points[3].position, expected, rtol=1e-12)
    write(2.0 * model[2])
    assert "modes.unv: node 6 stands twice, at two places" in refusal(lambda: load(path, seats))


@pytest.mark.parametrize(
    ("systems", "expected"),
    [
        ({"disp_cs": 7}, "node 1 is in the displacement coordinate system 7, which is none of"),
        ({"def_cs": 3}, "node 1 is in the definition coordinate system 3, which is none of"),
        ({"disp_cs": np.arange(12) // 6}, "in the displacement coordinate systems 0 and 1; export"),
        ({"def_cs": np.arange(12) // 6}, "in the definition coordinate systems 0 and 1; export"),
    ],
)
def test_nodes_in_local_coordinates(pyuff, tmp_path, seats, model, systems, expected):
    path = tmp_path / "modes.unv"
    nodes = node_set(pyuff, model[2], **systems)
    pyuff.UFF(str(path)).write_sets([nodes, *shape_sets(pyuff, *modes_of(model))], "overwrite")
    assert expected in refusal(lambda: load(path, seats))


def test_nodes_without_a_shape(pyuff, write_uff, seats, model):
    """Not motionless; nodes that no seat or sensor has may be left out."""
    path = write_uff(*shape_sets(pyuff, *modes_of(model), nodes=NODES - 1))
    expected = "seat wheel_right: node 12 has no shape in mode 1 of modes.unv; export shapes at all"
    assert expected in refusal(lambda: load(path, seats))
    seats.write_text(SEATS.replace("[10, 11, 12]", "[10, 11]").replace("[12]", "[11]"))
    assert load(path, seats).frequency_hz.size == 3 * NODES


def test_modes_that_stand_in_two_kinds_of_data_sets(pyuff, write_uff, seats, model):
    frequency, shapes = modes_of(model)
    path = write_uff(*shape_sets(pyuff, frequency, np.sqrt(2.0) * shapes))
    with path.open("a") as file:
        file.write("\n".join(text_2414(frequency, -shapes)) + "\n")
    assert "modes.unv: mode 1 stands twice, with" in refusal(lambda: load(path, seats))


def test_modes_of_two_analyses(pyuff, write_uff, seats, model):
    """1 % apart they are no doubles; numbers below 1 are none, and doubles are known by shape."""
    frequency, shapes = modes_of(model)
    other = list(shape_sets(pyuff, 1.01 * frequency, shapes, load_case=2))
    path = write_uff(*shape_sets(pyuff, frequency, shapes), *other)
    said = f"modes.unv: mode 1 stands twice, with {frequency[0]:.5g}"
    assert said[:-1] in refusal(lambda: load(path, seats))
    path = write_uff()
    with path.open("a") as file:
        for f in (frequency, 1.01 * frequency):
            file.write("\n".join(text_2414(f, shapes)) + "\n")
    assert said[:-1] in refusal(lambda: load(path, seats))
    unnumbered = list(shape_sets(pyuff, frequency, shapes, mode_n=0))
    assert load(write_uff(*unnumbered), seats).frequency_hz.size == 3 * NODES
    twice = write_uff(*unnumbered, *shape_sets(pyuff, frequency, shapes, mode_n=0))
    assert "modes.unv: modes 1 and 37 are the same" in refusal(lambda: load(twice, seats))


TURN = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])


def system_2420(pyuff, label, matrix, kind=0):
    return pyuff.prepare_2420(
        Part_UID=1, Part_Name="NONE", CS_sys_labels=[label], CS_types=[kind], CS_colors=[8],
        CS_names=["CS"], CS_matrices=[matrix], return_full_dict=True,
    )  # fmt: skip


def system_18(pyuff, label, axes, origin, reference=0):
    whole = {name: np.array([value]) for name, value in (
        ("cs_num", label), ("cs_type", 0), ("ref_cs_num", reference), ("color", 1), ("method", 1),
        ("ref_o", origin), ("x_point", origin + 2 * axes[0]),
        ("xz_point", origin + axes[0] + axes[2]),
    )}  # fmt: skip
    return pyuff.prepare_18(**whole, cs_name=["CS"], return_full_dict=True)


def test_systems_that_are_the_global_one_or_not_used(pyuff, write_uff, model, seats):
    plain = np.vstack([np.eye(3), np.zeros(3)])
    path = write_uff(
        system_2420(pyuff, 1, plain),
        system_2420(pyuff, 4, np.vstack([TURN, np.zeros(3)])),
        system_18(pyuff, 1, np.eye(3), np.zeros(3)),
        *shape_sets(pyuff, *modes_of(model)),
    )
    assert load(path, seats).frequency_hz.size == 3 * NODES


def test_a_global_label_of_a_system_in_another_one(pyuff, write_uff, model, seats):
    """Its points are as those of the global one, but in the coordinates of system 5."""
    system = system_18(pyuff, 1, np.eye(3), np.zeros(3), reference=5)
    path = write_uff(system, *shape_sets(pyuff, *modes_of(model)))
    said = refusal(lambda: load(path, seats))
    assert "node 1 is in the definition coordinate system 1, which data set 18 turns" in said


@pytest.mark.parametrize("shift", [0.0, 0.3])
@pytest.mark.parametrize("kind", ["2420", "2420, cylindrical", "18"])
def test_a_global_label_of_a_local_system(kind, shift, pyuff, write_uff, model, seats):
    origin = np.full(3, shift)
    axes = TURN if shift == 0.0 and kind != "2420, cylindrical" else np.eye(3)
    system = (
        system_18(pyuff, 1, axes, origin)
        if kind == "18"
        else system_2420(pyuff, 1, np.vstack([axes, origin]), int("cyl" in kind))
    )
    path = write_uff(system, *shape_sets(pyuff, *modes_of(model)))
    said = refusal(lambda: load(path, seats))
    assert "node 1 is in the definition coordinate system 1, which data set " + kind[:2] in said
