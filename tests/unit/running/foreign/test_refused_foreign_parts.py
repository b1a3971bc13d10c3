"""What needs all equations says what it cannot make of a foreign part, and what to do."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

import herringbone as hb
from herringbone.core import StructureError
from herringbone.running.exporting import system_fmu
from herringbone.running.loading import load_system
from herringbone.running.operating import modes
from herringbone.scenes import Scene

UNKNOWN = "gearbox.modal_housing is a foreign FMU: its equations are not known, so that "


@pytest.fixture
def rig():
    """With an FMU in the place of the housing; nothing here opens it."""
    return load_system("test_rig")[0].with_fmu("modal_housing", Path("Mine.fmu"))


def test_natural_modes(rig, monkeypatch):
    monkeypatch.setattr(modes, "prepared", lambda *_: SimpleNamespace(system=rig, notes=()))
    said = f"{UNKNOWN}the system's natural modes cannot be computed; take components in their place"
    with pytest.raises(StructureError, match=said):
        hb.modes("test_rig")


def test_a_system_as_one_fmu(rig, monkeypatch, tmp_path):
    both = replace(
        rig, parts=tuple(replace(p, component=None, fmu=Path("M.fmu")) if p.name == "drive_motor"
                         else p for p in rig.parts),
    )  # fmt: skip
    monkeypatch.setattr(system_fmu, "ready_leaner", lambda *_: (both, Scene("own"), ()))
    said = (
        rf"{UNKNOWN}the system cannot become a single FMU; leave it out "
        r'\(outside=\["gearbox\.modal_housing"\]\), or export an \.ssp'
    )
    with pytest.raises(StructureError, match=said):
        system_fmu.export_fmu("test_rig", tmp_path / "rig.fmu", outside=["drive_motor"])
