"""What the FMI 2.0 functions in front of an FMU 3.0 know of it, see `calls`."""

import numpy as np

MEMORY = np.dtype(
    [
        ("instance", np.int64),
        ("set_float64", np.int64),
        ("get_float64", np.int64),
        ("do_step", np.int64),
        ("get_state", np.int64),
        ("set_state", np.int64),
        ("free_state", np.int64),
        ("get_derivatives", np.int64),
        ("count", np.int64),
        ("elements", np.int64),
        ("values", np.int64),
        ("references", np.int64),
        ("packed", np.int64),
        ("arrays", np.int64),
        ("array_count", np.int64),
        ("calls", np.int64),
        ("ended", np.int64),
        ("saved", np.int64),
        ("reached", np.int64),
        ("events", np.int64),
        ("enter_events", np.int64),
        ("update", np.int64),
        ("enter_steps", np.int64),
        ("flags", np.int64),
        ("bent", np.int64),
        ("bent_inputs", np.int64),
        ("slopes", np.int64),
        ("starts", np.int64),
        ("began", np.float64),
        ("steps_bent", np.int64),
        ("asked", np.int64),
    ]
)
"""What an FMU 3.0 is for its adapters.

instance, and the addresses of its functions; count of elements; addresses of the elements, of their
last values (float64), and of the value references (uint32) and values (float64) of the current
call, and of the first elements of the inputs that are arrays (uint32), with their number; number of
calls; ended: why no step follows, see `ENDED`; saved: the same, of the state saved last; address of
the time reached by the last step (float64); events: 1 in step mode if event mode is used; addresses
of fmi3EnterEventMode, fmi3UpdateDiscreteStates and fmi3EnterStepMode; address of the flags that
they return (uint8 and, from the eighth on, float64).

Of inputs that change within the next step: their number; addresses of their elements (uint32), and,
for all elements, of the derivatives (ORDERS each) and values (float64) at the start of the step;
when the step began [s]; number of steps with such inputs; how often the FMU asked for inputs.
"""
ORDERS = 4
"""Highest order of derivatives of an input."""
ELEMENT = np.dtype(
    [
        ("reference", np.int64),
        ("first", np.int64),
        ("size", np.int64),
        ("call", np.int64),
        ("discrete", np.int64),
    ]
)
"""An element: value reference, first element and size of its variable; at the first element, the
number of the last call that exchanged the variable; discrete: 1 if it changes at events only."""
RUNS, ENDED, EARLY, STUCK = 0, 1, 2, 3
"""It goes on; it asked to end the simulation; it returned early without leave, or again and again;
its discrete states never settle."""
