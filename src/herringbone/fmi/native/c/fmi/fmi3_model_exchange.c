/* FMI 3.0: model exchange. */
#include "fmi3Functions.h"

#include "instance.h"

fmi3Status fmi3EnterEventMode(fmi3Instance c) {
    return c ? (fmi3Status)instance_enter_event_mode(c) : fmi3Error;
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean *need_update,
                                    fmi3Boolean *terminate, fmi3Boolean *nominals_changed,
                                    fmi3Boolean *states_changed, fmi3Boolean *next_event_defined,
                                    fmi3Float64 *next_event) {
    if (!c || !need_update || !terminate || !nominals_changed || !states_changed ||
        !next_event_defined || !next_event)
        return fmi3Error;
    *need_update = *terminate = *nominals_changed = *states_changed = *next_event_defined = false;
    *next_event = 0.0;
    return (fmi3Status)instance_update_discrete_states(c);
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance c) {
    return c ? fmi3OK : fmi3Error; /* there are none */
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) {
    return c ? (fmi3Status)instance_enter_continuous_mode(c) : fmi3Error;
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean no_set_before,
                                       fmi3Boolean *enter_event_mode, fmi3Boolean *terminate) {
    (void)no_set_before;
    if (!c || !enter_event_mode || !terminate)
        return fmi3Error;
    *enter_event_mode = *terminate = false;
    return (fmi3Status)instance_complete_integrator_step(c);
}

fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64 time) {
    return c ? (fmi3Status)instance_move_time(c, time) : fmi3Error;
}

fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64 x[], size_t n) {
    return c ? (fmi3Status)instance_set_continuous_states(c, x, n) : fmi3Error;
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64 dx[], size_t n) {
    return c ? (fmi3Status)instance_get_rates(c, dx, n) : fmi3Error;
}

fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64 z[], size_t n) {
    return c ? (fmi3Status)instance_get_indicators(c, z, n) : fmi3Error;
}

fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64 x[], size_t n) {
    return c ? (fmi3Status)instance_get_continuous_states(c, x, n) : fmi3Error;
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64 nominals[], size_t n) {
    return c ? (fmi3Status)instance_get_nominals(c, nominals, n) : fmi3Error;
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance c, size_t *count) {
    if (!c || !count)
        return fmi3Error;
    *count = hb_component.indicators_count;
    return fmi3OK;
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance c, size_t *count) {
    if (!c || !count)
        return fmi3Error;
    *count = hb_component.exchanged_count;
    return fmi3OK;
}
