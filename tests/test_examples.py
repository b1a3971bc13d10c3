"""Every example has at most 60 lines, runs, and gives a number that is known."""

import importlib.util
from pathlib import Path

import pytest
from support.compiler import needs_compiler

import herringbone as hb

FOLDER = Path(__file__).parents[1] / "examples"
FILES = {file.stem: file for file in sorted(FOLDER.glob("*.py"))}

WHOLE = 5e-3
"""For numbers that follow from an equilibrium; what is left is the vibration's mean."""
VIBRATION = 0.05
"""For short runs of vibrations: they change with the coupling's error (0.2 %) and the window."""

KNOWN = {
    "01_first_run": ({"t_end": 0.02}, 20.1, VIBRATION),
    "02_symmetry_deviation": ({"t_end": 0.02}, None, None),
    "03_other_housing": ({"t_end": 0.02}, 1.004, VIBRATION),
    "04_own_drivetrain": ({"t_end": 0.02}, 600.0, WHOLE),
    "05_error_against_step": ({"t_end": 0.002}, None, None),
    "06_loop_benchmark": ({"steps": 200}, None, None),
    "07_symmetry_and_relief": ({}, 5296.0, WHOLE),
    "08_swap_the_housing": ({"t_end": 0.005}, None, None),
    "09_aliasing": ({"t_end": 0.4}, None, None),
    "10_plain_fmpy": ({"t_end": 2e-4}, None, None),
    "11_gearbox_fmu_in_a_loop": ({"t_end": 0.005}, 200.0, WHOLE),
}
"""Arguments, number and relative tolerance; or arguments of a test of its own below."""


def run(folder, monkeypatch, name):
    monkeypatch.chdir(folder)
    spec = importlib.util.spec_from_file_location(f"example_{name}", FILES[name])
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.main(**KNOWN[name][0])


def test_all_are_known():
    assert set(KNOWN) == set(FILES)


@pytest.mark.parametrize("name", FILES)
def test_at_most_60_lines(name):
    assert len(FILES[name].read_text(encoding="utf-8").splitlines()) <= 60


@pytest.mark.parametrize("name", [name for name, known in KNOWN.items() if known[1]])
def test_number(tmp_path, monkeypatch, name):
    _, number, tolerance = KNOWN[name]
    assert run(tmp_path, monkeypatch, name) == pytest.approx(number, rel=tolerance)


def test_symmetry_deviation(tmp_path, monkeypatch):
    """Positive; 0.01 mm/s per um at 1000 r/min. A short window sees a part of the wheel's turn."""
    velocity = run(tmp_path, monkeypatch, "02_symmetry_deviation")
    assert 0.005 < velocity < 0.02


def test_error_against_step(tmp_path, monkeypatch):
    """README: 0.17 % at 10 us, order 2, over 20 ms; less in the first milliseconds."""
    error = run(tmp_path, monkeypatch, "05_error_against_step")
    assert 1e-6 < error < 1.7e-3


def test_loop_benchmark(tmp_path, monkeypatch):
    """The compiled loop is faster than a plain one; how much depends on the machine."""
    assert run(tmp_path, monkeypatch, "06_loop_benchmark") > 1.2


def test_swap_the_housing(tmp_path, monkeypatch):
    """Levels nearly stay, but beyond 1500 Hz are lines that the seats move with: the error over
    time is many times the certified 5 %, which end at 1500 Hz.
    """
    found = run(tmp_path, monkeypatch, "08_swap_the_housing")
    assert 0.1 < found["reduced_to_1500_Hz"] < 1.0


def test_aliasing(tmp_path, monkeypatch):
    """The line at 650 Hz is an alias: an eighth-order filter at 800 Hz leaves 1.6 % of 1350 Hz."""
    assert run(tmp_path, monkeypatch, "09_aliasing") > 20.0


@needs_compiler
def test_plain_fmpy(tmp_path, monkeypatch):
    """At most 40 lines; the results of our master that steps in parallel on held inputs."""
    assert len(FILES["10_plain_fmpy"].read_text(encoding="utf-8").splitlines()) <= 40
    force = run(tmp_path, monkeypatch, "10_plain_fmpy")
    ours = hb.run(
        "gearbox",
        values={"gear_mesh.der(angle)": 104.72, "gear_mesh.pinion.tau": 200.0},
        algorithm="jacobi:order=0,schedule=parallel",
        step=2e-6,
        record_step=2e-5,
        t_end=2e-4,
    )
    both = [f"bearing_supports.shaft.pinion_{side}.f_y" for side in ("left", "right")]
    start, end = ours.data[both].sum(axis=1).iloc[[0, -1]]
    assert start == pytest.approx(200.0 / 50.298e-3, rel=1e-4)
    assert force == pytest.approx(end, rel=1e-9)
    assert force != pytest.approx(start, rel=1e-6)
