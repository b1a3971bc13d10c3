"""A coupling that grows where no energy is watched: in play, nothing damps at the start.

Two masses of 1 kg, beyond 5 mm of play a spring of 4e4 N/m between them: sqrt(2 k / m) = 283 rad/s.
"""

from dataclasses import replace

import pytest
from support.foreign.kinds import build_kinds
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.analysis.figures.settling import NOT_SETTLED
from herringbone.core import OutcomeKind
from herringbone.core.energy_report import EnergyReport, Verdict
from herringbone.cosim.structure.system_file import read_system
from herringbone.result.verification import Verification
from herringbone.running.steps.grown import with_doubt

VALUES = {"one.k": 100.0, "two.k": 1000.0, "one.ko": 4e4, "one.gap": 5e-3, "one.v0": 0.5}
OMEGA = 283.0


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    folder = tmp_path_factory.mktemp("play")
    kinds = build_kinds(folder, "oscillator_play.c", "oscillator_mass.c")
    joined = [["one.fo", "two.f"], ["two.x", "one.xo"]]
    files = {"one": kinds / "oscillator_play.fmu", "two": kinds / "oscillator_mass.fmu"}
    return write_system(folder, "play", joined, files)


def run(system, algorithm, step, **asked):
    return hb.run(
        system, algorithm=algorithm, step=step, record_step=step, t_end=0.5, start="rest",
        values=VALUES, **asked,
    )  # fmt: skip


@pytest.mark.parametrize("asked", [{}, {"verify": True}])
def test_growth_beyond_half_the_step_is_unstable(system, asked):
    """At omega h = 1.2 held forces grow without bound; the most there is is a wave k v / omega."""
    found = run(system, "jacobi:order=2", 1.2 / OMEGA, **asked)
    assert found.outcome.kind is OutcomeKind.UNSTABLE
    assert found.info.energy is None
    assert found.data[found.outcome.culprit].abs().max() > 1e3 * 4e4 * 0.5 / OMEGA
    assert "times the most that half the step gives" in found.outcome.message
    assert not any("not settled" in note for note in found.info.notes)
    assert found.budget == ()


def test_bounded_motion_completes(system):
    """Contacts scatter the error, and nothing grows."""
    found = run(system, "li:degree=3", 0.2 / OMEGA)
    assert found.outcome.completed
    assert found.data["one.fo"].abs().max() < 2.0 * 4e4 * 0.5 / OMEGA
    assert not any("is not watched" in note for note in found.info.notes)


def test_a_line_where_nothing_tells(system):
    found = run(system, "jacobi:order=2", 0.2 / OMEGA, probe=False)
    (line,) = (note for note in found.info.notes if "is not watched" in note)
    assert line.endswith("nothing tells whether the coupling is stable")


def test_a_line_where_the_error_is_that_of_whole_signals(system):
    """Whether the energy is watched or not: 974 % says more than an energy that looks fine."""
    found = run(system, "li:degree=3", 0.2 / OMEGA, probe=False)
    fine = EnergyReport(Verdict.FINE, None, None, 0.0, 0.1)
    unsettled = replace(found.info, notes=(f"{NOT_SETTLED}: use a longer t_end",), energy=fine)
    for error, told in ((0.99, False), (9.74, True)):
        known = Verification({"outputs": error}, "one.fo", error, 1e-3, "by half the step")
        notes = with_doubt(
            replace(found, info=unsettled, verification=known), read_system(system)
        ).info.notes
        assert any("error by other steps is 974 %: the coupling may be" in n for n in notes) is told
        assert any(note.startswith(NOT_SETTLED) for note in notes) is not told


def test_a_cycle_of_an_unstable_coupling_is_told():
    """Its energy does not grow any more: a step told to be unstable, with corrections apart."""
    found = hb.run("test_rig", algorithm="li:degree=3", t_end=1e-3, fmu="in-process")
    system = read_system("test_rig")
    lines = ("li is unstable at a step of 0.001 s", "after 6 corrections the forces still differed")
    for count, kind in ((1, "completed"), (2, "unstable")):
        ended = replace(found, info=replace(found.info, notes=lines[:count]))
        assert with_doubt(ended, system).outcome.kind == kind
    told = with_doubt(ended, system)
    assert told.outcome.message.endswith("higher one; 'herringbone stability' shows them")
    assert told.info.energy is None
    assert not told.budget
