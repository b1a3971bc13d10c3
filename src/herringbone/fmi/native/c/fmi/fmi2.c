/* FMI 2.0: functions of both interface types, and co-simulation. */
#include "fmi2Functions.h"

#include "instance.h"

_Static_assert(sizeof(fmi2Integer) == sizeof(int32_t) && sizeof(fmi2ValueReference) == sizeof(uint32_t),
               "orders and value references are passed on as they are");

const char *fmi2GetTypesPlatform(void) {
    return fmi2TypesPlatform;
}

const char *fmi2GetVersion(void) {
    return fmi2Version;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count,
                               const fmi2String categories[]) {
    return c ? (fmi2Status)instance_set_logging(c, on != fmi2False, count, categories) : fmi2Error;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                              fmi2String resources, const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible, fmi2Boolean logging) {
    (void)visible;
    Log log = {.instance = name ? name : ""};
    if (functions) {
        log.logger2 = functions->logger;
        log.environment = functions->componentEnvironment;
    }
    log_switch(&log, logging != fmi2False);
    return instance_new(name, guid, resources, type == fmi2ModelExchange, &log);
}

void fmi2FreeInstance(fmi2Component c) {
    instance_free(c);
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean tolerance_defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean stop_defined, fmi2Real stop) {
    Instance *instance = c;
    if (!instance)
        return fmi2Error;
    if (instance->now.phase != PHASE_INSTANTIATED)
        return (fmi2Status)instance_refuse(instance, "setupExperiment");
    Status status = instance_set_tolerance(instance, tolerance_defined, tolerance);
    if (status == STATUS_OK)
        status = instance_set_time(instance, start, "start time");
    return (fmi2Status)(status == STATUS_OK ? instance_set_stop(instance, stop_defined, stop)
                                            : status);
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    return c ? (fmi2Status)instance_enter_initialisation(c) : fmi2Error;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    return c ? (fmi2Status)instance_exit_initialisation(c) : fmi2Error;
}

fmi2Status fmi2Terminate(fmi2Component c) {
    return c ? (fmi2Status)instance_terminate(c) : fmi2Error;
}

fmi2Status fmi2Reset(fmi2Component c) {
    return c ? (fmi2Status)instance_reset(c) : fmi2Error;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real v[]) {
    return c ? (fmi2Status)instance_get(c, vr, n, v) : fmi2Error;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                       const fmi2Real v[]) {
    return c ? (fmi2Status)instance_set(c, vr, n, v) : fmi2Error;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                         fmi2String v[]) {
    return c ? (fmi2Status)instance_get_texts(c, vr, n, v) : fmi2Error;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                         const fmi2String v[]) {
    return c ? (fmi2Status)instance_set_texts(c, vr, n, v) : fmi2Error;
}

/* There are no Integers, but Enumerations. */
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          fmi2Integer v[]) {
    Status worst = c ? STATUS_OK : STATUS_ERROR;
    for (size_t i = 0; c && i < n; i++) {
        int64_t value = 0;
        Status status = instance_get_choice(c, vr[i], &value);
        v[i] = (fmi2Integer)value;
        worst = status > worst ? status : worst;
    }
    return (fmi2Status)worst;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          const fmi2Integer v[]) {
    Status worst = c ? STATUS_OK : STATUS_ERROR;
    for (size_t i = 0; c && i < n; i++) {
        Status status = instance_set_choice(c, vr[i], v[i]);
        worst = status > worst ? status : worst;
    }
    return (fmi2Status)worst;
}

/* There are no variables of type Boolean. */
static fmi2Status none(fmi2Component c, const fmi2ValueReference vr[], size_t n) {
    return !c ? fmi2Error : n ? (fmi2Status)instance_unknown(c, "Boolean", vr, n) : fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          fmi2Boolean v[]) {
    (void)v;
    return none(c, vr, n);
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          const fmi2Boolean v[]) {
    (void)v;
    return none(c, vr, n);
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    return c && state ? (fmi2Status)instance_get_state(c, state) : fmi2Error;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    return c ? (fmi2Status)instance_set_state(c, state) : fmi2Error;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    return !c ? fmi2Error : state ? (fmi2Status)instance_free_state(c, state) : fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    return c && size ? (fmi2Status)instance_serialised_size(c, state, size) : fmi2Error;
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                 size_t size) {
    return c && bytes ? (fmi2Status)instance_serialise(c, state, bytes, size) : fmi2Error;
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate *state) {
    return c && bytes && state ? (fmi2Status)instance_deserialise(c, bytes, size, state)
                               : fmi2Error;
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real v[]) {
    return c ? (fmi2Status)instance_set_input_derivatives(c, vr, n, order, v) : fmi2Error;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                        const fmi2Integer order[], fmi2Real v[]) {
    return c ? (fmi2Status)instance_get_output_derivatives(c, vr, n, order, v) : fmi2Error;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real step_size,
                      fmi2Boolean no_set_before) {
    (void)no_set_before;
    return c ? (fmi2Status)instance_step(c, time, step_size) : fmi2Error;
}

static fmi2Status not_offered(Instance *instance, const char *what) {
    if (!instance)
        return fmi2Error;
    return (fmi2Status)instance_fail(instance, STATUS_ERROR, "%s: %s", instance->name, what);
}

fmi2Status fmi2CancelStep(fmi2Component c) {
    return not_offered(c, "cancelStep: steps are not asynchronous");
}

static fmi2Status no_status(fmi2Component c) {
    return not_offered(c, "there is no status of this kind: steps are not asynchronous");
}

fmi2Status fmi2GetStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Status *value) {
    (void)kind, (void)value;
    return no_status(c);
}

fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real *value) {
    if (!c || kind != fmi2LastSuccessfulTime)
        return no_status(c);
    *value = ((Instance *)c)->now.time;
    return fmi2OK;
}

fmi2Status fmi2GetIntegerStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Integer *value) {
    (void)kind, (void)value;
    return no_status(c);
}

fmi2Status fmi2GetBooleanStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Boolean *value) {
    if (!c || kind != fmi2Terminated)
        return no_status(c);
    *value = fmi2False; /* a discarded step does not end the simulation */
    return fmi2OK;
}

fmi2Status fmi2GetStringStatus(fmi2Component c, const fmi2StatusKind kind, fmi2String *value) {
    (void)kind, (void)value;
    return no_status(c);
}
