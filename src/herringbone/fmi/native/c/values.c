#include <math.h>
#include <stdio.h>
#include <string.h>

#include "instance.h"

static bool is_finite(double value) {
    return value - value == 0.0;
}

static bool is_variable(uint32_t reference) {
    return reference < hb_component.first_table && hb_component.access[reference] != HB_HIDDEN;
}

static bool is_choice(uint32_t reference) {
    return is_variable(reference) && hb_component.reals[reference].choice;
}

/* A variable that is no parameter, of which alone some are no reals: `reals` is not looked at. */
static bool is_signal(uint32_t reference) {
    return reference < hb_component.first_table && hb_component.access[reference] != HB_HIDDEN &&
           hb_component.access[reference] < HB_FIXED;
}

bool instance_is_real(uint32_t reference) {
    return is_variable(reference) && !hb_component.reals[reference].choice;
}

bool instance_is_input(uint32_t reference) {
    return instance_is_real(reference) && hb_component.access[reference] == HB_INPUT &&
           (reference - hb_component.first_input) % HB_STRIDE == 0;
}

uint32_t instance_input_number(uint32_t reference) {
    return (reference - hb_component.first_input) / HB_STRIDE;
}

uint32_t instance_signal_of(uint32_t reference) {
    uint32_t place = reference - hb_component.first_output;
    return place < hb_component.node_outputs * HB_STRIDE ? reference - place % HB_STRIDE : reference;
}

bool instance_is_output(uint32_t reference) {
    return instance_is_real(reference) && hb_component.access[reference] == HB_OUTPUT &&
           instance_signal_of(reference) == reference;
}

uint32_t reference_of_rate(uint32_t state) {
    return hb_component.size + hb_component.texts_count + state;
}

uint32_t reference_of_time(void) {
    return reference_of_rate(hb_component.states);
}

uint32_t last_reference(void) {
    return reference_of_time() + hb_component.indicators_count;
}

Status instance_unknown(Instance *instance, const char *type, const uint32_t references[],
                        size_t count) {
    char list[200] = "";
    size_t used = 0;
    for (size_t i = 0; i < count && used < sizeof list - 20; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%u", used ? ", " : "",
                                 (unsigned)references[i]);
    return instance_fail(instance, STATUS_ERROR, "%s: there is no %s with value reference %s",
                         instance->name, type, list);
}

static bool is_stale(const Instance *instance) {
    return hb_component.answer && instance->block[hb_component.stale] != 0.0;
}

void instance_complete(Instance *instance) {
    if (is_stale(instance))
        hb_component.answer(instance->block, instance->work, instance->now.time, NULL, 0);
}

static Status get_indicator(Instance *instance, uint32_t k, double *value) {
    instance_complete(instance);
    hb_component.indicators(instance->block, instance->now.time, instance->indicators);
    *value = instance->indicators[k];
    return STATUS_OK;
}

/* A real that is no entry of the block: a derivative, the time, or an event indicator. */
static Status get_other(Instance *instance, uint32_t reference, double *value) {
    uint32_t state = reference - reference_of_rate(0);
    if (reference >= reference_of_rate(0) && state < hb_component.states) {
        Status status = instance->rates_outdated ? instance_refresh_rates(instance) : STATUS_OK;
        *value = instance->rates[state];
        return status;
    }
    if (reference == reference_of_time()) {
        *value = instance->now.time;
        return STATUS_OK;
    }
    if (reference > reference_of_time() && reference <= last_reference())
        return get_indicator(instance, reference - reference_of_time() - 1, value);
    *value = NAN;
    return instance_unknown(instance, "Real", &reference, 1);
}

static bool may_be_set(const Instance *instance, uint8_t access) {
    if (access == HB_INPUT || access == HB_TUNABLE)
        return true;
    return instance->now.phase < PHASE_STEP && (access == HB_STATE || access == HB_FIXED);
}

/* Start values: of what the host may set, which nothing computes before initialisation. */
static Status get_starts(Instance *instance, const uint32_t references[], size_t count,
                         double values[]) {
    Status worst = STATUS_OK;
    for (size_t i = 0; i < count; i++) {
        uint32_t reference = references[i];
        Status status = STATUS_OK;
        values[i] = NAN;
        if (reference == reference_of_time())
            values[i] = instance->now.time;
        else if (!is_signal(reference) && !instance_is_real(reference))
            status = instance_unknown(instance, "Real", &reference, 1);
        else if (may_be_set(instance, hb_component.access[reference]))
            values[i] = instance->block[reference];
        else
            status = instance_fail(instance, STATUS_ERROR,
                                   "%s.%s%s: it has no value before initialisation",
                                   instance->name, real_name(reference), real_node(reference));
        worst = status > worst ? status : worst;
    }
    return worst;
}

Status instance_get(Instance *instance, const uint32_t references[], size_t count,
                    double values[]) {
    if (instance->now.phase == PHASE_INSTANTIATED)
        return get_starts(instance, references, count, values);
    Status worst = instance->outdated ? instance_refresh(instance) : STATUS_OK;
    const double *block = instance->block;
    if (is_stale(instance) && count > 0)
        hb_component.answer(instance->block, instance->work, instance->now.time, references,
                            (int64_t)count);
    for (size_t i = 0; i < count; i++) {
        uint32_t reference = references[i];
        if (is_signal(reference) || instance_is_real(reference)) {
            values[i] = block[reference];
        } else {
            Status status = get_other(instance, reference, &values[i]);
            worst = status > worst ? status : worst;
        }
    }
    return worst;
}

static const char *kind_of(uint8_t access) {
    return access == HB_TUNABLE ? "tunable parameter"
           : access == HB_FIXED ? "fixed parameter"
           : access == HB_INPUT ? "continuous input"
           : access == HB_OUTPUT ? "continuous output"
                                 : "continuous local";
}

static Status refuse_value(Instance *instance, uint32_t reference, double value, const char *why) {
    const char *unit = real_unit(reference);
    bool plain = strcmp(unit, "1") == 0;
    return instance_fail(instance, STATUS_ERROR, "%s.%s%s = %g%s%s: %s", instance->name,
                         real_name(reference), real_node(reference), message_number(value),
                         plain ? "" : " ", plain ? "" : unit, why);
}

static Status check_value(Instance *instance, uint32_t reference, double value) {
    const HbReal *real = &hb_component.reals[reference];
    uint8_t access = hb_component.access[reference];
    if (!is_finite(value))
        return refuse_value(instance, reference, value, "it must be finite");
    if (access == HB_FIXED || access == HB_TUNABLE) {
        Message range;
        message_write(&range, "it must lie between %g and %g", real->minimum, real->maximum);
        if (value < real->minimum || value > real->maximum)
            return refuse_value(instance, reference, value, range.text);
        if (real->whole && value != (int)value)
            return refuse_value(instance, reference, value, "it must be a whole number");
    }
    return STATUS_OK;
}

static void outdate(Instance *instance) {
    instance->outdated =
        instance->now.phase != PHASE_STEP && instance->now.phase != PHASE_INSTANTIATED;
    instance->rates_outdated = true;
}

/* Set what is not simply a finite input. */
static Status set_checked(Instance *instance, uint32_t reference, double value) {
    Status status = check_value(instance, reference, value);
    if (status != STATUS_OK)
        return status;
    uint8_t access = hb_component.access[reference];
    if (!may_be_set(instance, access)) {
        Message why;
        message_write(&why, "a %s cannot be set now", kind_of(access));
        return refuse_value(instance, reference, value, why.text);
    }
    if (instance->block[reference] != value && reference >= hb_component.mutable_size) {
        instance_complete(instance);
        memset(instance->work, 0, hb_component.work * sizeof *instance->work);
    }
    instance->block[reference] = value;
    if (access == HB_STATE) {
        instance->state_set = reference + 1;
        instance->set_to = value;
    }
    return STATUS_OK;
}

void instance_run_on(Instance *instance) {
    double *block = instance->block, time = instance->now.time;
    for (uint32_t k = 0; k < hb_component.runs_on_count; k++) {
        const HbRunsOn *which = &hb_component.runs_on[k];
        if (instance->now.phase == PHASE_STEP)
            block[which->input] += block[which->rate] * (time - block[which->since]);
        block[which->since] = time;
    }
}

Status instance_set(Instance *instance, const uint32_t references[], size_t count,
                    const double values[]) {
    if (instance->now.phase == PHASE_TERMINATED)
        return instance_refuse(instance, "setReal");
    instance_run_on(instance); /* with the rate up to now, which may be set anew */
    Status worst = STATUS_OK;
    for (size_t i = 0; i < count; i++) {
        uint32_t reference = references[i];
        if (reference < hb_component.first_table && hb_component.access[reference] == HB_INPUT &&
            is_finite(values[i])) {
            instance->block[reference] = values[i];
            instance->now.end_node = 0;
        } else {
            Status status = instance_is_real(reference)
                                ? set_checked(instance, reference, values[i])
                                : instance_unknown(instance, "Real", &reference, 1);
            worst = status > worst ? status : worst;
        }
    }
    outdate(instance);
    return worst;
}

Status instance_get_choice(Instance *instance, uint32_t reference, int64_t *value) {
    if (!is_choice(reference))
        return instance_unknown(instance, "Integer", &reference, 1);
    *value = (int64_t)instance->block[reference];
    return STATUS_OK;
}

Status instance_set_choice(Instance *instance, uint32_t reference, int64_t value) {
    if (instance->now.phase == PHASE_TERMINATED)
        return instance_refuse(instance, "setInteger");
    if (!is_choice(reference))
        return instance_unknown(instance, "Integer", &reference, 1);
    Status status = set_checked(instance, reference, (double)value);
    outdate(instance);
    return status;
}
