"""Errors against a finer run, of a system that names no channels."""

from dataclasses import replace

import pytest
from support.parts.two_masses import TWO_MASS_SYSTEM, TwoMass

from herringbone.analysis.accuracy.converged import Converged
from herringbone.cosim.algorithms import LI
from herringbone.cosim.simulation import make_grid, simulate

UNITS = {"f": "N", "s": "m", "v": "m/s"}
GRID = make_grid(6.0, 0.25, 0.25)


def two_masses(speed):
    """With units, and a speed of both [m/s]."""
    parts = TwoMass().parts()
    for part in parts:
        for name in part.outputs:
            unit = UNITS[name.rpartition(".")[2]]
            part.variables[name] = replace(part.variables[name], unit=unit)
            if unit == "m/s":
                part[name] += speed
    return parts


def errors(speed):
    system = replace(TWO_MASS_SYSTEM, channels={})
    finer = Converged(system, lambda: two_masses(speed), [GRID])
    return finer.errors(simulate(system, two_masses(speed), LI(degree=2), GRID))


def test_groups_are_those_of_units():
    """Turned on together, forces and speeds err as at rest; in one norm with positions, 1/1000."""
    rest, moving = errors(0.0), errors(3000.0)
    assert set(rest) == set(moving) == {"outputs in N", "outputs in m", "outputs in m/s"}
    for unit in ("N", "m/s"):
        assert moving[f"outputs in {unit}"] == pytest.approx(rest[f"outputs in {unit}"], rel=1e-3)
    assert moving["outputs in m"] < 1e-3 * rest["outputs in m"]


def test_what_does_not_vary_is_left_out():
    """At rest without stretch nothing moves but what moves evenly."""
    system = replace(TWO_MASS_SYSTEM, channels={})

    def even():
        parts = two_masses(1.0)
        for part in parts:
            for name in part.outputs:
                if name.endswith(".s"):
                    part[name] = 0.0
        return parts

    finer = Converged(system, even, [GRID])
    found = finer.errors(simulate(system, even(), LI(degree=2), GRID))
    assert set(found) == {"outputs in m"}
