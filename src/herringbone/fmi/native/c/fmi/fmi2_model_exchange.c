/* FMI 2.0: model exchange and partial derivatives. */
#include "fmi2Functions.h"

#include "instance.h"

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    return c ? (fmi2Status)instance_enter_event_mode(c) : fmi2Error;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    if (!c || !info)
        return fmi2Error;
    *info = (fmi2EventInfo){.newDiscreteStatesNeeded = fmi2False};
    return (fmi2Status)instance_update_discrete_states(c);
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    return c ? (fmi2Status)instance_enter_continuous_mode(c) : fmi2Error;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean no_set_before,
                                       fmi2Boolean *enter_event_mode, fmi2Boolean *terminate) {
    (void)no_set_before;
    if (!c || !enter_event_mode || !terminate)
        return fmi2Error;
    *enter_event_mode = *terminate = fmi2False;
    return (fmi2Status)instance_complete_integrator_step(c);
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    return c ? (fmi2Status)instance_move_time(c, time) : fmi2Error;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t n) {
    return c ? (fmi2Status)instance_set_continuous_states(c, x, n) : fmi2Error;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dx[], size_t n) {
    return c ? (fmi2Status)instance_get_rates(c, dx, n) : fmi2Error;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real z[], size_t n) {
    return c ? (fmi2Status)instance_get_indicators(c, z, n) : fmi2Error;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t n) {
    return c ? (fmi2Status)instance_get_continuous_states(c, x, n) : fmi2Error;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t n) {
    return c ? (fmi2Status)instance_get_nominals(c, nominals, n) : fmi2Error;
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknowns[],
                                        size_t unknown_count, const fmi2ValueReference knowns[],
                                        size_t known_count, const fmi2Real seed[],
                                        fmi2Real sensitivity[]) {
    return c ? (fmi2Status)instance_directional_derivative(c, unknowns, unknown_count, knowns,
                                                           known_count, seed, sensitivity)
             : fmi2Error;
}
