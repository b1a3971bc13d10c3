"""A start that is not found is refused with what is hardly meant in the system's data."""

from dataclasses import replace

import pytest

from herringbone.core import EquilibriumError
from herringbone.core.places.paths import component_folder
from herringbone.housing import read_housing
from herringbone.housing.files.writer import write_housing
from herringbone.running import prepared
from herringbone.running.prepared import Wishes


def _nothing_found(*_):
    raise EquilibriumError("no steady rotation was found")


def test_a_housing_in_another_unit(tmp_path, monkeypatch):
    """kHz under Hz: a million times too soft."""
    own = read_housing(component_folder("modal_housing") / "resources")
    soft = replace(own, frequency_hz=1e-3 * own.frequency_hz, static=None)
    write_housing(soft, tmp_path / "soft")
    monkeypatch.setattr(prepared, "started", _nothing_found)
    said = (
        r"^gearbox\.modal_housing: the static stiffness at the seats is [0-9]+ N/m in the mean, .*"
        "of another unit.; no steady rotation was found$"
    )
    with pytest.raises(EquilibriumError, match=said):
        prepared.prepared("test_rig", None, Wishes(housing=tmp_path / "soft"))
    with pytest.raises(EquilibriumError, match=r"^no steady rotation was found$"):
        prepared.prepared("test_rig", None, Wishes())
