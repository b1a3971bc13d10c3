"""FMUs that can be instantiated once per process: each run has a child process for them."""

import pytest
from support.foreign.kinds import build_kinds
from support.foreign.strangers import write_system

import herringbone as hb
from herringbone.analysis.accuracy.apart import apart
from herringbone.core import ParameterError

ASKED = {"t_end": 0.1, "record_step": 1e-3, "values": {"one.v0": 1.0, "one.ko": 100.0}}


@pytest.fixture(scope="module")
def system(tmp_path_factory):
    """A mass on a spring to a flywheel whose library has one licence per process."""
    folder = build_kinds(tmp_path_factory.mktemp("once"), "single_flywheel.py", "oscillator_mass.c")
    files = {"one": folder / "oscillator_mass.fmu", "two": folder / "SingleFlywheel.fmu"}
    return write_system(
        folder, "once", [["one.fo", "two.tau_shaft"], ["two.angle", "one.xo"]], files
    )


def test_error_of_a_run(system):
    """Told by other steps, within a factor of 3, against a tenth of the step."""
    run = hb.run(system, step=1e-3, in_process=False, **ASKED)
    true = apart(run, hb.run(system, step=1e-4, in_process=False, **ASKED)).groups
    for group, told in run.verification.groups.items():
        assert true[group] / 3.0 < told < 3.0 * true[group]


def test_tolerance(system):
    run = hb.run(system, tolerance=1e-3, in_process=False, **ASKED)
    assert run.outcome.completed
    assert not run.verification.missed


def test_in_this_process(system):
    run = hb.run(system, step=1e-3, in_process=True, **ASKED)
    assert run.verification is None
    assert any("once only, and runs in this process" in note for note in run.info.notes)
    with pytest.raises(ParameterError, match="two can be instantiated once only in this process"):
        hb.run(system, tolerance=1e-3, in_process=True, **ASKED)
