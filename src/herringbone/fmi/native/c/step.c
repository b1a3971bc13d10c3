#include <math.h>
#include <string.h>

#include "instance.h"

/* Relative difference of times that are one: of sums of a million steps. */
static const double SLACK = 1e-9;

static bool in_vector(uint32_t index) {
    return hb_component.access[index] == HB_HIDDEN || hb_component.access[index] == HB_ELEMENT;
}

/* The first entry that is NaN or infinite, those of state vectors last; `first_table` if there is
   none. */
static uint32_t first_not_finite(const Instance *instance) {
    for (int last = 0; last < 2; last++)
        for (uint32_t i = 0; i < hb_component.first_table; i++)
            if (in_vector(i) == last && !isfinite(instance->block[i]))
                return i;
    return hb_component.first_table;
}

/* Status of a step kernel, see kernels/stepping/adaptive.py. */
enum { INNER_STEPS_TOO_SMALL = 3 };

static Status explain_failure(Instance *instance, int32_t failed, double step_size) {
    if (hb_component.longest_step && step_size > hb_component.longest_step(instance->block))
        return instance_fail(instance, STATUS_DISCARD,
                             "%s: step size %g s; one call takes at most %g s", instance->name,
                             step_size, hb_component.longest_step(instance->block));
    instance_tell_remarks(instance);
    if (instance_blame_remark(instance, step_size))
        return STATUS_DISCARD;
    if (hb_component.watch && hb_component.watch->blame(instance, step_size))
        return STATUS_DISCARD;
    if (failed == INNER_STEPS_TOO_SMALL && hb_component.tolerance)
        return instance_fail(instance, STATUS_DISCARD,
                             "%s: the tolerance %g asks for inner steps below 1e-13 s under steady "
                             "inputs: the inner step is the cause, whatever the communication step "
                             "size; give a larger tolerance, or smaller inputs",
                             instance->name, instance->block[hb_component.tolerance]);
    instance_complete(instance);
    uint32_t i = first_not_finite(instance);
    bool found = i < hb_component.first_table;
    const char *name = found ? real_name(i) : "result", *unit = found ? real_unit(i) : "";
    return instance_fail(instance, STATUS_DISCARD,
                         "%s.%s%s = %g%s%s after a step of %g s; "
                         "reduce the communication step size, or check the inputs",
                         instance->name, *name ? name : "hidden state", found ? real_node(i) : "",
                         found ? message_number(instance->block[i]) : NAN, *unit ? " " : "", unit,
                         step_size);
}

static Status refuse_step(Instance *instance, double time, double step_size) {
    if (instance->now.phase < PHASE_STEP)
        return instance_fail(instance, STATUS_ERROR, "%s: doStep before the end of initialisation",
                             instance->name);
    if (instance->now.phase != PHASE_STEP)
        return instance_refuse(instance, "doStep");
    if (!isfinite(time))
        return instance_set_time(instance, time, "communication point");
    return instance_fail(instance, STATUS_ERROR,
                         "%s: step size %g s; it must be 0 or positive, and finite",
                         instance->name, message_number(step_size));
}

static int32_t step(Instance *instance, double time, double step_size) {
    return hb_component.step(instance->block, instance->work, time, step_size);
}

/* Input derivatives are told to the kernels as nodes, of the degree of their highest order. */
static int32_t step_along_derivatives(Instance *instance, double time, double step_size) {
    double *live = &instance->block[hb_component.degree];
    instance->now.last_degree = input_derivatives_to_nodes(instance, step_size);
    *live = instance->now.last_degree;
    int32_t failed = step(instance, time, step_size);
    *live = 0.0;
    return failed;
}

/* Inputs that the host gives within the step make nodes of the highest degree. */
static int32_t step_along_updates(Instance *instance, double time, double step_size) {
    if (!instance_ask_inputs(instance, step_size))
        return step(instance, time, step_size);
    double *live = &instance->block[hb_component.degree];
    *live = instance->now.last_degree = HIGHEST_ORDER;
    int32_t failed = step(instance, time, step_size);
    *live = 0.0;
    instance_keep_last_inputs(instance);
    return failed;
}

static int32_t step_along_inputs(Instance *instance, double time, double step_size) {
    if (instance->now.input_order)
        return step_along_derivatives(instance, time, step_size);
    if (instance->update && hb_component.inputs && !instance->now.last_degree && step_size > 0.0)
        return step_along_updates(instance, time, step_size);
    return step(instance, time, step_size);
}

/* What runs on goes on from the end of its nodes. */
static void leave_nodes(Instance *instance) {
    double *block = instance->block;
    for (uint32_t k = 0; instance->now.last_degree && k < hb_component.runs_on_count; k++) {
        const HbRunsOn *which = &hb_component.runs_on[k];
        block[which->input] = block[which->input + instance->now.last_degree];
        block[which->since] = instance->now.time;
    }
}

static Status refuse_two_signals(Instance *instance) {
    return instance_fail(instance, STATUS_ERROR,
                         "%s.interface_degree = %g: it must be 0 in a step along input derivatives",
                         instance->name, instance->block[hb_component.degree]);
}

static void keep(Instance *instance) {
    memcpy(instance->before, instance->block, hb_component.first_output * sizeof(double));
    if (instance->now.input_order)
        memcpy(instance->before + hb_component.first_output, instance->slopes,
               instance_slopes_length() * sizeof(double));
    instance_keep_outputs(instance);
}

/* As before the step, whose start is the last time that was reached. */
static void go_back(Instance *instance, const Moment *then) {
    instance->now = *then;
    memcpy(instance->block, instance->before, hb_component.first_output * sizeof(double));
    if (then->input_order)
        memcpy(instance->slopes, instance->before + hb_component.first_output,
               instance_slopes_length() * sizeof(double));
    instance_restore_outputs(instance);
    if (hb_component.watch)
        hb_component.watch->take_back(instance);
}

Status instance_step(Instance *instance, double time, double step_size) {
    Moment *now = &instance->now;
    if (now->phase != PHASE_STEP || !isfinite(time) || !(step_size >= 0.0 && step_size < INFINITY))
        return refuse_step(instance, time, step_size);
    if (time + step_size > now->stop + SLACK * (1.0 + fabs(now->stop)))
        return instance_fail(instance, STATUS_ERROR,
                             "%s: a step from %g s by %g s ends after the stop time of %g s",
                             instance->name, time, step_size, now->stop);
    now->time = time;
    if (now->input_order && instance->block[hb_component.degree] != 0.0)
        return refuse_two_signals(instance);
    Moment then = *now;
    keep(instance);
    now->last_step = step_size;
    now->last_degree = (uint32_t)instance->block[hb_component.degree];
    if (hb_component.watch)
        hb_component.watch->before_step(instance);
    int32_t failed = step_along_inputs(instance, time, step_size);
    instance->rates_outdated = true;
    if (failed) {
        Status status = explain_failure(instance, failed, step_size);
        go_back(instance, &then);
        return status;
    }
    now->time = time + step_size;
    now->end_node = now->last_degree;
    leave_nodes(instance);
    if (hb_component.watch)
        hb_component.watch->after_step(instance);
    instance_tell_remarks(instance);
    if (instance->update)
        instance->update(instance, UPDATE_REACHED);
    return STATUS_OK;
}
