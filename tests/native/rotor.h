/* Value references of the rotor, as its block lies. */
#ifndef ROTOR_H
#define ROTOR_H

enum {
    PHI, W, COUNTER, OTHER = COUNTER + 2, STATES = OTHER + 2,
    TAU = STATES, TAU1,
    PHI_OUT = TAU + 5, W_OUT = PHI_OUT + 5, TORQUE = W_OUT + 5,
    A = TORQUE + 5, STEPS, INERTIA, RATIO, DEGREE,
    GAIN, OFFSET, LENGTH,
    SIZE, INERTIAS = SIZE, SHAPES,
    DER_PHI, DER_W, DER_COUNTER, DER_OTHER = DER_COUNTER + 2, TIME = DER_OTHER + 2, INDICATOR
};

#endif
