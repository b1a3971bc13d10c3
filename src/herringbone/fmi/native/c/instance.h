/* An instance of the component: what FMI 2 and FMI 3 have in common.

   Every function returns the status that the FMI call returns; if it is not STATUS_OK, the host has
   been told why. Instances share nothing, so that different threads may use different ones. */
#ifndef INSTANCE_H
#define INSTANCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "component.h"
#include "log.h"
#include "texts.h"

/* Highest order of an input derivative: that of the polynomial that the nodes of a signal carry. */
enum { HIGHEST_ORDER = HB_STRIDE - 1 };

typedef enum {
    PHASE_INSTANTIATED,
    PHASE_INITIALISATION,
    PHASE_STEP,       /* co-simulation, between steps */
    PHASE_EVENT,      /* model exchange */
    PHASE_CONTINUOUS, /* model exchange */
    PHASE_TERMINATED
} Phase;

/* What an FMU state holds besides the texts and the saved part of the memory. */
typedef struct {
    double time;      /* end of the last step, or the time that the host set [s] */
    double last_step; /* length of the last step [s] */
    uint64_t tables;  /* hash of the tables; 0: no resource is read yet */
    int32_t phase;
    uint32_t last_degree; /* degree of the signals in the last step */
    uint32_t input_order; /* highest order of the input derivatives for the next step; 0: none */
    uint32_t derivatives; /* bit k: the host gave a derivative of input k for the next step */
    uint32_t end_node;    /* node that has the inputs of now, until the host sets some; 0: values */
    double stop;          /* no step goes beyond [s] */
} Moment;

/* So many changes of each input are kept for messages. */
enum { JUMPS = 16 };

typedef struct FmuState FmuState;

/* Why the host is called within a step: for its inputs at `now.time`, or as that has been reached. */
typedef enum { UPDATE_ASKS, UPDATE_REACHED } Update;

typedef struct Instance Instance;

struct Instance {
    Log log;
    char *name, *resources;
    bool model_exchange;
    bool outdated;       /* outputs must be computed before they are read */
    bool rates_outdated; /* derivatives of the states, too */
    int32_t not_settled; /* line that says what start was not found; 0: none */
    uint32_t state_set;  /* 1 + reference of the state that the host has set last; 0: none */
    double set_to;       /* its value */
    uint32_t told;       /* bit k: remark k was logged since the start of initialisation */
    Moment now;
    Texts *texts;
    FmuState *states; /* those that the host has not freed */

    /* One allocation. The saved part is previous, slopes, and the block up to its tables. */
    double *slopes; /* input derivatives for the next step: [inputs][HIGHEST_ORDER] */
    double *block, *work;
    double *previous; /* outputs and locals at the start of the last step */
    double *older;    /* the same of the step before; what a step that fails goes back to, ... */
    double *before;   /* ... as to slopes, states and inputs */
    double *rates;      /* derivatives of the states */
    double *indicators; /* work space for event indicators */

    double *ahead;      /* inputs at the end of the last step, as they would run on */
    double *jumps;      /* [inputs][JUMPS] of the last steps: by what the host changed them */
    uint32_t steps;     /* so many steps are known of */

    double *direction; /* of directional derivatives; NULL until one is asked for */

    void (*update)(Instance *instance, Update why); /* calls the host; NULL: it wants none */
    void (*callback)(void);                         /* what is called */
    bool asks;                                      /* the host may set inputs within the step */
    uint32_t given;                                 /* bit k: it has set input k */
};

/* instance.c: life cycle. */
Instance *instance_new(const char *name, const char *token, const char *resources,
                       bool model_exchange, const Log *log);
void instance_free(Instance *instance);
/* Lengths of `slopes` and `previous`. */
size_t instance_slopes_length(void);
size_t instance_previous_length(void);
Status instance_reset(Instance *instance);
Status instance_terminate(Instance *instance);
Status instance_set_logging(Instance *instance, bool on, size_t count,
                            const char *const categories[]);

/* Tell an error with its time; returns the status. */
Status instance_fail(Instance *instance, Status status, const char *format, ...) PRINTF_LIKE(3, 4);
/* The same for a call that the present phase does not allow. */
Status instance_refuse(Instance *instance, const char *call);

/* initialisation.c */
Status instance_set_time(Instance *instance, double time, const char *what);
/* A stop time that the host gives; without one steps go on for ever. */
Status instance_set_stop(Instance *instance, bool defined, double stop);
/* The tolerance that the host gives; if it gives none, that of the default experiment holds. */
Status instance_set_tolerance(Instance *instance, bool defined, double tolerance);
Status instance_enter_initialisation(Instance *instance);
Status instance_exit_initialisation(Instance *instance);
/* Read the resource files, if they are not read yet. */
Status instance_read_resources(Instance *instance);
/* Compute outdated outputs; outdated derivatives of the states. */
Status instance_refresh(Instance *instance);
Status instance_refresh_rates(Instance *instance);

/* remarks.c: log what holds now and was not told before. */
void instance_tell_remarks(Instance *instance);
/* Tell which one is why a step failed; false if none is. */
bool instance_blame_remark(Instance *instance, double step_size);

/* reals.c: what messages call a real, "" for a hidden state; the node is "" or ".node1" ... */
const char *real_name(uint32_t reference);
const char *real_node(uint32_t reference);
const char *real_unit(uint32_t reference);

/* text_values.c: Strings by value reference. */
Status instance_get_texts(Instance *instance, const uint32_t references[], size_t count,
                          const char *values[]);
Status instance_set_texts(Instance *instance, const uint32_t references[], size_t count,
                          const char *const values[]);

/* values.c: reals by value reference. */
/* Make all that a step has left stale. */
void instance_complete(Instance *instance);
Status instance_get(Instance *instance, const uint32_t references[], size_t count,
                    double values[]);
Status instance_set(Instance *instance, const uint32_t references[], size_t count,
                    const double values[]);
/* Tell that there are no variables of these references and type. */
Status instance_unknown(Instance *instance, const char *type, const uint32_t references[],
                        size_t count);
/* Inputs that run on are those of the present time; between steps they have come there. */
void instance_run_on(Instance *instance);
bool instance_is_real(uint32_t reference);
/* Enumerations by value reference. */
Status instance_get_choice(Instance *instance, uint32_t reference, int64_t *value);
Status instance_set_choice(Instance *instance, uint32_t reference, int64_t value);
/* An input itself, none of its nodes. */
bool instance_is_input(uint32_t reference);
/* Of an input or one of its nodes: which of the inputs, from 0. */
uint32_t instance_input_number(uint32_t reference);
/* Of an output or one of its nodes: the output. */
uint32_t instance_signal_of(uint32_t reference);
/* An output itself, none of its nodes. */
bool instance_is_output(uint32_t reference);
/* Value reference of a state's derivative; FMI 3: of the time. */
uint32_t reference_of_rate(uint32_t state);
uint32_t reference_of_time(void);
uint32_t last_reference(void); /* of the event indicators, if there are any */

/* step.c */
/* A step that fails leaves everything as it was before. */
Status instance_step(Instance *instance, double time, double step_size);

/* derivatives.c: input and output derivatives, an alternative to nodes.

   Input derivatives belong to the values at the start of the next step, and end with it; they need
   interface_degree = 0. An output derivative holds at the end of the last step: another output
   where that is the derivative; otherwise the slope of the polynomial through the values of the
   step, which is 0 before the first step. */
void instance_keep_outputs(Instance *instance);    /* at the start of a step */
void instance_restore_outputs(Instance *instance); /* of a step that failed */
Status instance_set_input_derivatives(Instance *instance, const uint32_t references[],
                                      size_t count, const int32_t orders[],
                                      const double values[]);
Status instance_get_output_derivatives(Instance *instance, const uint32_t references[],
                                       size_t count, const int32_t orders[], double values[]);
/* Write the nodes of all inputs, and forget the derivatives; returns the degree. */
uint32_t input_derivatives_to_nodes(Instance *instance, double step_size);

/* updates.c: inputs that the host gives at times within a step, an alternative to nodes. */
Status instance_set_within_step(Instance *instance, const uint32_t references[], size_t count,
                                const double values[]);
/* Ask for the inputs at all nodes of the next step, and write them; false if none was given. */
bool instance_ask_inputs(Instance *instance, double step_size);
/* After that step: inputs have the values of its end. */
void instance_keep_last_inputs(Instance *instance);

/* fmu_state.c */
Status instance_get_state(Instance *instance, void **state);
Status instance_set_state(Instance *instance, void *state);
Status instance_free_state(Instance *instance, void **state);
Status instance_serialised_size(Instance *instance, void *state, size_t *size);
Status instance_serialise(Instance *instance, void *state, char bytes[], size_t size);
Status instance_deserialise(Instance *instance, const char bytes[], size_t size, void **state);

/* model_exchange.c */
Status instance_enter_event_mode(Instance *instance);
Status instance_enter_continuous_mode(Instance *instance);
Status instance_update_discrete_states(Instance *instance);
Status instance_complete_integrator_step(Instance *instance);
Status instance_move_time(Instance *instance, double time);
Status instance_set_continuous_states(Instance *instance, const double states[], size_t count);
Status instance_get_continuous_states(Instance *instance, double states[], size_t count);
Status instance_get_nominals(Instance *instance, double nominals[], size_t count);
Status instance_get_rates(Instance *instance, double rates[], size_t count);
Status instance_get_indicators(Instance *instance, double indicators[], size_t count);

/* tangent.c */
Status instance_directional_derivative(Instance *instance, const uint32_t unknowns[],
                                       size_t unknown_count, const uint32_t knowns[],
                                       size_t known_count, const double seed[],
                                       double sensitivity[]);

#endif
