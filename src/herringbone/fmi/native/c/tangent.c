/* Directional derivatives: outputs and derivatives of states, by inputs and states.

   In initialisation mode also by parameters, and through what makes the start: by differences then. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"

static Status refuse(Instance *instance, const char *why) {
    return instance_fail(instance, STATUS_ERROR, "%s: getDirectionalDerivative: %s", instance->name,
                         why);
}

/* A block, twice the states, and room for the outputs. */
static size_t direction_length(void) {
    return (size_t)hb_component.size + 2 * (size_t)hb_component.states +
           hb_component.mutable_size - hb_component.first_output;
}

/* Room for the direction and the derivatives, kept once it was needed; the tables stay zero. */
static Status prepare(Instance *instance) {
    if (!hb_component.tangent)
        return refuse(instance, "this component has none");
    if (instance->now.phase == PHASE_INSTANTIATED)
        return instance_refuse(instance, "getDirectionalDerivative");
    if (!instance->direction)
        instance->direction = calloc(direction_length(), sizeof(double));
    if (!instance->direction)
        return refuse(instance, "out of memory");
    memset(instance->direction, 0, hb_component.first_table * sizeof(double));
    instance_complete(instance);
    return instance->outdated ? instance_refresh(instance) : STATUS_OK;
}

static bool is_state(uint32_t reference) {
    return hb_component.access[reference] == HB_STATE ||
           hb_component.access[reference] == HB_ELEMENT;
}

static bool is_known(uint32_t reference) {
    return instance_is_real(reference) &&
           (hb_component.access[reference] == HB_INPUT || is_state(reference));
}

/* Tangent of an unknown; NULL if it has none. An output's nodes have its own: no time passes. */
static const double *tangent_of(const Instance *instance, uint32_t reference) {
    const double *dx = instance->direction + hb_component.size;
    if (reference - reference_of_rate(0) < hb_component.states)
        return &dx[hb_component.states + reference - reference_of_rate(0)];
    if (!instance_is_real(reference))
        return NULL;
    uint8_t access = hb_component.access[reference];
    bool has = access == HB_OUTPUT || access == HB_LOCAL || is_state(reference);
    return has ? &instance->direction[instance_signal_of(reference)] : NULL;
}

/* The kernel writes outputs; between steps they must stay those of the last step. */
static void compute(Instance *instance) {
    double *outputs = instance->block + hb_component.first_output;
    size_t size = (hb_component.mutable_size - hb_component.first_output) * sizeof(double);
    double *d = instance->direction, *kept = d + hb_component.size + 2 * hb_component.states;
    memcpy(kept, outputs, size);
    hb_component.tangent(instance->block, instance->now.time, d, d + hb_component.size);
    memcpy(outputs, kept, size);
}

/* Step of a central difference over the size of what is moved: eps^(1/3) makes the error of the
   difference and that of rounding alike (Dennis and Schnabel, Numerical Methods for Unconstrained
   Optimization, 1996, section 5.6); a start is found to some 1e-10, so that it is longer here. */
static const double MOVED = 1e-4;

static bool is_parameter(uint32_t reference) {
    return hb_component.access[reference] == HB_FIXED ||
           hb_component.access[reference] == HB_TUNABLE;
}

static bool is_moved(uint32_t reference) {
    return is_known(reference) || (instance_is_real(reference) && is_parameter(reference) &&
                                   !hb_component.reals[reference].whole);
}

/* Values of the unknowns where a known has another value. */
static Status look(Instance *instance, uint32_t known, double value, const uint32_t unknowns[],
                   size_t count, double values[]) {
    memset(instance->work, 0, hb_component.work * sizeof *instance->work);
    instance->block[known] = value;
    instance->outdated = instance->rates_outdated = true;
    return instance_get(instance, unknowns, count, values);
}

static Status add_difference(Instance *instance, uint32_t known, double seed,
                             const uint32_t unknowns[], size_t count, double both[],
                             double sensitivity[]) {
    const HbReal *real = &hb_component.reals[known];
    bool bounded = is_parameter(known);
    double value = instance->block[known], size = value != 0.0 ? fabs(value) : real->nominal;
    double low = value - MOVED * size, high = value + MOVED * size;
    if (bounded && low < real->minimum)
        low = value;
    if (bounded && high > real->maximum)
        high = value;
    Status status = look(instance, known, low, unknowns, count, both);
    if (status == STATUS_OK)
        status = look(instance, known, high, unknowns, count, both + count);
    for (size_t k = 0; status == STATUS_OK && k < count; k++)
        sensitivity[k] += seed * (both[count + k] - both[k]) / (high - low);
    return status;
}

/* The states are kept: they are where the next start is sought from. */
static Status by_differences(Instance *instance, const uint32_t unknowns[], size_t unknown_count,
                             const uint32_t knowns[], size_t known_count, const double seed[],
                             double sensitivity[]) {
    size_t length = hb_component.first_table;
    double *kept = malloc((length + 2 * unknown_count) * sizeof *kept);
    if (!kept)
        return refuse(instance, "out of memory");
    memcpy(kept, instance->block, length * sizeof *kept);
    memset(sensitivity, 0, unknown_count * sizeof *sensitivity);
    Status status = STATUS_OK;
    for (size_t k = 0; status == STATUS_OK && k < known_count; k++) {
        status = add_difference(instance, knowns[k], seed[k], unknowns, unknown_count,
                                kept + length, sensitivity);
        memcpy(instance->block, kept, length * sizeof *kept);
    }
    memset(instance->work, 0, hb_component.work * sizeof *instance->work);
    instance->outdated = instance->rates_outdated = true;
    free(kept);
    return status;
}

Status instance_directional_derivative(Instance *instance, const uint32_t unknowns[],
                                       size_t unknown_count, const uint32_t knowns[],
                                       size_t known_count, const double seed[],
                                       double sensitivity[]) {
    Status status = prepare(instance);
    if (status != STATUS_OK)
        return status;
    bool starting = instance->now.phase == PHASE_INITIALISATION;
    bool made = starting && (hb_component.settle || hb_component.start);
    for (size_t k = 0; k < known_count; k++) {
        made |= !is_known(knowns[k]);
        if (starting ? !is_moved(knowns[k]) : !is_known(knowns[k]))
            return instance_unknown(instance, starting ? "input, state or real parameter"
                                                       : "input or state", &knowns[k], 1);
        instance->direction[knowns[k]] += seed[k];
    }
    for (size_t k = 0; k < unknown_count; k++)
        if (!tangent_of(instance, unknowns[k]))
            return instance_unknown(instance, "output or derivative", &unknowns[k], 1);
    if (made)
        return by_differences(instance, unknowns, unknown_count, knowns, known_count, seed,
                              sensitivity);
    compute(instance);
    for (size_t k = 0; k < unknown_count; k++)
        sensitivity[k] = *tangent_of(instance, unknowns[k]);
    return STATUS_OK;
}
