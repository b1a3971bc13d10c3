#include "instance.h"

/* The first parameter that is not as the FMU was made, of those that tell what the component is; 0:
   none, as the block begins with states. */
static uint32_t changed_parameter(const Instance *instance) {
    for (uint32_t k = hb_component.mutable_size; k < hb_component.first_table; k++)
        if (hb_component.access[k] >= HB_FIXED && !hb_component.reals[k].method &&
            instance->block[k] != hb_component.reals[k].start)
            return k;
    return 0;
}

/* States that an FMU was made with suit the parameters that it was made with; those that `start`
   writes follow them. */
void hb_start_made(Instance *instance) {
    for (uint32_t k = 0; k < hb_component.states; k++)
        if (hb_component.access[k] == HB_STATE && instance->block[k] != hb_component.reals[k].start)
            return;
    uint32_t changed = changed_parameter(instance);
    if (!changed)
        return;
    Message message;
    message_write(&message,
                  "%s: %s is set to %g, but the states start as this FMU was made, with %g, and may "
                  "swing into another equilibrium; export it with the value, or set the states",
                  instance->name, real_name(changed), message_number(instance->block[changed]),
                  message_number(hb_component.reals[changed].start));
    log_write(&instance->log, STATUS_WARNING, &message);
}
