"""A gearbox as one FMU, its housing outside, in the test rig: against the rig of single FMUs."""

from dataclasses import replace

import numpy as np
import pytest
from support.compiler import needs_compiler

from herringbone.core import HerringboneError
from herringbone.cosim.algorithms import LI
from herringbone.cosim.structure.system import PartSpec
from herringbone.fmi.check import check_fmu, without_unit
from herringbone.running.api import run
from herringbone.running.exporting.system_fmu import export_fmu
from herringbone.running.loading import load_scene, load_system
from herringbone.running.start import started
from herringbone.scenes import Scene, Start

INSIDE = ("gearbox.gear_mesh", "gearbox.bearing_supports")
STEP, T_END = 40e-6, 2e-3


def test_a_system_that_cannot_be_one_fmu_is_refused(tmp_path):
    with pytest.raises(HerringboneError, match=r"box.ssp: .* must end in .fmu"):
        export_fmu("gearbox", tmp_path / "box.ssp")
    with pytest.raises(HerringboneError, match="has no part 'hull'"):
        export_fmu("gearbox", tmp_path / "box.fmu", outside=["hull"])


@pytest.mark.slow
@needs_compiler
def test_gearbox_in_one_fmu_gives_the_forces_of_the_rig(tmp_path):
    system, folder = load_system("test_rig")
    scene = replace(load_scene(folder, "loaded"), t_end=T_END, record_step=STEP)
    others = [part.name for part in system.parts if part.name not in INSIDE]
    box = export_fmu("test_rig", tmp_path / "box.fmu", outside=others, scene=scene)
    assert check_fmu(box) == without_unit(box) == []

    structure, _ = started(system, scene)

    def inside(path):
        return structure.split(path)[0] in INSIDE

    def moved(path):
        return f"box.{path}" if inside(path) else path

    joined = replace(
        structure,
        parts=(*(p for p in structure.parts if p.name in others), PartSpec("box", fmu=box)),
        connections=tuple(
            (moved(a), moved(b)) for a, b in structure.connections if not (inside(a) and inside(b))
        ),
        channels={name: tuple(map(moved, paths)) for name, paths in structure.channels.items()},
    )
    options = {"algorithm": LI(degree=3), "step": STEP, "fmu": "in-process"}
    plain = run("test_rig", scene=scene, **options)
    result = run(joined, scene=Scene("held", "", T_END, STEP, Start.REST), **options)
    assert result.outcome.completed, result.outcome
    for channel in ("bearing_force", "seat_velocity"):
        names = plain.channel(channel)
        expected = plain.data[names].to_numpy()
        found = result.data[[moved(name) for name in names]].to_numpy()
        error = np.linalg.norm(found - expected) / np.linalg.norm(expected - expected.mean(axis=0))
        assert error < 1e-4  # each run is within 1e-4 of the twin at this step (coupling error)
