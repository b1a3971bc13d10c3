"""A hand-written housing in C takes the place of the component, and moves as its modes say."""

from itertools import product
from pathlib import Path

import numpy as np
import pytest
from support.foreign.c_housing import c_housing_fmu
from support.housing import seat_points

import herringbone as hb
from herringbone.commands import main as cli
from herringbone.housing import ModalHousing, write_housing

MASS, DAMPING_TIME = 40.0, 5e-6
STIFFNESS, COUPLING = np.array([7e8, 7e8, 1.5e8]), np.array([1e8, 1e8, 8e7])


@pytest.fixture(scope="module")
def c_housing(tmp_path_factory) -> Path:
    return c_housing_fmu(tmp_path_factory.mktemp("c_housing"))


@pytest.fixture(scope="module")
def same_as_modes(tmp_path_factory) -> Path:
    """The modes in closed form: the seats of a gear together, and against each other."""
    omega, shapes = [], []
    for gear, axis, sign in product(range(2), range(3), (1.0, -1.0)):
        square = (STIFFNESS[axis] + (1.0 - sign) * COUPLING[axis]) / MASS
        shape = np.zeros(12)
        shape[6 * gear + axis], shape[6 * gear + 3 + axis] = 1.0, sign
        omega.append(np.sqrt(square))
        shapes.append(shape / np.sqrt(2.0 * MASS))
    order = np.argsort(omega)
    omega, shapes = np.array(omega)[order], np.array(shapes)[order]
    housing = ModalHousing(
        ("normal",) * 12,
        omega / (2 * np.pi),
        0.5 * DAMPING_TIME * omega,
        seat_points(),
        shapes.T,
        500.0,
        {"model": "viscous-modal", "source": "closed form"},
        static=np.linalg.inv(_stiffness()),
    )
    folder = tmp_path_factory.mktemp("modes")
    assert write_housing(housing, folder) == []
    return folder


def _stiffness() -> np.ndarray:
    one = np.block([
        [np.diag(STIFFNESS + COUPLING), np.diag(-COUPLING)],
        [np.diag(-COUPLING), np.diag(STIFFNESS + COUPLING)],
    ])  # fmt: skip
    return np.kron(np.eye(2), one)


def test_contract(c_housing, same_as_modes, capsys):
    """Also its statics against the modes, which are exact."""
    command = ["check", str(c_housing), "--as", "housing", "--against", str(same_as_modes)]
    assert cli.main(command) == 0, capsys.readouterr().out
    assert "36 of 36" in capsys.readouterr().out


def test_moves_as_its_modes(c_housing, same_as_modes):
    """In the rig: Euler's steps of 1 us against the exact propagator, both held over 2 us."""
    options = {"t_end": 0.004, "step": 2e-6, "algorithm": "jacobi", "start": "ramp"}
    tables = {
        f"modal_housing.{name}": str(same_as_modes / f"{name}.csv") for name in ("modes", "shapes")
    }
    swapped = hb.run("test_rig", replace_parts={"modal_housing": c_housing}, **options)
    modal = hb.run("test_rig", values=tables, **options)
    columns = modal.channel("seat_velocity")
    expected = modal.data[columns].to_numpy()
    found = swapped.data[columns].to_numpy()
    assert not [note for note in swapped.info.notes if "contract" in note]
    # Euler shifts a line of w by w h / 2 of phase: 0.3 % at 1000 Hz.
    assert np.abs(found - expected).max() <= 0.01 * np.abs(expected).max()
    assert np.abs(expected).max() > 1e-6


@pytest.fixture(scope="module")
def converged(c_housing):
    return _bearing_forces(c_housing, "li:degree=3", 1e-6)


def _bearing_forces(file, algorithm, step):
    """Every 0.1 ms for 5 ms while the load rises; short if the run ends early."""
    data = hb.run(
        "test_rig", algorithm=algorithm, step=step, t_end=0.005, record_step=1e-4,
        replace_parts={"modal_housing": file}, start="ramp",
    ).data  # fmt: skip
    names = [name for name in data if ".bearing_supports.shaft." in name and ".f_" in name]
    assert len(names) == 8  # y and z at four seats
    return data[names].to_numpy()


@pytest.mark.parametrize("step", [5e-6, 10e-6, 20e-6])
def test_no_worse_than_parallel_jacobi(c_housing, converged, step):
    """It saves no states: it takes each step once, and makes up in the next one for what it missed.

    What is left below 0.1 % is mostly Euler's: its inner steps depend on those that it is given.
    """
    off = np.linalg.norm(_bearing_forces(c_housing, None, step) - converged)
    assert off < 1e-3 * np.linalg.norm(converged - converged.mean(axis=0))
    parallel = _bearing_forces(c_housing, "jacobi:order=0,schedule=parallel", step)
    if parallel.shape == converged.shape:
        assert off < np.linalg.norm(parallel - converged)
