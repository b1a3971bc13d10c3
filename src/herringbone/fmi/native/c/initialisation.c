#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "flat_csv.h"
#include "instance.h"
#include "platform.h"

Status instance_set_time(Instance *instance, double time, const char *what) {
    if (!isfinite(time))
        return instance_fail(instance, STATUS_ERROR, "%s: %s %g s; it must be finite",
                             instance->name, what, message_number(time));
    instance->now.time = time;
    return STATUS_OK;
}

Status instance_set_stop(Instance *instance, bool defined, double stop) {
    if (defined && !(stop >= instance->now.time))
        return instance_fail(instance, STATUS_ERROR,
                             "%s: stop time %g s; it must not lie before the start time",
                             instance->name, message_number(stop));
    instance->now.stop = defined ? stop : INFINITY;
    return STATUS_OK;
}

Status instance_set_tolerance(Instance *instance, bool defined, double tolerance) {
    uint32_t at = hb_component.tolerance;
    if (defined && !(tolerance > 0.0 && tolerance < INFINITY))
        return instance_fail(instance, STATUS_ERROR,
                             "%s: tolerance %g; it must be positive and finite", instance->name,
                             message_number(tolerance));
    if (at)
        instance->block[at] = defined ? tolerance : hb_component.reals[at].start;
    return STATUS_OK;
}

Status instance_enter_initialisation(Instance *instance) {
    if (instance->now.phase != PHASE_INSTANTIATED)
        return instance_refuse(instance, "enterInitializationMode");
    instance->now.phase = PHASE_INITIALISATION;
    instance_run_on(instance);
    instance->outdated = true;
    return STATUS_OK;
}

/* Path of a table's resource file; NULL if there is none. */
static char *resource_path(Instance *instance, uint32_t table) {
    uint32_t k = hb_component.texts[table].file;
    const char *text = instance->texts->values[k];
    char *path = platform_join(instance->resources, text);
    if (path && platform_is_file(path))
        return path;
    instance_fail(instance, STATUS_ERROR,
                  "%s.%s = '%s': there is no file %s; give an absolute path or a name in %s",
                  instance->name, hb_component.texts[k].name, text, path ? path : text,
                  instance->resources);
    free(path);
    return NULL;
}

/* FNV-1a by words: a fingerprint, no protection. */
static uint64_t hash_tables(const double *tables, size_t count) {
    uint64_t hash = 0xCBF29CE484222325u;
    for (size_t i = 0; i < count; i++) {
        uint64_t word;
        memcpy(&word, &tables[i], sizeof word);
        hash = (hash ^ word) * 0x100000001B3u;
    }
    return hash ? hash : 1;
}

static Status refuse_tables(Instance *instance, int32_t number, char *const files[],
                            const double report[]) {
    if (number < 1 || (uint32_t)number > hb_component.refusals_count)
        return instance_fail(instance, STATUS_ERROR, "%s: the resource files are refused (%d)",
                             instance->name, (int)number);
    const HbRefusal *refusal = &hb_component.refusals[number - 1];
    Message why;
    message_write(&why, refusal->format, report[0], report[1], report[2], report[3], report[4],
                  report[5], report[6], report[7], report[8], report[9], report[10], report[11]);
    return instance_fail(instance, STATUS_ERROR, "%s: %s%s", instance->name,
                         refusal->text < 0 ? "" : files[refusal->text], why.text);
}

/* Model exchange has the states of the data set with which the FMU was built. */
static Status check_vectors(Instance *instance, char *const files[]) {
    for (uint32_t k = 0; instance->model_exchange && k < hb_component.vectors_count; k++) {
        const HbVector *vector = &hb_component.vectors[k];
        if (instance->block[vector->length] != vector->count)
            return instance_fail(instance, STATUS_ERROR,
                                 "%s: %s: %g %s, but this FMU was built for %u in model exchange; "
                                 "build it again with this file, or use co-simulation",
                                 instance->name, files[vector->text],
                                 instance->block[vector->length], vector->elements,
                                 (unsigned)vector->count);
    }
    return STATUS_OK;
}

static Status make_tables(Instance *instance, const Numbers *numbers, const int64_t *shape,
                          char *const files[]) {
    double report[HB_REPORT] = {0.0};
    double *scratch = calloc((size_t)hb_component.load_scratch + 1, sizeof *scratch);
    if (!scratch)
        return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
    double *tables = instance->block + hb_component.first_table;
    size_t count = hb_component.size - hb_component.first_table;
    memset(tables, 0, count * sizeof *tables);
    int32_t refusal = hb_component.load(numbers->values, shape, instance->block, scratch, report);
    free(scratch);
    if (refusal)
        return refuse_tables(instance, refusal, files, report);
    Status status = check_vectors(instance, files);
    if (status != STATUS_OK)
        return status;
    memset(instance->work, 0, hb_component.work * sizeof *instance->work);
    instance->now.tables = hash_tables(tables, count);
    return STATUS_OK;
}

static Status read_files(Instance *instance, char *files[], int64_t *shape, Numbers *numbers) {
    for (uint32_t k = 0; k < hb_component.texts_count; k++) {
        Message message;
        files[k] = resource_path(instance, k);
        if (!files[k])
            return STATUS_ERROR;
        if (!flat_csv_read(files[k], &hb_component.texts[k], numbers, shape + 2 * k, &message))
            return instance_fail(instance, STATUS_ERROR, "%s: %s", instance->name, message.text);
        message_write(&message, "%s: read %s", instance->name, files[k]);
        if (hb_component.texts[k].file == k)
            log_write(&instance->log, STATUS_OK, &message);
    }
    return STATUS_OK;
}

Status instance_read_resources(Instance *instance) {
    uint32_t count = hb_component.texts_count;
    if (count == 0 || instance->now.tables)
        return STATUS_OK;
    char **files = calloc(count, sizeof *files);
    int64_t *shape = calloc(2 * (size_t)count, sizeof *shape);
    Numbers numbers = {NULL, 0};
    Status status = files && shape ? read_files(instance, files, shape, &numbers)
                                   : instance_fail(instance, STATUS_ERROR, "%s: out of memory",
                                                   instance->name);
    if (status == STATUS_OK)
        status = make_tables(instance, &numbers, shape, files);
    free(numbers.values);
    for (uint32_t k = 0; files && k < count; k++)
        free(files[k]);
    free(files);
    free(shape);
    return status;
}

/* What was loaded against the parameters. */
static Status verify_tables(Instance *instance) {
    double report[HB_REPORT] = {0.0};
    int32_t refusal = hb_component.verify ? hb_component.verify(instance->block, report) : 0;
    if (refusal == 0)
        return STATUS_OK;
    uint32_t count = hb_component.texts_count, found = 0;
    char **files = calloc((size_t)count + 1, sizeof *files);
    if (!files)
        return instance_fail(instance, STATUS_ERROR, "%s: out of memory", instance->name);
    while (found < count && (files[found] = resource_path(instance, found)))
        found++;
    if (found == count)
        refuse_tables(instance, refusal, files, report);
    for (uint32_t k = 0; k < found; k++)
        free(files[k]);
    free(files);
    return STATUS_ERROR;
}

/* Inputs have no nodes yet. */
static void step_of_no_length(Instance *instance) {
    double *live = &instance->block[hb_component.degree], degree = *live;
    *live = 0.0;
    hb_component.step(instance->block, instance->work, instance->now.time, 0.0);
    *live = degree;
}

/* Outputs where no step was taken: at its nodes they are what they are now. */
static void level_nodes(Instance *instance) {
    double *signal = instance->block + hb_component.first_output;
    for (uint32_t k = 0; k < hb_component.node_outputs; k++, signal += HB_STRIDE)
        for (int node = 1; node < HB_STRIDE; node++)
            signal[node] = signal[0];
}

Status instance_exit_initialisation(Instance *instance) {
    if (instance->now.phase != PHASE_INITIALISATION)
        return instance_refuse(instance, "exitInitializationMode");
    instance->outdated = true;
    Status status = instance_refresh(instance);
    if (status == STATUS_OK)
        status = verify_tables(instance);
    if (status != STATUS_OK)
        return status;
    if (instance->not_settled) {
        Message message;
        message_write(&message, "%s: %s", instance->name, 
                      hb_component.not_settled[instance->not_settled - 1]);
        log_write(&instance->log, STATUS_WARNING, &message);
    }
    if (hb_component.start_made)
        hb_component.start_made(instance);
    if (hb_component.tolerance && !instance->model_exchange) /* the first step is not longer then */
        step_of_no_length(instance);
    if (!instance->model_exchange)
        instance_tell_remarks(instance);
    level_nodes(instance);
    instance->now.phase = instance->model_exchange ? PHASE_EVENT : PHASE_STEP;
    return STATUS_OK;
}

Status instance_refresh(Instance *instance) {
    if (instance->now.phase == PHASE_INITIALISATION) {
        Status status = instance_read_resources(instance);
        if (status != STATUS_OK)
            return status;
        if (hb_component.settle)
            instance->not_settled = hb_component.settle(instance->block, instance->now.time);
        else if (hb_component.start)
            hb_component.start(instance->block);
        instance->rates_outdated = true;
    }
    hb_component.out(instance->block, instance->now.time);
    if (instance->model_exchange)
        level_nodes(instance);
    instance->outdated = false;
    return STATUS_OK;
}

/* Inputs at the end of the last step in place of those at its start, and back. */
static void exchange_ends(Instance *instance) {
    uint32_t node = instance->now.end_node;
    double *signal = instance->block + hb_component.first_input;
    for (uint32_t k = 0; node && k < hb_component.inputs; k++, signal += HB_STRIDE) {
        double value = signal[0];
        signal[0] = signal[node];
        signal[node] = value;
    }
}

Status instance_refresh_rates(Instance *instance) {
    if (instance->outdated) {
        Status status = instance_refresh(instance);
        if (status != STATUS_OK)
            return status;
    }
    instance_complete(instance);
    exchange_ends(instance);
    hb_component.rhs(instance->block, instance->now.time, instance->rates);
    exchange_ends(instance);
    instance->rates_outdated = false;
    return STATUS_OK;
}
