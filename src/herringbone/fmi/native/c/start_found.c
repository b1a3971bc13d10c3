#include "instance.h"

/* A search overwrites states that are set, but with one start mode, which is that for them. */
void hb_start_found(Instance *instance) {
    uint32_t state = instance->state_set - 1;
    if (!instance->state_set || instance->block[state] == instance->set_to)
        return;
    Message message;
    message_write(&message,
                  "%s: %s = %g is dropped, as start_mode is not as_set",
                  instance->name, real_name(state), message_number(instance->set_to));
    log_write(&instance->log, STATUS_WARNING, &message);
}
