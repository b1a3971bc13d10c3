"""What trials of foreign FMUs told once is told again by another process, without them."""

import shutil

import pytest
from support.foreign.kinds import build_kinds, without_states

from herringbone.analysis.stability.limits import stability
from herringbone.analysis.stability.report import stability_summary, stability_text
from herringbone.core.caching import tried as caching
from herringbone.core.caching.tried import forget_tried, tried_folder
from herringbone.cosim.algorithms import parse_algorithm
from herringbone.cosim.signature import laboratory
from herringbone.cosim.structure.system_file import read_system
from herringbone.running.foreign.surrogates import opened_surrogates

STEP = 1e-4
SYSTEM = """
name = "shaken"
connections = [["drive.flange.tau", "wheel.f"], ["wheel.x", "drive.flange.phi"],
               ["wheel.v", "drive.flange.w"]]

[parts]
drive = {{ fmu = "{drive}" }}
wheel = {{ fmu = "oscillator_mass.fmu", set = {{ m = 0.5, c = 0.1, v0 = 1.0 }} }}
"""


@pytest.fixture(params=["saves states", "saves none"])
def system(request, tmp_path, monkeypatch):
    """A drive with a shaft inside, and a body; nothing is known of either."""
    monkeypatch.setattr(caching, "cache_root", lambda: tmp_path / "cache")
    drive = build_kinds(tmp_path, "c_e_drive.c", "oscillator_mass.c") / "c_e_drive.fmu"
    if request.param == "saves none":
        drive = without_states(drive)
    text = SYSTEM.format(drive=drive.name)
    (tmp_path / "system.toml").write_text(text, encoding="utf-8")
    return read_system(tmp_path)


@pytest.fixture
def tried(monkeypatch):
    """Names of the instances that trials make."""
    made = []

    class Counted(laboratory.Trial):
        def __init__(self, part, *arguments):
            made.append(part.name)
            super().__init__(part, *arguments)

    monkeypatch.setattr(laboratory, "Trial", Counted)
    return made


def told(system):
    """What is told of limits, and the models to the bit."""
    with opened_surrogates(system, STEP) as found:
        known = stability(
            system, "", [parse_algorithm("jacobi:order=1")], strangers=found.strangers
        )
        models = {
            name: [x.tobytes() for x in (s.surrogate.model.a, s.surrogate.model.b)]
            for name, s in found.strangers.items()
        }
    return stability_text(known), stability_summary(known), models


def test_limits_and_models_are_the_same_without_trials(system, tried):
    """Signatures and limits of the first time are dropped: all trials are asked for again."""
    first = told(system)
    made = len(tried)
    assert made > 2  # of each part one at least, for its signature and for its model
    shutil.rmtree(tried_folder("signatures"))
    assert told(system) == first
    assert len(tried) == made
    forget_tried()
    assert told(system) == first
    assert len(tried) == 2 * made
