#include <math.h>
#include <string.h>

#include "instance.h"

/* Write the nodes of a signal of degree `degree` from its value and derivatives at the start. */
static void expand(double *signal, const double *slopes, uint32_t degree, double step_size) {
    for (uint32_t node = 1; node <= degree; node++) {
        double since = step_size * node / degree, sum = 0.0;
        for (uint32_t order = degree; order > 0; order--)
            sum = (sum + slopes[order - 1]) * since / order;
        signal[node] = signal[0] + sum;
    }
}

/* An input that runs on, of which the host gave no derivative: from its value now, with its rate and
   the derivatives of that. */
static void run_on(Instance *instance, const HbRunsOn *which) {
    Moment *now = &instance->now;
    uint32_t input = instance_input_number(which->input);
    double *block = instance->block, *slopes = instance->slopes;
    double *own = slopes + input * HIGHEST_ORDER;
    const double *rates = slopes + instance_input_number(which->rate) * HIGHEST_ORDER;
    block[which->input] += block[which->rate] * (now->time - block[which->since]);
    own[0] = block[which->rate];
    for (int order = 1; order < HIGHEST_ORDER; order++)
        own[order] = rates[order - 1];
}

uint32_t input_derivatives_to_nodes(Instance *instance, double step_size) {
    Moment *now = &instance->now;
    double *signal = instance->block + hb_component.first_input;
    uint32_t degree = now->input_order;
    for (uint32_t k = 0; k < hb_component.runs_on_count; k++) {
        const HbRunsOn *which = &hb_component.runs_on[k];
        if (now->derivatives >> instance_input_number(which->input) & 1u)
            continue;
        run_on(instance, which);
        if (degree == now->input_order && degree < HIGHEST_ORDER)
            degree++;
    }
    for (uint32_t i = 0; i < hb_component.inputs; i++)
        expand(signal + i * HB_STRIDE, instance->slopes + i * HIGHEST_ORDER, degree, step_size);
    memset(instance->slopes, 0,
           (size_t)hb_component.inputs * HIGHEST_ORDER * sizeof *instance->slopes);
    now->input_order = now->derivatives = 0;
    return degree;
}

static Status set_input_derivative(Instance *instance, uint32_t reference, int32_t order,
                                   double value) {
    if (!instance_is_input(reference))
        return instance_unknown(instance, "input", &reference, 1);
    const char *name = real_name(reference);
    if (order < 1 || order > HIGHEST_ORDER)
        return instance_fail(instance, STATUS_ERROR,
                             "%s.%s: derivative of order %d; orders 1 to %d are known",
                             instance->name, name, (int)order, HIGHEST_ORDER);
    if (!isfinite(value))
        return instance_fail(instance, STATUS_ERROR,
                             "%s.%s: derivative %g; it must be finite", instance->name, name,
                             message_number(value));
    double degree = instance->block[hb_component.degree];
    if (degree != 0.0)
        return instance_fail(instance, STATUS_ERROR,
                             "%s.%s: input derivatives need interface_degree = 0, but it is %g: "
                             "the signals are given by nodes",
                             instance->name, name, degree);
    uint32_t input = instance_input_number(reference);
    if (input < 32)
        instance->now.derivatives |= 1u << input;
    instance->slopes[input * HIGHEST_ORDER + (uint32_t)order - 1] = value;
    if ((uint32_t)order > instance->now.input_order)
        instance->now.input_order = (uint32_t)order;
    return STATUS_OK;
}

Status instance_set_input_derivatives(Instance *instance, const uint32_t references[],
                                      size_t count, const int32_t orders[],
                                      const double values[]) {
    if (instance->model_exchange || instance->now.phase < PHASE_INITIALISATION ||
        instance->now.phase > PHASE_STEP)
        return instance_refuse(instance, "setRealInputDerivatives");
    Status worst = STATUS_OK;
    for (size_t i = 0; i < count; i++) {
        Status status = set_input_derivative(instance, references[i], orders[i], values[i]);
        worst = status > worst ? status : worst;
    }
    return worst;
}

/* Derivative at the end of the last step, of the polynomial through `degree` + 1 equidistant values
   of that step: the backward differences of order k, over k, summed. */
static double end_slope(double values[], uint32_t degree, double step_size) {
    double sum = 0.0;
    for (uint32_t order = 1; order <= degree; order++) {
        for (uint32_t i = degree; i >= order; i--)
            values[i] -= values[i - 1];
        sum += values[degree] / order;
    }
    return sum * degree / step_size;
}

static void exchange(double *a, double *b, size_t count) {
    for (size_t i = 0; i < count; i++) {
        double kept = a[i];
        a[i] = b[i];
        b[i] = kept;
    }
}

/* What follows from the coordinates need not be kept: `stale` stands before them. */
void instance_keep_outputs(Instance *instance) {
    uint32_t first = hb_component.first_output;
    double *oldest = instance->older;
    instance->older = instance->previous;
    instance->previous = oldest;
    if (hb_component.answer && instance->block[hb_component.stale] != 0.0)
        first = hb_component.stale;
    memcpy(instance->previous + first - hb_component.first_output, instance->block + first,
           (hb_component.mutable_size - first) * sizeof *instance->previous);
}

void instance_restore_outputs(Instance *instance) {
    uint32_t first = hb_component.first_output, stale = hb_component.stale;
    double *last = instance->previous;
    bool partly = hb_component.answer && last[stale - first] != 0.0;
    uint32_t from = partly ? stale : first;
    memcpy(instance->block + from, last + from - first,
           (hb_component.mutable_size - from) * sizeof *last);
    if (partly)
        instance->block[stale] = 2.0; /* made before, they are not kept */
    instance->previous = instance->older;
    instance->older = last;
}

/* Outputs at the start of the last step, if they were not made then: as if it had not been taken. */
static void complete_previous(Instance *instance) {
    uint32_t first = hb_component.first_output, states = hb_component.states;
    if (!hb_component.answer || instance->previous[hb_component.stale - first] == 0.0)
        return;
    size_t count = hb_component.mutable_size - first;
    double *block = instance->block, end = instance->now.time;
    memcpy(instance->rates, block, states * sizeof(double));
    exchange(block + first, instance->previous, count);
    block[hb_component.stale] = 2.0;
    instance->now.time = end - instance->now.last_step;
    instance_complete(instance);
    instance->now.time = end;
    exchange(block + first, instance->previous, count);
    memcpy(block, instance->rates, states * sizeof(double));
    instance->rates_outdated = true;
}

static double output_derivative(Instance *instance, uint32_t reference) {
    const double *block = instance->block;
    instance_complete(instance);
    if (hb_component.rates[reference])
        return block[hb_component.rates[reference]];
    if (!(instance->now.last_step > 0.0))
        return 0.0;
    complete_previous(instance);
    uint32_t place = reference - hb_component.first_output;
    bool nodes = place < hb_component.node_outputs * HB_STRIDE;
    uint32_t degree = nodes && instance->now.last_degree ? instance->now.last_degree : 1;
    double values[HB_STRIDE] = {instance->previous[place]};
    for (uint32_t node = 1; node < degree; node++)
        values[node] = block[reference + node];
    values[degree] = block[reference];
    return end_slope(values, degree, instance->now.last_step);
}

Status instance_get_output_derivatives(Instance *instance, const uint32_t references[],
                                       size_t count, const int32_t orders[], double values[]) {
    if (instance->now.phase != PHASE_STEP && instance->now.phase != PHASE_TERMINATED)
        return instance_refuse(instance, "getRealOutputDerivatives");
    for (size_t i = 0; i < count; i++) {
        if (!instance_is_output(references[i]))
            return instance_unknown(instance, "output", &references[i], 1);
        if (orders[i] != 1)
            return instance_fail(instance, STATUS_ERROR,
                                 "%s.%s: derivative of order %d; order 1 is known",
                                 instance->name, real_name(references[i]), (int)orders[i]);
        values[i] = output_derivative(instance, references[i]);
    }
    return STATUS_OK;
}
