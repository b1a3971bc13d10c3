/* What the host did to the inputs in the last steps, for messages alone. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "instance.h"
#include "platform.h"

/* A jump is blamed that is so many times larger than those before. */
static const double LARGER = 2.0;
/* Of another jump; smaller ones beside it are noise, and tell nothing of a loop. */
static const double COUNTS = 1e-3;
static const char ADVICE[] = "communication_steps.txt";

/* fmax would need the mathematical library. */
static double larger(double a, double b) {
    return a > b ? a : b;
}

static double value_of(const Instance *instance, uint32_t input) {
    return instance->block[hb_component.first_input + input * HB_STRIDE];
}

static const HbRunsOn *runs_on(uint32_t input) {
    for (uint32_t k = 0; k < hb_component.runs_on_count; k++)
        if (instance_input_number(hb_component.runs_on[k].input) == input)
            return &hb_component.runs_on[k];
    return NULL;
}

/* The value of an input that was set at another time, at `time`. */
static double value_at(const Instance *instance, uint32_t input, double time) {
    const HbRunsOn *which = runs_on(input);
    double value = value_of(instance, input);
    return which ? value + instance->block[which->rate] * (time - instance->block[which->since])
                 : value;
}

static void note_inputs(Instance *instance) {
    for (uint32_t i = 0; i < hb_component.inputs; i++)
        instance->jumps[i * JUMPS + instance->steps % JUMPS] =
            instance->steps ? value_at(instance, i, instance->now.time) - instance->ahead[i] : 0.0;
    instance->steps++;
}

static void note_ahead(Instance *instance) {
    uint32_t degree = instance->now.last_degree;
    for (uint32_t i = 0; i < hb_component.inputs; i++)
        instance->ahead[i] =
            degree ? instance->block[hb_component.first_input + i * HB_STRIDE + degree]
                   : value_at(instance, i, instance->now.time);
}

/* What is known of an input's jumps: the largest of the newer half and of the older half, and how
   often the newer ones change their sign, noise left out. */
typedef struct {
    double newer, older;
    uint32_t turns;
} Jumps;

static Jumps jumps_of(const Instance *instance, uint32_t input) {
    const double *all = instance->jumps + input * JUMPS;
    uint32_t known = instance->steps < JUMPS ? instance->steps : JUMPS, half = (known + 1) / 2;
    Jumps found = {0.0, 0.0, 0};
    double before = 0.0;
    for (uint32_t k = known; k > 0; k--) { /* the last one has k = 1 */
        double jump = all[(instance->steps - k) % JUMPS], size = fabs(jump);
        double *largest = k <= half ? &found.newer : &found.older;
        *largest = larger(*largest, size);
        if (COUNTS * size > fabs(before))
            found.turns = 0;
        else if (COUNTS * fabs(before) >= size)
            continue;
        else if (k <= half && jump * before < 0.0)
            found.turns++;
        before = jump;
    }
    return found;
}

/* Number of the input whose jumps grow most; `inputs` if none does. */
static uint32_t culprit(const Instance *instance) {
    uint32_t found = hb_component.inputs;
    double most = LARGER;
    for (uint32_t i = 0; i < hb_component.inputs; i++) {
        Jumps jumps = jumps_of(instance, i);
        double growth = jumps.newer > 0.0 ? jumps.newer / larger(jumps.older, 1e-300) : 0.0;
        if (growth > most && jumps.newer > 1e-9 * fabs(value_of(instance, i))) {
            most = growth;
            found = i;
        }
    }
    return found;
}

/* The line of the documentation on communication steps at the port of an input, without its name. */
static void read_advice(const Instance *instance, const char *name, Message *advice) {
    Message reason;
    char *path = platform_join(instance->resources, ADVICE);
    char *text = path ? platform_read_text(path, &reason) : NULL;
    size_t length = strlen(name);
    while (length > 0 && name[length] != '.')
        length--;
    message_write(advice, "the FMU's documentation names stable ones");
    for (const char *line = text; line && *line;) {
        const char *next = strchr(line, '\n');
        size_t size = next ? (size_t)(next - line) : strlen(line);
        if (size > length + 2 && strncmp(line, name, length) == 0 && line[length] == ':')
            message_write(advice, "the FMU's documentation gives, for %.*s", (int)size, line);
        line = next ? next + 1 : NULL;
    }
    free(text);
    free(path);
}

static bool blame_input(Instance *instance, double step_size) {
    uint32_t input = culprit(instance);
    if (input == hb_component.inputs)
        return false;
    uint32_t reference = hb_component.first_input + input * HB_STRIDE;
    const char *name = real_name(reference), *unit = real_unit(reference);
    double jump = instance->jumps[input * JUMPS + (instance->steps - 1) % JUMPS];
    double value = instance->ahead[input] + jump;
    Jumps jumps = jumps_of(instance, input);
    if (jumps.turns == 0 && !(fabs(jump) > 0.5 * jumps.newer))
        return false; /* it is some steps ago */
    if (jumps.turns == 0) {
        instance_fail(instance, STATUS_DISCARD,
                      "%s.%s = %g %s after %g %s: it jumps, and no step of %g s can be computed "
                      "from there; check what the host gives",
                      instance->name, name, value, unit, instance->ahead[input], unit, step_size);
        return true;
    }
    Message advice;
    read_advice(instance, name, &advice);
    instance_fail(instance, STATUS_DISCARD,
                  "%s.%s = %g %s after %g %s: its changes alternate in sign and grow from step to "
                  "step, so that the loop through the host is unstable; make the communication step "
                  "smaller than %g s: %s",
                  instance->name, name, value, unit, instance->ahead[input], unit, step_size,
                  advice.text);
    return true;
}

static void take_back(Instance *instance) {
    instance->steps--;
}

const HbWatch hb_watch = {note_inputs, note_ahead, blame_input, take_back};
