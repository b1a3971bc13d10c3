"""Housings in C that are wrong in one way each: `check --as housing` says which."""

import pytest
from support.foreign.c_housing import c_housing_fmu

from herringbone.commands import main as cli

SEAT = "pinion_right.v_y"
MUTANTS = {
    "force sign": (("FORCE=-1.0",), {}, "static compliance", "forces backwards"),
    "asymmetric stiffness": (("ASYMMETRY=0.1",), {}, "reciprocity", "off by 6.2 %"),
    "circulatory stiffness": (("CIRCULATION=0.1",), {}, "reciprocity", "off by"),
    "negative damping": (("DAMPED=-1.0",), {}, "damping", "negative damping"),
    "missing variable": ((), {"without": (SEAT,)}, "variables", f"missing: {SEAT}"),
    "wrong unit declared": ((), {"units": {SEAT: "m"}}, "units", f"{SEAT} in m"),
    "feedthrough": (("DIRECT=1e-10",), {}, "no feedthrough", "s(h/2) / s(h) = 0.96"),
    "preload": (("PRELOAD=10.0",), {}, "zero stays zero", "0.000128"),
    "hardening": (("HARDENING=1e20",), {}, "superposition", "off by 86 %"),
    "delay of five steps": (("LATE=5",), {}, "no delay", "v(h) / v(2h) = 0.00"),
    "delay of one step": (("LATE=1",), {}, "no delay", "v(h) / v(2h) = 0.00"),
    "v in mm/s": (("SPEED=1e3",), {}, "v = ds/dt", "v is 999.9 of it"),
    "v negated": (("SPEED=-1.0",), {}, "v = ds/dt", "v is -0.9999 of it"),
    "no spring": (("SPRING=0.0",), {}, "static compliance", "drifts by"),
}
"""Macros, changes of the description, and the test and the words that name the fault."""


def lines(capsys, fmu, code):
    assert cli.main(["check", str(fmu), "--as", "housing"]) == code
    return capsys.readouterr().out.splitlines()


def failing(found):
    return [line for line in found if " FAILS " in line]


@pytest.mark.parametrize("fault", MUTANTS)
def test_the_fault_is_named_first(capsys, tmp_path, fault):
    """Others may fail with it, as the passivity of a delay; the one that names it is first."""
    defines, described, test, words = MUTANTS[fault]
    found = lines(capsys, c_housing_fmu(tmp_path, defines, **described), 1)
    named = [line for line in failing(found) if line.startswith(f"  {test} ")]
    assert len(named) == 1
    assert words in named[0]
    if fault != "hardening":  # what it drifts by stands above the superposition
        assert failing(found)[0] == named[0]


def test_no_damping_is_a_remark(capsys, tmp_path):
    found = lines(capsys, c_housing_fmu(tmp_path, ("DAMPED=0.0",)), 0)
    (remark,) = (line for line in found if " remark " in line)
    assert "next to no damping" in remark


def test_the_good_one_passes(capsys, tmp_path):
    found = lines(capsys, c_housing_fmu(tmp_path), 0)
    assert found[-1] == "all tests hold"
    assert not any(" remark " in line for line in found)
