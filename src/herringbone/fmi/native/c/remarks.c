#include "instance.h"

void instance_tell_remarks(Instance *instance) {
    for (uint32_t k = 0; k < hb_component.remarks_count && k < 32; k++) {
        double report[HB_REPORT] = {0.0};
        if (instance->told >> k & 1u ||
            !hb_component.remark(instance->block, instance->work, (int32_t)k, report))
            continue;
        instance->told |= 1u << k;
        Message why, message;
        message_write(&why, hb_component.remarks[k].format, report[0], report[1], report[2],
                      report[3], report[4], report[5], report[6], report[7], report[8], report[9],
                      report[10], report[11]);
        message_write(&message, "%s: %s (t = %g s)", instance->name, why.text, instance->now.time);
        log_write(&instance->log,
                  hb_component.remarks[k].warning ? STATUS_WARNING : STATUS_OK, &message);
    }
}
