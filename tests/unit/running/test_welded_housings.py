"""Housings of dimensions in the cache: made once, whoever asks, and whole; data in a run."""

import shutil
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from herringbone.core.places.paths import CACHE_VARIABLE
from herringbone.cosim.structure.system_file import read_system
from herringbone.housing import default_housing, read_housing, write_housing
from herringbone.housing.welded import build, default_data
from herringbone.running.housings.given import with_housing_data


@pytest.fixture
def made(monkeypatch, tmp_path):
    """How often a housing was made."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    found = []

    def built(design):
        found.append(design)
        return SimpleNamespace(model=default_housing())

    monkeypatch.setattr(build, "build_housing", built)
    return found


@pytest.fixture
def used(tmp_path):
    """Function: folder of the modal data of a file of dimensions."""
    file = tmp_path / "mine.toml"
    shutil.copy(default_data.DESIGN, file)

    def folder():
        system = with_housing_data(read_system("gearbox"), {"modal_housing": file})
        return Path(system.part("modal_housing").values["modes"]).parent

    return folder


def test_it_is_made_once_and_damage_is_mended_once(made, used):
    folder = used()
    assert used() == folder
    assert len(made) == 1
    with (folder / "modes.csv").open("a") as file:
        file.write("#")
    for _ in range(3):
        assert used() == folder
        assert len(made) == 2
    assert read_housing(folder).frequency_hz.tolist() == default_housing().frequency_hz.tolist()


def test_who_asks_for_one_that_another_one_makes_waits_for_it(made, used):
    with ThreadPoolExecutor(4) as pool:
        assert len({future.result() for future in [pool.submit(used) for _ in range(4)]}) == 1
    assert len(made) == 1


def test_a_residual_matrix_that_a_run_leaves_out_is_told_once(tmp_path, caplog):
    housing = default_housing()
    write_housing(replace(housing, residual=1e-10 * np.eye(12)), tmp_path / "tested")
    for _ in range(2):
        with_housing_data(read_system("gearbox"), {"modal_housing": tmp_path / "tested"})
    (record,) = caplog.records
    assert "too stiff without residual.csv; 'herringbone housing reduce" in record.getMessage()
