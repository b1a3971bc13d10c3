"""What two-way coupling of bearings and housing changes on the test rig; the README's numbers."""

import re
from dataclasses import replace

import numpy as np
import pytest

import herringbone as hb
from herringbone.analysis.twin.monolithic import Twin
from herringbone.components.modal_housing import MODAL_HOUSING
from herringbone.housing import default_housing, write_housing
from herringbone.running import loading, start

STIFFENING = 1e-4
"""Factor on the shapes: the seats move 1e-8 as much, so the bearings stand on rigid ground."""
T_END, STEP = 0.2, 1e-5
BELOW_HZ = 300.0


@pytest.fixture(scope="module")
def one_way(tmp_path_factory) -> dict[str, str]:
    """Values that make the housing rigid."""
    folder = tmp_path_factory.mktemp("rigid")
    housing = default_housing()
    rigid = replace(housing, shapes=STIFFENING * housing.shapes, static=None, gram=None)
    write_housing(replace(rigid, certificate={}), folder)
    return {f"modal_housing.{name}": str(folder / f"{name}.csv") for name in ("modes", "shapes")}


def told(pattern: str) -> list[float]:
    """Numbers in the component's equations, which are its README."""
    text = " ".join(MODAL_HOUSING.equations.split())
    found = re.search(pattern, text)
    assert found, f"the equations of modal_housing do not tell '{pattern}'"
    return [float(number) for number in found.groups()]


def vibration(values: dict[str, str]) -> dict[str, float]:
    """Rms of bearing forces about their mean [N], both halves together."""
    result = hb.run("test_rig", t_end=T_END, step=STEP, fmu="in-process", values=values)
    late = result.data[result.data["time"] > T_END / 3]
    return {
        f"{gear} {axis}": float(
            np.sqrt(
                (
                    late[result.columns(f"bearing_supports.shaft.{gear}_*.f_{axis}")].std() ** 2
                ).mean()
            )
        )
        for gear, axis in (("pinion", "y"), ("wheel", "y"), ("wheel", "z"))
    }


def test_bearing_forces(one_way):
    """Ratios of the vibration with the housing's motion to that without."""
    with_motion, without = vibration({}), vibration(one_way)
    number = r"(\d+\.\d+)"
    expected = told(
        f"a factor of {number} radially at the pinion, {number} radially and {number} axially at "
        "the wheel"
    )
    found = [with_motion[name] / without[name] for name in with_motion]
    # The axial vibration is a slow beat of lightly damped modes.
    assert found[:2] == pytest.approx(expected[:2], rel=0.05)
    assert found[2] == pytest.approx(expected[2], rel=0.1)


def frequencies(values: dict[str, str], below: float = BELOW_HZ) -> np.ndarray:
    """Damped structural modes of the rig below the limit [Hz]; slower ones are of the drive."""
    system, folder = loading.load_system("test_rig")
    scene = loading.load_scene(folder, None)
    system, _ = start.started(system, replace(scene, values={**scene.values, **values}))
    twin = Twin(system)
    x = twin.state.copy()
    sizes = np.maximum(1e-6 * np.abs(x), 1e-9)
    jacobian = np.empty((x.size, x.size))
    for k, size in enumerate(sizes):
        sides = []
        for sign in (1.0, -1.0):
            moved = x.copy()
            moved[k] += sign * size
            sides.append(twin.rhs(0.0, moved).copy())
        jacobian[:, k] = (sides[0] - sides[1]) / (2.0 * size)
    values = np.linalg.eigvals(jacobian)
    found = np.sort(np.abs(values[values.imag > 1.0])) / (2.0 * np.pi)
    return found[(found > 100.0) & (found < below)]


def test_lowest_modes(one_way):
    number = r"(\d+\.?\d*)"
    wheel, housing, both, torsion, hardly_changed = told(
        f"has its mode at {number} Hz, the housing alone its lowest at {number} Hz; coupled, the "
        f"lowest mode of both lies at {number} Hz. The torsional mode of drive motor and coupling "
        f"hardly changes: from {number} to {number} Hz"
    )
    alone = frequencies(one_way, 1.01 * wheel)
    np.testing.assert_allclose(alone, [torsion, housing, wheel], rtol=1e-3)
    np.testing.assert_allclose(frequencies({}), [both, hardly_changed], rtol=1e-3)


def test_stated_choice_is_that_of_a_rigid_housing(one_way):
    """`seat_motion` 0 takes the seats' motion out of the bearings, whatever the housing does."""
    chosen = vibration({"bearing_supports.seat_motion": 0.0})
    without = vibration(one_way)
    assert chosen == pytest.approx(without, rel=1e-4)


def test_stated_choice_is_told():
    """By runs and steady states, with the part that is driven one way."""
    values = {"bearing_supports.seat_motion": 0.0}
    for found in (
        hb.steady("gearbox", values=values).notes,
        hb.run("test_rig", t_end=1e-3, fmu="in-process", values=values).info.notes,
    ):
        (line,) = [note for note in found if note.startswith("one way: ")]
        assert "bearing_supports stands on rigid ground" in line
        assert "modal_housing, whose motion does not act back" in line
    assert not any(note.startswith("one way") for note in hb.steady("gearbox").notes)
