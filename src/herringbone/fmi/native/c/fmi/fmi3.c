/* FMI 3.0: life cycle, values, FMU states, co-simulation and partial derivatives. */
#include "fmi3Functions.h"

#include <stdlib.h>

#include "instance.h"

const char *fmi3GetVersion(void) {
    return fmi3Version;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t count,
                               const fmi3String categories[]) {
    return c ? (fmi3Status)instance_set_logging(c, on, count, categories) : fmi3Error;
}

static Log make_log(fmi3String name, fmi3Boolean on, fmi3InstanceEnvironment environment,
                    fmi3LogMessageCallback logger) {
    Log log = {.logger3 = logger, .environment = environment, .instance = name ? name : ""};
    log_switch(&log, on);
    return log;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resources,
                                          fmi3Boolean visible, fmi3Boolean logging,
                                          fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback logger) {
    (void)visible;
    Log log = make_log(name, logging, environment, logger);
    return instance_new(name, token, resources, true, &log);
}

static fmi3Instance refuse(const Log *log, const char *why) {
    Message message;
    message_write(&message, "%s: %s", log->instance, why);
    log_write(log, STATUS_ERROR, &message);
    return NULL;
}

/* Call the host within a step. It may not end the step early. */
static void update(Instance *instance, Update why) {
    bool asks = why == UPDATE_ASKS;
    fmi3Boolean early = false;
    fmi3Float64 end = instance->now.time;
    ((fmi3IntermediateUpdateCallback)instance->callback)(instance->log.environment,
                                                         instance->now.time, asks, !asks, !asks,
                                                         false, &early, &end);
}

static bool all_continuous(const fmi3ValueReference references[], size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!instance_is_input(references[i]) && !instance_is_output(references[i]))
            return false;
    return true;
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3Boolean event_mode_used, fmi3Boolean early_return_allowed,
    const fmi3ValueReference intermediate[], size_t intermediate_count,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
    fmi3IntermediateUpdateCallback intermediate_update) {
    (void)visible, (void)early_return_allowed;
    Log log = make_log(name, logging, environment, logger);
    if (event_mode_used)
        return refuse(&log, "co-simulation has no event mode here; instantiate without it");
    if (intermediate_count && !intermediate_update)
        return refuse(&log, "intermediate variables are required without a callback for them");
    if (!all_continuous(intermediate, intermediate_count))
        return refuse(&log, "inputs and outputs are intermediate variables, and no others");
    Instance *instance = instance_new(name, token, resources, false, &log);
    if (instance && intermediate_update) {
        instance->callback = (void (*)(void))intermediate_update;
        instance->update = update;
    }
    return instance;
}

fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String name, fmi3String token, fmi3String resources, fmi3Boolean visible,
    fmi3Boolean logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback logger,
    fmi3ClockUpdateCallback clock_update, fmi3LockPreemptionCallback lock,
    fmi3UnlockPreemptionCallback unlock) {
    (void)token, (void)resources, (void)visible, (void)clock_update, (void)lock, (void)unlock;
    Log log = make_log(name, logging, environment, logger);
    return refuse(&log, "this FMU offers no scheduled execution");
}

void fmi3FreeInstance(fmi3Instance c) {
    instance_free(c);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean tolerance_defined,
                                       fmi3Float64 tolerance, fmi3Float64 start,
                                       fmi3Boolean stop_defined, fmi3Float64 stop) {
    Instance *instance = c;
    if (!instance)
        return fmi3Error;
    if (instance->now.phase != PHASE_INSTANTIATED)
        return (fmi3Status)instance_refuse(instance, "enterInitializationMode");
    Status status = instance_set_tolerance(instance, tolerance_defined, tolerance);
    if (status == STATUS_OK)
        status = instance_set_time(instance, start, "start time");
    if (status == STATUS_OK)
        status = instance_set_stop(instance, stop_defined, stop);
    return (fmi3Status)(status == STATUS_OK ? instance_enter_initialisation(instance) : status);
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
    return c ? (fmi3Status)instance_exit_initialisation(c) : fmi3Error;
}

fmi3Status fmi3Terminate(fmi3Instance c) {
    return c ? (fmi3Status)instance_terminate(c) : fmi3Error;
}

fmi3Status fmi3Reset(fmi3Instance c) {
    return c ? (fmi3Status)instance_reset(c) : fmi3Error;
}

/* Number of elements of the variable of a value reference; 0: there is none. */
static size_t extent(fmi3ValueReference reference) {
    if (reference < hb_component.first_table)
        return hb_component.extents[reference];
    if (reference >= reference_of_rate(0) && reference < reference_of_time())
        return hb_component.extents[reference - reference_of_rate(0)];
    return reference >= reference_of_time() && reference <= last_reference();
}

/* Value references of all elements of the variables, one per value. If all are scalars, these are
   the given ones; otherwise `release` frees them. */
static Status expand(Instance *instance, const fmi3ValueReference references[], size_t count,
                     size_t value_count, const uint32_t **elements) {
    size_t sum = 0;
    *elements = references;
    for (size_t i = 0; i < count; i++) {
        size_t length = extent(references[i]);
        if (length == 0)
            return instance_unknown(instance, "Float64", &references[i], 1);
        sum += length;
    }
    if (sum != value_count)
        return instance_fail(instance, STATUS_ERROR, "%s: %zu values for %zu variables of %zu",
                             instance->name, value_count, count, sum);
    if (sum == count)
        return STATUS_OK;
    uint32_t *next = malloc(sum * sizeof *next);
    if (!next)
        return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
    *elements = next;
    for (size_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < extent(references[i]); k++)
            *next++ = references[i] + k;
    return STATUS_OK;
}

static void release(const uint32_t *elements, const fmi3ValueReference references[]) {
    if (elements != references)
        free((void *)elements);
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Float64 v[],
                          size_t value_count) {
    if (!c)
        return fmi3Error;
    const uint32_t *elements;
    Status status = expand(c, vr, n, value_count, &elements);
    if (status == STATUS_OK)
        status = instance_get(c, elements, value_count, v);
    release(elements, vr);
    return (fmi3Status)status;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                          const fmi3Float64 v[], size_t value_count) {
    if (!c)
        return fmi3Error;
    const uint32_t *elements;
    Instance *instance = c;
    Status status = expand(instance, vr, n, value_count, &elements);
    if (status == STATUS_OK)
        status = instance->asks ? instance_set_within_step(instance, elements, value_count, v)
                                : instance_set(instance, elements, value_count, v);
    release(elements, vr);
    return (fmi3Status)status;
}

static bool refuse_count(Instance *instance, const char *types, size_t count, size_t value_count) {
    if (count != value_count)
        instance_fail(instance, STATUS_ERROR, "%s: %zu values for %zu %s", instance->name,
                      value_count, count, types);
    return count != value_count;
}

/* Int64 are Enumerations, all scalars. */
fmi3Status fmi3GetInt64(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Int64 v[],
                        size_t value_count) {
    if (!c || refuse_count(c, "Enumerations", n, value_count))
        return fmi3Error;
    Status worst = STATUS_OK;
    for (size_t i = 0; i < n; i++) {
        v[i] = 0;
        Status status = instance_get_choice(c, vr[i], &v[i]);
        worst = status > worst ? status : worst;
    }
    return (fmi3Status)worst;
}

fmi3Status fmi3SetInt64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                        const fmi3Int64 v[], size_t value_count) {
    if (!c || refuse_count(c, "Enumerations", n, value_count))
        return fmi3Error;
    Status worst = STATUS_OK;
    for (size_t i = 0; i < n; i++) {
        Status status = instance_set_choice(c, vr[i], v[i]);
        worst = status > worst ? status : worst;
    }
    return (fmi3Status)worst;
}

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3String v[],
                         size_t value_count) {
    if (!c || refuse_count(c, "Strings", n, value_count))
        return fmi3Error;
    return (fmi3Status)instance_get_texts(c, vr, n, v);
}

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                         const fmi3String v[], size_t value_count) {
    if (!c || refuse_count(c, "Strings", n, value_count))
        return fmi3Error;
    return (fmi3Status)instance_set_texts(c, vr, n, v);
}

fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState *state) {
    return c && state ? (fmi3Status)instance_get_state(c, state) : fmi3Error;
}

fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
    return c ? (fmi3Status)instance_set_state(c, state) : fmi3Error;
}

fmi3Status fmi3FreeFMUState(fmi3Instance c, fmi3FMUState *state) {
    return !c ? fmi3Error : state ? (fmi3Status)instance_free_state(c, state) : fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state, size_t *size) {
    return c && size ? (fmi3Status)instance_serialised_size(c, state, size) : fmi3Error;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[],
                                 size_t size) {
    return c && bytes ? (fmi3Status)instance_serialise(c, state, (char *)bytes, size) : fmi3Error;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                   fmi3FMUState *state) {
    return c && bytes && state
               ? (fmi3Status)instance_deserialise(c, (const char *)bytes, size, state)
               : fmi3Error;
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                        size_t unknown_count, const fmi3ValueReference knowns[],
                                        size_t known_count, const fmi3Float64 seed[],
                                        size_t seed_count, fmi3Float64 sensitivity[],
                                        size_t sensitivity_count) {
    if (!c)
        return fmi3Error;
    const uint32_t *of, *by = knowns;
    Status status = expand(c, unknowns, unknown_count, sensitivity_count, &of);
    if (status == STATUS_OK)
        status = expand(c, knowns, known_count, seed_count, &by);
    if (status == STATUS_OK)
        status = instance_directional_derivative(c, of, sensitivity_count, by, seed_count, seed,
                                                 sensitivity);
    release(by, knowns);
    release(of, unknowns);
    return (fmi3Status)status;
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                    const fmi3Int32 orders[], fmi3Float64 v[],
                                    size_t value_count) {
    Instance *instance = c;
    if (!instance)
        return fmi3Error;
    if (n != value_count) /* outputs are scalars; their nodes have no derivatives */
        return (fmi3Status)instance_fail(instance, STATUS_ERROR, "%s: %zu values for %zu outputs",
                                         instance->name, value_count, n);
    return (fmi3Status)instance_get_output_derivatives(instance, vr, n, orders, v);
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 time, fmi3Float64 step_size,
                      fmi3Boolean no_set_before, fmi3Boolean *event_handling_needed,
                      fmi3Boolean *terminate, fmi3Boolean *early_return,
                      fmi3Float64 *last_successful_time) {
    (void)no_set_before;
    Instance *instance = c;
    if (!instance || !event_handling_needed || !terminate || !early_return || !last_successful_time)
        return fmi3Error;
    Status status = instance_step(instance, time, step_size);
    *event_handling_needed = *terminate = *early_return = false;
    *last_successful_time = instance->now.time;
    return (fmi3Status)status;
}
