#include "instance.h"

/* A search overwrites states that are set, but with one start mode, which is that for them. */
void hb_start_found(Instance *instance) {
    uint32_t state = instance->state_set - 1;
    if (!instance->state_set || instance->block[state] == instance->set_to)
        return;
    Message message;
    message_write(&message,
                  "%s: %s is set to %g, but the start is searched, where it is %g; states that are "
                  "set count with start_mode = as_set alone",
                  instance->name, real_name(state), message_number(instance->set_to),
                  message_number(instance->block[state]));
    log_write(&instance->log, STATUS_WARNING, &message);
}
