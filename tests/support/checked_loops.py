"""Runs whose compiled code is checked for bounds: a program, run with NUMBA_BOUNDSCHECK=1.

An index out of bounds is an IndexError. Where C code is called from, it is a line on stderr.
"""

import herringbone as hb
from support.algorithms import run, variants

END = 0.5
"""Of the runs of two masses [s]."""
RUNS = ({"fmu": "in-process"}, {"fuse": True})
"""Of an axle at `coast`, where teeth part."""


def main() -> None:
    """All algorithms on two masses, with slow bodies where they may be, then the axle."""
    for algorithm in variants():
        assert run(algorithm, 0.1, END).outcome.completed
        if algorithm.multirate:
            assert run(algorithm, 0.1, END, slow={"right": 5}).outcome.completed
    for options in RUNS:
        found = hb.run("e_axle", scene="coast", t_end=2e-3, **options)
        assert found.outcome.completed


if __name__ == "__main__":
    main()
