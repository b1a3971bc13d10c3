"""What an adapter in front of a part knows, as a record that compiled functions read and write."""

import numpy as np
from numba import from_dtype, types

MEMORY = np.dtype(
    [
        ("component", np.int64),
        ("set_real", np.int64),
        ("get_real", np.int64),
        ("do_step", np.int64),
        ("get_state", np.int64),
        ("set_state", np.int64),
        ("free_state", np.int64),
        ("get_later", np.int64),
        ("finish", np.int64),
        ("pending", np.int64),
        ("read", np.int64),
        ("pending_time", np.float64),
        ("pending_step", np.float64),
        ("all_held", np.int64),
        ("all_raw", np.int64),
        ("inputs", np.int64),
        ("outputs", np.int64),
        ("degree", np.int64),
        ("pieces", np.int64),
        ("at_end", np.int64),
        ("stepped", np.int64),
        ("input_references", np.int64),
        ("output_references", np.int64),
        ("given", np.int64),
        ("driven", np.int64),
        ("coefficients", np.int64),
        ("order", np.int64),
        ("held", np.int64),
        ("packed", np.int64),
        ("packed_references", np.int64),
        ("raw", np.int64),
        ("values", np.int64),
        ("feedthrough", np.int64),
        ("place", np.int64),
        ("rate", np.int64),
        ("watched", np.int64),
        ("suspected", np.int64),
        ("resting", np.int64),
        ("state_time", np.float64),
        ("saved_time", np.float64),
        ("seen_time", np.float64),
        ("seen_step", np.float64),
        ("seen_piece", np.float64),
        ("seen_held", np.int64),
        ("seen_raw", np.int64),
        ("answer", np.int64),
        ("changes", np.int64),
        ("responses", np.int64),
        ("trial_state", np.int64),
        ("once", np.int64),
        ("taken_time", np.float64),
        ("taken_step", np.float64),
        ("taken", np.int64),
        ("answers", np.int64),
        ("missed", np.int64),
    ]
)
"""What an adapter knows; what has a shape is the address of an array, of float64 if not said.

    component ... finish            the part, and the addresses of its functions, see `Addresses`
    pending                         1 if the outputs of a step have not come yet
    read                            1 if outputs were read since the last step
    pending_time, pending_step      of the step whose outputs have not come [s]
    inputs, outputs                 numbers n and m
    degree                          of the signals
    pieces                          steps from node to node, 1 or 2
    at_end                          1 for a part without memory
    stepped                         1 after the first step
    input_references (n), output_references (m)
                                    value references (uint32)
    given (n, STRIDE)               signals of the inputs
    driven (n)                      1 for inputs that were set (int64)
    coefficients (n, STRIDE)        of the polynomials of the inputs
    order (n)                       of the inputs, those that are rates first (int64)
    all_held (STRIDE, 2, n)         what the inputs are held at, by node and piece
    held (2, n)                     of it, at the present node
    all_raw (STRIDE, m)             outputs of the part, by node
    raw (m)                         of it, at the present node
    packed, packed_references       values and references of driven inputs, for one call
    values (m, STRIDE)              signals of the outputs
    feedthrough (m, n)              D
    place (n)                       rule by which an input is given, see `InputRule` (int64)
    rate (n)                        number of an input's rate, or -1 (int64)

For `nodal.watch`:

    watched, suspected              1 if D is watched; 1 if it is to be measured
    resting                         steps without a measurement
    state_time, saved_time          of the part and of its saved state [s]
    seen_time, seen_step, seen_piece
                                    of the last step and its pieces [s]
    seen_held (STRIDE, 2, n), seen_raw (STRIDE, m)
                                    as all_held and all_raw, of the last step
    answer (m, n)                   what states answer in a piece
    changes (n)                     of the inputs in trials
    responses (5, m)                room for what trials give
    trial_state                     address of the handle of a state

For `nodal.once`:

    once                            1 if the part cannot repeat a step
    taken_time, taken_step          of the last step [s]
    taken (n, STRIDE)               inputs of that step
    answers (m, STRIDE)             outputs of that step
    missed (n)                      mean of what its inputs became after it
"""

MEMORY_POINTER = types.CPointer(from_dtype(MEMORY))
