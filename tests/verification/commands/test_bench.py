"""The benchmark measures what it says: the loops move alike, sizes are those of the files."""

import json
import math
import os
import random
from functools import partial

import pytest
from fuzz.campaign import last_commit
from support.compiler import needs_compiler

from herringbone.benchmarks import (
    coupled_step,
    fmus,
    fused,
    fused_step,
    loop_profile,
    macro_step,
    steady,
)
from herringbone.commands import bench
from herringbone.commands.main import main
from herringbone.components.registry import COMPONENTS
from herringbone.core import HerringboneError
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.fmi.native import build_native_fmus
from herringbone.running.exporting.parallel_step import PARALLEL
from herringbone.running.loading import load_scene, load_system, open_parts
from herringbone.running.start import started

pytestmark = needs_compiler
FORCES = ["shaft.pinion_left.f_y", "shaft.wheel_right.f_z"]
LARGEST = 300_000
"""Bytes of an FMU with all platforms, its resources aside: the limit that the project sets."""
BEYOND = {"gear_mesh": 337_500, "gearbox": 641_000, "test_rig": 668_500}
"""What misses it, by 12 %, and twice: the law of single teeth takes 14 kB per platform, and the
slopes of an energy what systems missed it by before. Kernels that tell the motion alone take 3 to
4 kB of systems per platform, and halve the time of their right-hand side. Bearings that may stand
on rigid ground take 0.7 kB per platform, forces that are projected onto the modes once per step
0.5 kB: the housing takes 0.6 of its time. The condensed core of whole systems takes 46 kB of them
per platform, and makes them two to five times as fast: a third of it is its step, vectorised, a
third what finds modes and makes matrices when parameters are known, the rest Runge-Kutta by a
tolerance, beside that of a micro step, and constants. Steps that leave all as it was if they fail,
and directional derivatives of the start, take 1.4 kB per platform. Teeth that enter on either end
of their path take 0.6 kB of the gear mesh and 2.6 kB of the rig in all, states that go on with the
same bits in an instance of other parameters 0.3 and 2.3 kB."""
DRAWN = 4
"""Components whose FMUs are built for all platforms, and one system; all if EVERY_FMU is set."""


def test_the_plain_loop_ends_where_the_compiled_loop_ends():
    structure, folder = load_system("test_rig")
    system, _ = started(structure, load_scene(folder, "loaded"))
    bearing = [p.name for p in system.parts].index("gearbox.bearing_supports")
    steps, ends = 40, []
    for plain in (True, False):
        parts = open_parts(system, "native")
        if plain:
            macro_step.plain_loop(system, parts, steps)
        else:
            step = macro_step.STEP
            simulate(system, parts, PARALLEL, make_grid(steps * step, step, step))
        ends.append(parts[bearing].get(FORCES))
        for part in parts:
            part.close()
    assert ends[0] == ends[1]


@pytest.mark.slow
def test_fmus_are_small(capsys, monkeypatch):
    """Drawn by the last commit's hash."""
    if "EVERY_FMU" not in os.environ:
        chance = random.Random(last_commit())
        drawn = chance.sample(sorted(COMPONENTS), DRAWN)
        monkeypatch.setattr(fmus, "build_native_fmus", partial(build_native_fmus, drawn))
        monkeypatch.setattr(fmus, "SYSTEMS", (chance.choice(fmus.SYSTEMS),))
    assert main(["bench", "fmus", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["fmus"]
    sizes = {name: fmu["bytes"] for name, fmu in found["fmus"].items()}
    for name, limit in BEYOND.items():
        assert sizes.pop(name, 0) <= limit
    assert {name: size for name, size in sizes.items() if size > LARGEST} == {}


def test_unknown_part(capsys):
    assert main(["bench", "speed"]) != 0
    assert "there is no part 'speed'; it has macro-step" in capsys.readouterr().err


def test_what_was_measured_before_an_error_is_shown(capsys, monkeypatch):
    """The tables, or JSON without NaN, which it has no word for."""

    def failing():
        raise HerringboneError("no compiler")

    parts = {"accuracy": lambda: ("a table", {"error": math.nan}), "fused": failing}
    monkeypatch.setattr(bench, "_MEASURE", parts)
    assert main(["bench", "accuracy", "fused", "--json"]) == 2
    out, err = capsys.readouterr()
    assert json.loads(out) == {"accuracy": {"error": "nan"}, "fused": {"error": "no compiler"}}
    assert err.endswith("herringbone: no compiler\n")
    assert main(["bench", "accuracy", "fused"]) == 2
    assert capsys.readouterr().out == "a table\n"


def test_a_disturbed_short_loop_is_no_fast_one():
    """1 s per simulated second and 0.1 s before it; the first short loop takes 0.5 s longer."""
    late = iter([0.5])
    loop = lambda t_end: 0.1 + t_end + (next(late, 0.0) if t_end < 1.0 else 0.0)  # noqa: E731
    assert fused._costs({"loop": loop}, 3) == pytest.approx({"loop": 1.0})


def test_steady_states_are_found_and_timed():
    rows = steady.measure(repeats=1, speeds=5)
    assert [row.lost for row in rows] == [0] * len(rows)
    assert all(row.seconds > 0.0 for row in rows)
    assert all(row.error <= 1e-3 for row in rows)
    assert "81 meshes" in rows[-1].name


@pytest.mark.parametrize("module", [fused_step, coupled_step])
def test_parts_of_a_step_and_their_rest_are_the_whole(module):
    whole, *parts = module.measure(repeats=1, steps=400)
    assert not whole.within
    assert all(part.within for part in parts)
    summed = [part.seconds for part in parts if not part.name.startswith("in them")]
    assert sum(summed) == pytest.approx(whole.seconds, rel=1e-12)


def test_a_coupled_step_passes_over_its_parts_twice_and_seldom_once_more():
    """Prediction and one correction; a third pass where the residual asks for it."""
    passes = next(p.name for p in coupled_step.measure(repeats=1, steps=400) if "passes" in p.name)
    assert 2.0 <= float(passes.split()[0]) < 3.0


def test_a_macro_step_is_all_its_pieces(monkeypatch):
    """Its parts and the loop's pieces; equal steps take two passes, of which one is done again."""
    for name, value in (("_LONG", 8e-3), ("_SHORT", 4e-3), ("_SHORTER", 2e-3), ("_AGAIN", 20)):
        monkeypatch.setattr(loop_profile, name, value)
    for found in loop_profile.measure(1):
        parts = [piece for piece in found.pieces if piece.calls]
        assert len(parts) == 8
        assert sum(piece.seconds for piece in found.pieces) == pytest.approx(found.seconds)
        elements = {piece.name.rpartition(".")[2] for piece in parts if piece.element}
        assert elements == {"drive_coupling", "load_coupling", "bearing_supports"}
        once = {piece.name for piece in parts if piece.again == 0.0}
        assert once == {"bench_controller"}
        if "tolerance" not in found.name:
            assert (found.step, found.passes) == (pytest.approx(4e-5), pytest.approx(2.0, abs=0.05))
