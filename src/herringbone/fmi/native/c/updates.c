#include <string.h>

#include "instance.h"

/* Integrals from 0 to node 1 ... 4 of the polynomial through the values at the five nodes of a step of
   length 1: Newton-Cotes. */
static const double INTEGRALS[HIGHEST_ORDER][HB_STRIDE] = {
    {251.0 / 2880.0, 646.0 / 2880.0, -264.0 / 2880.0, 106.0 / 2880.0, -19.0 / 2880.0},
    {29.0 / 360.0, 124.0 / 360.0, 24.0 / 360.0, 4.0 / 360.0, -1.0 / 360.0},
    {27.0 / 320.0, 102.0 / 320.0, 72.0 / 320.0, 42.0 / 320.0, -3.0 / 320.0},
    {14.0 / 180.0, 64.0 / 180.0, 24.0 / 180.0, 64.0 / 180.0, 14.0 / 180.0},
};

static double *signal_of(Instance *instance, uint32_t input) {
    return instance->block + hb_component.first_input + input * HB_STRIDE;
}

Status instance_set_within_step(Instance *instance, const uint32_t references[], size_t count,
                                const double values[]) {
    for (size_t i = 0; i < count; i++) {
        if (!instance_is_input(references[i]))
            return instance_unknown(instance, "intermediate input", &references[i], 1);
        instance->given |= 1u << (instance_input_number(references[i]) & 31u);
    }
    return instance_set(instance, references, count, values);
}

/* An input that runs on, which the host did not give: the integral of its rate. */
static void run_on(Instance *instance, const HbRunsOn *which, double step_size) {
    double *signal = instance->block + which->input;
    const double *rate = instance->block + which->rate;
    for (uint32_t node = 1; node < HB_STRIDE; node++) {
        double sum = 0.0;
        for (uint32_t i = 0; i < HB_STRIDE; i++)
            sum += INTEGRALS[node - 1][i] * rate[i];
        signal[node] = signal[0] + step_size * sum;
    }
}

bool instance_ask_inputs(Instance *instance, double step_size) {
    double start = instance->now.time, *first = instance->slopes;
    instance->given = 0;
    instance->asks = true;
    instance_run_on(instance);
    for (uint32_t node = 0; node < HB_STRIDE; node++) {
        instance->now.time = start + step_size * node / HIGHEST_ORDER;
        instance->update(instance, UPDATE_ASKS);
        for (uint32_t i = 0; i < hb_component.inputs; i++) {
            double *signal = signal_of(instance, i);
            if (node == 0)
                first[i] = signal[0];
            else
                signal[node] = signal[0];
        }
    }
    instance->asks = false;
    instance->now.time = start;
    if (!instance->given)
        return false;
    for (uint32_t i = 0; i < hb_component.inputs; i++)
        *signal_of(instance, i) = first[i];
    for (uint32_t k = 0; k < hb_component.runs_on_count; k++)
        if (!(instance->given >> (instance_input_number(hb_component.runs_on[k].input) & 31u) & 1u))
            run_on(instance, &hb_component.runs_on[k], step_size);
    return true;
}

void instance_keep_last_inputs(Instance *instance) {
    for (uint32_t i = 0; i < hb_component.inputs; i++) {
        double *signal = signal_of(instance, i);
        signal[0] = signal[HIGHEST_ORDER];
    }
    memset(instance->slopes, 0, hb_component.inputs * sizeof *instance->slopes);
}
