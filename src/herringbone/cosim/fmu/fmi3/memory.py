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
        ("next_event", np.float64),
        ("saved_event", np.float64),
        ("varies", np.int64),
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

    instance ... get_derivatives  the FMU's instance, and the addresses of its functions
    count, elements, values       of elements: number, address of them, of their last values
                                  (float64)
    references, packed            of the current call: addresses of value references (uint32) and
                                  values (float64)
    arrays, array_count           of inputs that are arrays: address of their first elements
                                  (uint32), and number
    calls                         number of calls
    ended, saved                  why no step follows, see `ENDED`; that of the state saved last
    next_event, saved_event       when the FMU has an event, as it tells before [s], infinite if it
                                  does not; that of the state saved last
    varies                        1 if it takes steps of any length
    reached                       address of the time that the last step reached (float64)
    events                        1 in step mode if event mode is used
    enter_events, update, enter_steps
                                  addresses of fmi3EnterEventMode, fmi3UpdateDiscreteStates and
                                  fmi3EnterStepMode
    flags                         address of what they return (uint8; from the eighth on, float64)

Of inputs that change within the next step:

    bent, bent_inputs             their number, and address of their elements (uint32)
    slopes, starts                of all elements: addresses of the derivatives (ORDERS each) and
                                  values (float64) at the start of the step
    began                         when the step began [s]
    steps_bent                    number of steps with such inputs
    asked                         how often the FMU asked for inputs
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
