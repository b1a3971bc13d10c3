#include "instance.h"

/* What the kernel tells of a remark. */
enum { HOLDS = 1, FAILS_STEPS = 2 };

/* As the kernel, with the text. */
static int32_t remark_of(Instance *instance, uint32_t k, Message *text) {
    double report[HB_REPORT] = {0.0};
    int32_t found = hb_component.remark(instance->block, instance->work, (int32_t)k, report);
    if (found)
        message_write(text, hb_component.remarks[k].format, report[0], report[1], report[2],
                      report[3], report[4], report[5], report[6], report[7], report[8], report[9],
                      report[10], report[11]);
    return found;
}

void instance_tell_remarks(Instance *instance) {
    for (uint32_t k = 0; k < hb_component.remarks_count && k < 32; k++) {
        Message why, message;
        if (instance->told >> k & 1u || !(remark_of(instance, k, &why) & HOLDS))
            continue;
        instance->told |= 1u << k;
        message_write(&message, "%s: %s (t = %g s)", instance->name, why.text, instance->now.time);
        log_write(&instance->log,
                  hb_component.remarks[k].warning ? STATUS_WARNING : STATUS_OK, &message);
    }
}

bool instance_blame_remark(Instance *instance, double step_size) {
    Message why;
    for (uint32_t k = 0; k < hb_component.remarks_count; k++)
        if (remark_of(instance, k, &why) & FAILS_STEPS) {
            instance_fail(instance, STATUS_DISCARD, "%s: a step of %g s fails, whose cause is %s",
                          instance->name, step_size, why.text);
            return true;
        }
    return false;
}
