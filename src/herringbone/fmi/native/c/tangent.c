/* Directional derivatives: outputs and derivatives of states, by inputs and states. */
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

Status instance_directional_derivative(Instance *instance, const uint32_t unknowns[],
                                       size_t unknown_count, const uint32_t knowns[],
                                       size_t known_count, const double seed[],
                                       double sensitivity[]) {
    Status status = prepare(instance);
    if (status != STATUS_OK)
        return status;
    for (size_t k = 0; k < known_count; k++) {
        if (!is_known(knowns[k]))
            return instance_unknown(instance, "input or state", &knowns[k], 1);
        instance->direction[knowns[k]] += seed[k];
    }
    compute(instance);
    for (size_t k = 0; k < unknown_count; k++) {
        const double *tangent = tangent_of(instance, unknowns[k]);
        if (!tangent)
            return instance_unknown(instance, "output or derivative", &unknowns[k], 1);
        sensitivity[k] = *tangent;
    }
    return STATUS_OK;
}
