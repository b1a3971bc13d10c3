"""Files of teeth that deviate and of the law of a pair of teeth: what is taken and what refused."""

import math

import numpy as np
import pytest
from support.gearing.deviating_teeth import PAIR, UNIT, write_law, write_teeth
from support.gearing.gear_mesh import STATES, gear_pair, write_errors

from herringbone.components.gear_mesh.teeth import toothed
from herringbone.core import ResourceError
from herringbone.core.places.paths import component_folder
from herringbone.gears.stiffness.pair_law import pair_law
from herringbone.gears.stiffness.slices import SliceMesh

SHIPPED = component_folder("gear_mesh") / "resources" / "mesh_stiffness.csv"


@pytest.fixture(scope="module")
def law(tmp_path_factory):
    return write_law(tmp_path_factory.mktemp("law") / "law.csv", SliceMesh(PAIR, slices=20))


@pytest.fixture
def teeth(tmp_path):
    return write_teeth(tmp_path / "teeth.csv", 6)


def changed(file, old, new, count=1):
    text = file.read_text()
    assert old in text
    other = file.with_name(f"changed-{file.name}")
    other.write_text(text.replace(old, new, count))
    return other


def refusal(teeth, law=None):
    laws = {} if law is None else {"pair_law": str(law)}
    with pytest.raises(ResourceError) as caught:
        gear_pair(SHIPPED, {"tooth_deviations": str(teeth), **laws})
    return str(caught.value)


def test_no_law(teeth):
    said = refusal(teeth)
    assert "no_pair_law.csv has no law of a pair of teeth" in said
    assert "set pair_law" in said


def test_a_file_of_zeros_needs_no_law():
    gear_pair(SHIPPED)


def test_law_of_another_pair(teeth, law):
    other = changed(law, "# pair_law: 27 81", "# pair_law: 23 81")
    said = refusal(teeth, other)
    assert "changed-law.csv is the law of teeth of the pair z 23/81" in said
    assert "the parameters are of z 27/81" in said


def test_the_hand_of_the_law_does_not_matter(teeth, law):
    """Its overlap ratio is that of the face width, whichever way the teeth lean."""
    header = next(line for line in law.read_text().splitlines() if "pair_law:" in line)
    *_, angle, _, _, _, _ = header.split()
    other = changed(law, f" {angle} ", f" -{angle} ")
    forces = []
    for file in (law, other):
        pair = {"tooth_deviations": str(teeth), "pair_law": str(file), "ramp_turns": 0.0}
        found = gear_pair(SHIPPED, {**pair, "approach": 5e-6})
        forces.append(found["mesh_left.force"])
    assert forces[0] == forces[1] > 0.0


def test_teeth_missing(teeth, law):
    rows = teeth.read_text().splitlines()
    row = next(r for r in rows if r.startswith("left,drive,wheel,81,"))
    said = refusal(changed(teeth, f"{row}\n", ""), law)
    assert "27 teeth of the pinion and 80 of the wheel; the pair has 27 and 81" in said


def test_gear_missing(teeth, law):
    rows = [r for r in teeth.read_text().splitlines() if not r.startswith("right,drive,pinion")]
    other = teeth.with_name("other.csv")
    other.write_text("\n".join(rows) + "\n")
    assert "0 teeth of the pinion and 81 of the wheel" in refusal(other, law)


@pytest.mark.parametrize(
    ("new", "said"),
    [
        ("left,drive,pinion,1,", "tooth 1 of a flank of a gear stands twice"),
        ("left,drive,pinion,2.5,", "tooth 2.5 must be a whole number from 1 to 400"),
        ("left,drive,pinion,0,", "tooth 0 must be a whole number"),
        ("left,drive,pinion,28,", "tooth 28 of a flank of a gear, of which 27 teeth stand there"),
        ("left,both,pinion,2,", "flank 'both' is none of drive, coast"),
    ],
)
def test_rows_that_are_no_tooth(teeth, law, new, said):
    assert said in refusal(changed(teeth, "left,drive,pinion,2,", new), law)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (" 48 0.0", " 4.5 0.0", "n 4.5 must be a whole number from 4"),
        ("\n0.000000000,-3.0000,", "\n0.000000000,-2.0000,", "has position 0 and tilt -2 where 0"),
        ("depth8", "depth8,depth9", "fields, 12 expected"),
    ],
)
def test_rows_that_are_no_node(teeth, law, old, new, said):
    assert said in refusal(teeth, changed(law, old, new))


def test_negative_stiffness(teeth, law):
    lines = law.read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("1.000000000,0.0000,"))
    lines[at] = lines[at].replace(",0.0000,", ",0.0000,-", 1)
    other = law.with_name("negative.csv")
    other.write_text("\n".join(lines) + "\n")
    assert "at position 1, tilt 0 must not be negative" in refusal(teeth, other)


def test_row_missing(teeth, law):
    lines = law.read_text().splitlines()
    other = law.with_name("short.csv")
    other.write_text("\n".join(lines[:-1]) + "\n")
    assert "give 9 in each of the 33 rows of every position" in refusal(teeth, other)


def test_teeth_come_round(teeth, law):
    """Pairs repeat after 81 mesh periods, not after 27; a scaled file gives another force."""
    gear = gear_pair(SHIPPED, {"tooth_deviations": str(teeth), "pair_law": str(law)})
    forces = [toothed(gear.block, 0, 0, 0.3 + p, 3e-6, 1.0)[0] for p in (0, 27, 81, -81, 8100)]
    np.testing.assert_allclose([forces[2], forces[3], forces[4]], forces[0], rtol=1e-9)
    assert abs(forces[1] / forces[0] - 1.0) > 0.01


@pytest.mark.parametrize(("phase", "depth", "ramp"), [(0.31, 6e-6, 1.0), (27.8, 9e-6, 0.4)])
def test_forces_are_slopes_of_the_energy(teeth, law, phase, depth, ramp):
    """Central differences, whose own error goes with the square of the step."""
    gear = gear_pair(SHIPPED, {"tooth_deviations": str(teeth), "pair_law": str(law)})

    def contact(phase, depth, ramp):
        return np.array(toothed(gear.block, 0, 0, phase, depth, ramp))

    def slope(what, by):
        after, before = (
            contact(*(np.array([phase, depth, ramp]) + sign * np.array(by))) for sign in (1, -1)
        )
        return (after - before)[what] / (2.0 * np.max(by))

    force, tangent, of_phase, of_ramp, _, energy = contact(phase, depth, ramp)
    assert energy > 0.0
    assert force == pytest.approx(slope(-1, (0.0, 1e-9, 0.0)), rel=1e-6)
    assert tangent == pytest.approx(slope(0, (0.0, 1e-9, 0.0)), rel=1e-5)
    assert of_phase == pytest.approx(slope(-1, (1e-5, 0.0, 0.0)), rel=1e-4)
    assert of_ramp == pytest.approx(slope(-1, (0.0, 0.0, 1e-4)), rel=1e-4)


def test_depth_where_teeth_press(teeth, law):
    """With ideal teeth it is the depth; teeth that are apart have none."""
    gear = gear_pair(SHIPPED, {"tooth_deviations": str(teeth), "pair_law": str(law)})
    assert toothed(gear.block, 0, 0, 0.3, 3e-6, 0.0)[4] == pytest.approx(3e-6, rel=1e-12)
    assert toothed(gear.block, 0, 0, 0.3, -1e-4, 1.0) == (0.0,) * 6


@pytest.mark.parametrize("ramp_turns", [0.0, 1.0])
def test_frozen_mesh_keeps_the_operating_point(teeth, law, tmp_path, ramp_turns):
    """Accelerations are those before, and the stiffness the one that was asked for."""
    errors = write_errors(tmp_path / "e.csv", [("left", "drive", "wheel", 1, 1e-6, 0.3)])
    files = {"tooth_deviations": str(teeth), "pair_law": str(law), "tooth_errors": str(errors)}
    gear = gear_pair(SHIPPED, {"ramp_turns": ramp_turns, **files})
    for name, value in {"approach": 9e-6, "angle": 0.4, "der(angle)": 50.0}.items():
        gear.set(name, value)
    rhs, out, before, after = *gear.component.kernels[1:], *np.zeros((2, STATES))
    out(gear.block, 0.0)
    force = gear["mesh_left.force"]
    assert force > 100.0
    rhs(gear.block, 0.0, before)
    gear.component.freeze(gear, lambda tangents: 1e9)
    rhs(gear.block, 0.0, after)
    np.testing.assert_allclose(after, before, rtol=1e-6, atol=1e-9 * np.abs(before).max())
    gear.set("approach", 9e-6 + 1e-9)
    out(gear.block, 0.0)
    rise = gear["mesh_left.force"] - force
    assert rise == pytest.approx(1e9 * 1e-9 * math.cos(gear["base_helix_angle"]), rel=1e-3)


def test_nodes_span_the_way_of_a_pair():
    """No pair touches at the outer nodes, where the law counts as zero."""
    law = pair_law(SliceMesh(PAIR, slices=10), UNIT)
    ratio = PAIR.total_contact_ratio
    assert law.per_period == 48
    assert law.positions[0] < 0.0 < ratio < law.positions[-1]
    assert not law.stiffness[[0, 1, 2, -2, -1]].any()
