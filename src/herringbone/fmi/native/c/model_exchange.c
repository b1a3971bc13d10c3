/* Model exchange: the host integrates. */
#include <math.h>

#include "instance.h"

enum { ANY_MODE = 1u << PHASE_INITIALISATION | 1u << PHASE_EVENT | 1u << PHASE_CONTINUOUS };

/* True if the present phase is one of a set of bits. */
static bool in(const Instance *instance, unsigned phases) {
    return instance->model_exchange && phases >> instance->now.phase & 1u;
}

static Status refuse_length(Instance *instance, const char *what, size_t given, uint32_t wanted) {
    return instance_fail(instance, STATUS_ERROR, "%s: %zu %s; there are %u", instance->name, given,
                         what, (unsigned)wanted);
}

static Status move(Instance *instance, unsigned from, Phase to, const char *call) {
    if (!in(instance, from))
        return instance_refuse(instance, call);
    instance->now.phase = to;
    return STATUS_OK;
}

Status instance_enter_event_mode(Instance *instance) {
    return move(instance, 1u << PHASE_CONTINUOUS, PHASE_EVENT, "enterEventMode");
}

Status instance_enter_continuous_mode(Instance *instance) {
    return move(instance, 1u << PHASE_EVENT, PHASE_CONTINUOUS, "enterContinuousTimeMode");
}

/* There are no discrete states: an event only ends an integrator's step where a force law kinks. */
Status instance_update_discrete_states(Instance *instance) {
    return move(instance, 1u << PHASE_EVENT, PHASE_EVENT, "updateDiscreteStates");
}

Status instance_complete_integrator_step(Instance *instance) {
    return move(instance, 1u << PHASE_CONTINUOUS, PHASE_CONTINUOUS, "completedIntegratorStep");
}

Status instance_move_time(Instance *instance, double time) {
    if (!in(instance, 1u << PHASE_EVENT | 1u << PHASE_CONTINUOUS))
        return instance_refuse(instance, "setTime");
    instance->outdated = instance->rates_outdated = true;
    Status status = instance_set_time(instance, time, "time");
    instance_run_on(instance); /* an integrator's inputs are those of its time */
    return status;
}

/* Refuse a NaN or infinite number per state: the integrator may try a smaller step. */
static Status check_finite(Instance *instance, const double numbers[], const char *of) {
    for (uint32_t k = 0; k < hb_component.exchanged_count; k++)
        if (!isfinite(numbers[k]))
            return instance_fail(instance, STATUS_DISCARD,
                                 "%s: %s%s = %g; reduce the integrator's step, or check the inputs",
                                 instance->name, of, real_name(hb_component.exchanged[k]),
                                 message_number(numbers[k]));
    return STATUS_OK;
}

Status instance_set_continuous_states(Instance *instance, const double states[], size_t count) {
    if (!in(instance, 1u << PHASE_EVENT | 1u << PHASE_CONTINUOUS))
        return instance_refuse(instance, "setContinuousStates");
    if (count != hb_component.exchanged_count)
        return refuse_length(instance, "states", count, hb_component.exchanged_count);
    Status status = check_finite(instance, states, "");
    for (size_t k = 0; status == STATUS_OK && k < count; k++)
        instance->block[hb_component.exchanged[k]] = states[k];
    instance->outdated = instance->rates_outdated = true;
    return status;
}

Status instance_get_continuous_states(Instance *instance, double states[], size_t count) {
    if (!in(instance, ANY_MODE | 1u << PHASE_TERMINATED))
        return instance_refuse(instance, "getContinuousStates");
    if (count != hb_component.exchanged_count)
        return refuse_length(instance, "states", count, hb_component.exchanged_count);
    Status status = instance->outdated ? instance_refresh(instance) : STATUS_OK;
    for (size_t k = 0; k < count; k++)
        states[k] = instance->block[hb_component.exchanged[k]];
    return status;
}

Status instance_get_nominals(Instance *instance, double nominals[], size_t count) {
    if (!in(instance, ANY_MODE | 1u << PHASE_INSTANTIATED | 1u << PHASE_TERMINATED))
        return instance_refuse(instance, "getNominalsOfContinuousStates");
    if (count != hb_component.exchanged_count)
        return refuse_length(instance, "states", count, hb_component.exchanged_count);
    for (size_t k = 0; k < count; k++)
        nominals[k] = hb_component.reals[hb_component.exchanged[k]].nominal;
    return STATUS_OK;
}

Status instance_get_rates(Instance *instance, double rates[], size_t count) {
    if (!in(instance, ANY_MODE | 1u << PHASE_TERMINATED))
        return instance_refuse(instance, "getDerivatives");
    if (count != hb_component.exchanged_count)
        return refuse_length(instance, "derivatives", count, hb_component.exchanged_count);
    Status status = instance->rates_outdated ? instance_refresh_rates(instance) : STATUS_OK;
    if (status != STATUS_OK)
        return status;
    for (size_t k = 0; k < count; k++)
        rates[k] = instance->rates[hb_component.exchanged[k]];
    return check_finite(instance, rates, "derivative of ");
}

Status instance_get_indicators(Instance *instance, double indicators[], size_t count) {
    if (!in(instance, ANY_MODE | 1u << PHASE_TERMINATED))
        return instance_refuse(instance, "getEventIndicators");
    if (count != hb_component.indicators_count)
        return refuse_length(instance, "event indicators", count, hb_component.indicators_count);
    Status status = instance->outdated ? instance_refresh(instance) : STATUS_OK;
    if (status == STATUS_OK && count)
        hb_component.indicators(instance->block, instance->now.time, indicators);
    return status;
}
