"""li with an adaptive step: achieved error against tolerance, stability, and steps that fail.

The error may be a tenth to five times the tolerance: the estimate is that of the forces, and what
a system makes of a wrong force depends on its resonances.
"""

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from support.parts.fakes import DISCARD, OK
from support.parts.misbehaviour import fail_at
from support.parts.running import columns, run_fmus_and_in_process
from support.parts.two_masses import (
    MOTION,
    TWO_MASS_SYSTEM,
    Echo,
    Forgetful,
    Mass,
    Ramp,
    SpringDamper,
    TwoMass,
)

from herringbone.analysis.accuracy.error import relative_error
from herringbone.commands.main import main
from herringbone.core import OutcomeKind, ParameterError
from herringbone.cosim.algorithms import LI, with_tolerance
from herringbone.cosim.loops.adaptive_step.ladder import RUNGS, TICKS, dividing_rung
from herringbone.cosim.simulation import make_grid, simulate
from herringbone.cosim.structure.system import PartSpec, System
from herringbone.cosim.structure.system_file import find_system, read_system
from herringbone.running.api import run
from herringbone.running.start import started
from herringbone.scenes import find_scene, read_scene

LOW, HIGH = 0.1, 5.0
STRANGER = Path(__file__).parents[2] / "fmus" / "strange_housing.py"


def go(problem, t_end=20.0, largest=2.0, record=None, algorithm=LI(tolerance=1e-3), **more):  # noqa: B008
    """Run the two-mass problem; all communication points are recorded unless told."""
    grid = make_grid(t_end, largest, record or largest)
    grid = grid if record else grid._replace(every=0)
    return simulate(TWO_MASS_SYSTEM, problem.parts(**more), algorithm, grid)


def force_error(problem, recording):
    """Of the spring's force, in the measure of a run against its twin."""
    s1, v1, s2, v2 = problem.exact(recording.time).T
    exact = problem.stiffness * (s1 - s2) + problem.damping * (v1 - v2)
    found = columns(recording, ("spring.b.f",))
    return relative_error(found, exact[:, None], recording.time)


# -- error against tolerance --------------------------------------------------------------------


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("scene", ["loaded", "separation"])
def test_the_rig_keeps_the_tolerance(scene, tolerance):
    """With records that leave steps their room, so that the tolerance decides."""
    result = run(
        "test_rig", scene=scene, tolerance=tolerance, t_end=0.02, record_step=1e-4,
        fmu="in-process", reference=True,
    )  # fmt: skip
    assert result.outcome.completed
    assert result.data["time"].iloc[-1] == pytest.approx(0.02, rel=1e-12)
    assert LOW <= max(result.error.values()) / tolerance <= HIGH
    assert result.info.steps["rejected"] <= 0.1 * result.info.steps["accepted"]


@pytest.mark.parametrize(
    ("system", "scene", "tolerance"),
    [
        ("boosted_axle", "engaging", 1e-3),
        ("on_ground", "loaded", 1e-3),
        ("turbine", "loaded", 1e-4),
    ],
)
def test_all_recorded_channels_keep_the_tolerance(system, scene, tolerance):
    """Seats and gears move with the teeth, while a slow shock is most of what the forces do.

    Measured by the forces alone, velocities err 5 and 10 times 1e-3 in the first two.
    """
    result = run(
        system, scene=scene, tolerance=tolerance, t_end=0.015, fmu="in-process", reference=True
    )
    assert max(result.error.values()) <= 2.0 * tolerance
    estimate = result.info.estimate
    assert np.hypot(estimate["coupling"], estimate["inner_steps"]) <= tolerance


def test_channels_that_no_part_takes_are_named():
    system = replace(TWO_MASS_SYSTEM, channels={"force": ("*.f",), "work": ("*.work",)})
    parts, grid = TwoMass(zeta=0.1).parts(), make_grid(20.0, 2.0, 2.0)
    notes = simulate(system, parts, LI(tolerance=1e-3), grid).notes
    assert notes == (
        "no part takes anything of 'work': the step is not measured by these channels",
    )


@pytest.mark.parametrize("zeta", [0.0, 0.02])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("degree", [1, 2, 3])
def test_two_masses_keep_the_tolerance(degree, tolerance, zeta):
    """A force wrong by e in the mean shifts the phase by e w t / 2, in the mean 5.8 e up to 20 s.

    That is twice what the estimate allows for.
    """
    problem = TwoMass(zeta=zeta)
    largest = 2.0 if degree > 1 else 0.1
    recording = go(problem, largest=largest, algorithm=LI(degree=degree, tolerance=tolerance))
    assert recording.outcome.completed
    assert LOW <= force_error(problem, recording) / tolerance <= HIGH


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, 1e-5])
def test_quartic_nodes_stay_within_the_tolerance(tolerance):
    """Their differences reach back over two steps, so that the estimate is high for long ones."""
    problem = TwoMass(zeta=0.02)
    recording = go(problem, algorithm=LI(degree=4, tolerance=tolerance))
    assert 0.02 <= force_error(problem, recording) / tolerance <= 1.0


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 1e-4])
def test_a_held_part_keeps_the_tolerance_with_smaller_steps(tolerance):
    problem = TwoMass(zeta=0.1)
    held = lambda *a, **more: Mass(*a, **(more | {"nodes": False}))  # noqa: E731
    algorithm = LI(tolerance=tolerance)
    recording = go(problem, algorithm=algorithm, kind=held)
    assert LOW <= force_error(problem, recording) / tolerance <= HIGH
    assert recording.steps.median < 0.5 * go(problem, algorithm=algorithm).steps.median


def test_the_step_follows_the_motion():
    """A fast motion that dies out, with steps below h w = 1."""
    problem = TwoMass(w=10.0, zeta=0.1)
    recording = go(problem, t_end=8.0, largest=0.4, algorithm=LI(tolerance=1e-6))
    steps, ends = np.diff(recording.time), recording.time[1:]
    early, late = (np.median(steps[(ends > start) & (ends < start + 1.0)]) for start in (0.5, 6.5))
    # The force falls by exp(-6 zeta w): the step of order 4 grows by exp(6 / 4) = 4.5; a rung
    # more or less is a factor of 4/3 at most.
    assert 4.5 * 0.75 <= late / early <= 4.5 * 4 / 3


# -- ends and records ---------------------------------------------------------------------------


@pytest.mark.parametrize("t_end", [20.0, 19.97, np.pi])
def test_the_end_is_hit_and_steps_are_rungs(t_end):
    recording = go(TwoMass(zeta=0.1), t_end=t_end, largest=1.0)
    assert recording.time[-1] == pytest.approx(t_end, rel=1e-14)
    tick = t_end / np.ceil(t_end) / TICKS
    ticks = np.diff(recording.time) / tick
    assert ticks == pytest.approx(np.rint(ticks), abs=1e-6)
    assert set(np.rint(ticks).astype(int)) <= set(RUNGS)
    steps = recording.steps
    assert (steps.accepted, recording.macro_steps) == (ticks.size, ticks.size)
    assert (steps.shortest, steps.median, steps.longest) == pytest.approx(
        tuple(f(ticks) * tick for f in (np.min, np.median, np.max))
    )


@pytest.mark.parametrize(("largest", "every"), [(0.5, 1), (0.5, 4), (2.0, 1)])
def test_rows_are_equally_far_apart(largest, every):
    """Steps end at them; what is in between is no longer than the tolerance lets it be."""
    problem = TwoMass(zeta=0.1)
    recording = go(problem, largest=largest, record=every * largest)
    apart = every * largest
    assert recording.time == pytest.approx(np.arange(round(20.0 / apart) + 1) * apart, rel=1e-14)
    assert force_error(problem, recording) / 1e-3 <= 1.0
    assert recording.steps.longest <= largest * (1.0 + 1e-12)
    free = go(problem, largest=largest)
    assert recording.macro_steps <= 1.6 * free.macro_steps


def test_steps_between_rows_divide_what_is_left():
    """800 ticks: 640 divides them not, 400 does; of 35 that are left 5 and 7 are, 5 is a rung."""
    rungs = np.array(RUNGS, dtype=np.int64)

    def found(wanted, left):
        return RUNGS[dividing_rung(rungs, RUNGS.index(wanted), left)]

    assert [found(w, 800) for w in (800, 640, 320, 125, 13)] == [800, 400, 200, 100, 10]
    assert found(640, 640) == 640
    assert [found(w, 35) for w in (800, 5)] == [5, 5]
    assert found(4, 35) == 4  # none divides it: steps add up to the end


def test_steps_taken_back_leave_no_trace():
    """The same run from another first step: what was taken back is not in the result."""
    problem = TwoMass(zeta=0.1)
    recording = go(problem, largest=16.0, t_end=32.0)  # begins with h w = 3.2
    assert recording.steps.rejected >= 2
    assert LOW <= force_error(problem, recording) / 1e-3 <= HIGH


def test_few_jacobians():
    """A linear system: one by differences and one for the larger rungs; 8 passes each."""
    recording = go(TwoMass(zeta=0.1), t_end=200.0)
    tried = recording.steps.accepted + recording.steps.rejected
    assert recording.passes["left"] <= 3.0 * tried + 3 * 8


# -- stability ----------------------------------------------------------------------------------


def test_steps_beyond_the_limit_are_found_and_taken_back():
    """After the motion has died out any step errs little, and beyond h w = 6 it grows again."""
    problem = TwoMass(w=1.0, zeta=0.02)
    recording = go(problem, t_end=4000.0, largest=10.0)
    steps = np.diff(recording.time)
    assert steps.max() > 6.0
    s1, _, s2, _ = columns(recording, MOTION).T
    late = recording.time > 500.0  # exp(-0.02 * 500) = 5e-5 of the start is left
    # The size is the standard deviation since the start: below 1.2 of 0.85 amplitudes here.
    assert np.abs(s1 - s2)[late].max() < HIGH * 1e-3 * 1.2
    fixed = simulate(
        TWO_MASS_SYSTEM, problem.parts(), LI(), make_grid(4000.0, steps.max(), steps.max())
    )
    s1, _, s2, _ = columns(fixed, MOTION).T
    assert np.abs(s1 - s2).max() > 1e3


# -- what goes wrong ----------------------------------------------------------------------------


def test_a_tolerance_that_cannot_be_met_ends_no_run():
    """h w = 1 at the smallest step; the error of degree 3 there is 3 / 6480 = 4.6e-4 at the most.

    1e-6 is doubled until the forces pass zero too fast to miss it a hundred times in a row.
    """
    problem = TwoMass(w=1000.0, zeta=0.0)
    recording = go(problem, t_end=2.0, largest=0.2, algorithm=LI(tolerance=1e-6))
    assert recording.outcome.completed
    (note,) = (note for note in recording.notes if "misses the tolerance" in note)
    assert note.startswith(("spring.a.f misses", "spring.b.f misses"))
    assert "of 1e-06" in note
    assert "smallest step of 0.001 s" in note
    kept = float(re.search(r"([0-9.e-]+) was aimed at", note).group(1))
    assert 4e-6 < kept < 2.0 * 3.0 / 6480.0
    assert recording.macro_steps == pytest.approx(2000, rel=0.05)
    assert np.isfinite(recording.values).all()


class Picky(Mass):
    """A mass that discards steps longer than 0.05 s."""

    LONGEST = 0.05

    def step(self, t, h):
        return DISCARD if h > self.LONGEST + 1e-12 else super().step(t, h)


def test_a_discarded_step_is_tried_smaller():
    problem = TwoMass(zeta=0.1)
    recording = go(problem, kind=Picky)
    assert recording.outcome.completed
    assert recording.steps.longest == pytest.approx(Picky.LONGEST)
    assert recording.steps.rejected > 0
    assert force_error(problem, recording) < 1e-3


def test_a_part_that_discards_every_step_ends_the_run_with_results_so_far():
    recording = go(TwoMass(zeta=0.1), misbehave=fail_at(6.0, DISCARD))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.outcome.culprit == "left"
    assert recording.time[-1] == recording.outcome.time
    assert 6.0 - 0.01 - 1e-9 < recording.outcome.time < 6.0


def test_a_part_that_discards_the_first_step_has_no_jacobian():
    outcome = go(TwoMass(), misbehave=lambda part, t: DISCARD).outcome
    assert (outcome.kind, outcome.time) == (OutcomeKind.COUPLING_FAILED, 0.0)
    assert "cannot be computed at 0 s: left fails" in outcome.message


def test_an_error_is_not_tried_again():
    recording = go(TwoMass(zeta=0.1), misbehave=fail_at(6.0))
    assert recording.outcome.kind is OutcomeKind.PART_FAILED
    assert recording.steps.rejected <= 3


class Stuck(Mass):
    """A mass that refuses every restore after the fiftieth."""

    def restored(self):
        return DISCARD if self.restores > 50 else OK


def test_a_refused_restore_names_the_part():
    outcome = go(TwoMass(zeta=0.1), kind=Stuck).outcome
    assert (outcome.kind, outcome.culprit) == (OutcomeKind.PART_FAILED, "left")


def test_a_part_that_answers_differently_after_restore():
    outcome = go(TwoMass(), kind=Forgetful).outcome
    assert outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "left is not deterministic" in outcome.message


def test_a_singular_jacobian():
    system = System(
        "grounded", "", (PartSpec("body"), PartSpec("spring")), (("body.flange", "spring.a"),)
    )
    parts = [Echo("body"), SpringDamper("spring", 1.0, 0.0)]
    grid = make_grid(1.0, 0.1, 0.1)._replace(every=0)
    outcome = simulate(system, parts, LI(tolerance=1e-3), grid).outcome
    assert outcome.kind is OutcomeKind.COUPLING_FAILED
    assert "the interface Jacobian is singular at 0 s (h = 0.03125 s)" in outcome.message


def test_a_source_that_cannot_be_taken_back_is_refused():
    system = System(
        "driven", "", (*TWO_MASS_SYSTEM.parts, PartSpec("ramp")),
        (*TWO_MASS_SYSTEM.connections, ("ramp.flange.f", "left.load.f")),
    )  # fmt: skip
    parts = [*TwoMass().parts(), Ramp("ramp", 1.0, state=False)]
    with pytest.raises(ParameterError, match="ramp cannot save and restore its state; leave"):
        simulate(system, parts, LI(tolerance=1e-3), make_grid(1.0, 0.1, 0.1))


def test_a_jump_of_the_force_is_passed():
    """At 10 s the spring is suddenly twice as stiff; no step is small enough there."""
    recording = go(TwoMass(zeta=0.1), stiffness=lambda t: 0.75 * (1.0 + (t > 10.0)))
    assert recording.outcome.completed
    steps = np.diff(recording.time)
    at = np.searchsorted(recording.time, 10.0)
    assert steps[at - 3 : at + 3].min() == pytest.approx(0.01)  # the smallest
    assert steps[at + 50] > 0.3
    assert any("smallest steps" in note for note in recording.notes)


@pytest.mark.parametrize("tolerance", [-1.0, 1.0, 1e-9, np.nan])
def test_tolerance_out_of_range(tolerance):
    with pytest.raises(ParameterError, match="it must lie between 1e-08 and 1, or be 0"):
        LI(tolerance=tolerance)


def test_two_tolerances_are_refused():
    with pytest.raises(ParameterError, match=r"but the algorithm is li:.*tolerance=0.01"):
        with_tolerance(LI(tolerance=1e-2), 1e-3)


# -- FMUs, command line -------------------------------------------------------------------------


def test_python_fmus_give_the_same_bits(python_fmus):
    scene = read_scene(find_scene(find_system("test_rig"), "separation"))
    system = started(read_system("test_rig"), scene)[0]
    grid = make_grid(2e-3, 2e-4, 2e-4)
    found, wanted = run_fmus_and_in_process(system, python_fmus, LI(tolerance=1e-3), grid)
    assert found.steps == wanted.steps
    assert found.steps.rejected > 0
    assert np.array_equal(columns(found, wanted.names), wanted.values)


@pytest.mark.usefixtures("without_pictures")
def test_a_strangers_fmu_with_state(tmp_path, capsys):
    """An adaptive step by name; with `--tolerance` alone the step is fixed, and found by runs."""
    script = tmp_path / "steppedhousing.py"
    script.write_text(STRANGER.read_text().replace("StrangeHousing", "SteppedHousing"))
    command = [sys.executable, "-m", "pythonfmu", "build", "--handle-state"]
    subprocess.run([*command, "-f", str(script), "-d", str(tmp_path)], check=True)
    replace = f"--replace=modal_housing={tmp_path / 'SteppedHousing.fmu'}"
    output = ["--json", "--overwrite", "-o", str(tmp_path / "out")]
    command = ["run", "test_rig", "--t-end=1e-3", replace, *output]
    assert main([*command, "--algorithm=li:tolerance=1e-2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    steps = summary["steps"]
    assert set(steps) == {"accepted", "rejected", "shortest", "median", "longest"}
    assert steps["accepted"] == summary["macro_steps"]
    assert any("gearbox.modal_housing: a body by trial steps" in n for n in summary["notes"])
    table = pd.read_csv(tmp_path / "out" / "results.csv")
    assert table["time"].diff().dropna().to_numpy() == pytest.approx(1e-4, rel=1e-9)
    assert steps["longest"] <= 1e-4 * (1.0 + 1e-9)
    assert main([*command, "--tolerance=1e-2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert "steps" not in summary
    assert max(summary["verification"]["groups"].values()) <= 1e-2
