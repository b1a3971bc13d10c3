/* What the FMI wrapper knows of a component.

   The build generates one C file that defines `hb_component` from the component's declaration, and
   one object with its kernels. Everything else of a native FMU is the same for all components.

   The block is one array of doubles: states (hidden ones last), inputs, outputs, locals, parameters,
   tables. The value reference of a real is its index in the block. */

#ifndef HERRINGBONE_COMPONENT_H
#define HERRINGBONE_COMPONENT_H

#include <stdbool.h>
#include <stdint.h>

/* Values of a signal with nodes: X, X.node1 ... X.node4, side by side in the block. */
#define HB_STRIDE 5
/* Numbers that a refusal may show. */
#define HB_REPORT 12

/* What the environment may do with an entry of the block. */
enum HbAccess {
    HB_HIDDEN,     /* no FMI variable: what an FMU does not show, such as elements of a state vector
                      that are not in use */
    HB_ELEMENT,    /* never set: element of a state vector, made when initialisation ends */
    HB_INPUT,      /* set at any time */
    HB_OUTPUT,     /* never set */
    HB_LOCAL,      /* never set */
    HB_STATE,      /* set until initialisation ends */
    HB_FIXED,      /* parameter, set until initialisation ends */
    HB_TUNABLE     /* parameter, set at any time */
};

/* A real variable; the nodes of a signal are variables too ("X.node1"). */
typedef struct {
    double start, minimum, maximum;
    double nominal; /* of a state; 1 otherwise */
    uint8_t whole;  /* a parameter that takes whole numbers only */
    uint8_t node;   /* number of a signal's node, 1 ...; 0: the variable itself */
    uint8_t choice; /* an Enumeration for FMI, whole from 0; no real */
    uint8_t method; /* a parameter that tells how the component is integrated, not what it is */
} HbReal;

/* A column of a resource file. */
typedef struct {
    const char *name;
    const char *const *units; /* numbers: units it may have, NULL at the end; NULL: words */
    const char *const *words; /* words: the k-th one is read as k, NULL at the end */
    uint8_t other_words;      /* further words are allowed, and read as -1 */
    uint8_t rest;             /* the last entry only: all further columns of the file, whatever their
                                 names, are numbers in the unit that stands under this name */
} HbColumn;

/* A String parameter that names a resource file; `columns` is its grammar. The file may have a
   comment line "# header: ..." with header_count numbers. */
typedef struct {
    const char *name, *start;
    const HbColumn *columns;
    uint32_t column_count;
    const char *header;
    uint32_t header_count;
    const char *section; /* the part of the file behind the line "# section: ..."; NULL: all of it */
    uint32_t file;       /* the text whose file it is: itself, or another one, of which alone FMI
                            knows, as a String */
} HbText;

/* Why the load or verify kernel refuses: `text` is the resource file at fault (index in `texts`; -1:
   none, parameters are); the message is the file's path, then `format` with the report's numbers. The
   format has %g conversions only, at most HB_REPORT. */
typedef struct {
    int32_t text;
    const char *format;
} HbRefusal;

/* A state vector whose number of elements a resource file decides. Model exchange has as many as the
   data set with which the FMU is built; co-simulation takes any. */
typedef struct {
    uint32_t count;       /* elements that model exchange has */
    uint32_t length;      /* index of the entry of the tables that tells how many there are */
    uint32_t text;        /* the resource file that decides (index in `texts`) */
    const char *elements; /* what they stand for, such as "modes" */
} HbVector;

/* An input that is the integral of another one: where the host does not set it, it runs on. */
typedef struct {
    uint32_t input, rate; /* value references */
    uint32_t since;       /* index of the local that has the time of the input's value */
} HbRunsOn;

struct Instance;

/* What is kept of the inputs for messages, where hosts couple the FMU; see inputs.c. */
typedef struct {
    void (*before_step)(struct Instance *instance);
    void (*after_step)(struct Instance *instance);
    /* Of a step that failed, tells if an input is the cause: it jumps, or jumps that change sign and
       grow show an unstable loop. False if the inputs are steady. */
    bool (*blame)(struct Instance *instance, double step_size);
    /* After a step that failed: it has not been. */
    void (*take_back)(struct Instance *instance);
} HbWatch;
extern const HbWatch hb_watch;

/* Warns if the host has set a parameter, and none of the states that an FMU was made with to suit it. */
void hb_start_made(struct Instance *instance);
/* Warns if the host has set a state that `settle` has searched anew. */
void hb_start_found(struct Instance *instance);

/* What is logged once, as soon as it holds; the format is as that of a refusal. */
typedef struct {
    const char *format;
    uint8_t warning; /* 0: a matter of course */
} HbRemark;

typedef struct {
    const char *name;    /* FMI model identifier */
    const char *token;   /* guid of FMI 2, instantiationToken of FMI 3 */
    const char *sources; /* hash of the sources; part of a serialised state */

    /* Layout of the block. */
    uint32_t states; /* hidden ones included; they start at 0 */
    uint32_t visible_states;
    uint32_t first_input, inputs;        /* each HB_STRIDE long */
    uint32_t first_output, node_outputs; /* outputs with nodes, each HB_STRIDE long */
    uint32_t mutable_size;               /* length of what a step may change; parameters follow */
    uint32_t first_table, size;
    uint32_t work;   /* length of the kernels' work space; zeroed when parameters or tables change */
    uint32_t degree; /* index of the parameter interface_degree */

    /* Entries 0 ... first_table - 1 of the block. */
    const HbReal *reals;
    /* Of the entries that are no nodes, "" for hidden states: one text behind the other, as pointers
       would have to be relocated whenever the library is loaded. */
    const char *names, *units;
    const uint8_t *access;  /* HbAccess */
    const uint8_t *extents; /* FMI 3: length of the array of Float64 that starts here; 0: none does.
                               A signal with nodes is the scalar X and the array X.node[4], a state
                               vector is one array, and so are its derivatives. */
    const uint32_t *rates;  /* index of the output or state that is the entry's time derivative, 0:
                               none is known */

    uint32_t texts_count;
    const HbText *texts; /* value references size + k */

    /* Value references of FMI 3's `time` and of the states' derivatives follow those of the texts:
       der(state i) is size + texts_count + i, time is size + texts_count + states; then come the
       event indicators. */

    /* Kernels; those from `longest_step` on are NULL if the component has none. 0 is success. */
    int32_t (*step)(double *b, double *w, double t, double h);
    void (*rhs)(double *b, double t, double *dx);
    void (*out)(double *b, double t);
    /* The longest step [s] of one call; NULL: any. */
    double (*longest_step)(double *b);
    /* States from start parameters, before `out`, whenever the block changes in initialisation. */
    void (*start)(double *b);
    /* Tables from resource files: a refusal's number, counted from 1, or 0.
       values: file after file; for each one a number per declared column (index of the unit that the
       file uses, 0 for words), the numbers of its header line (NaN if it has none), then its rows, columns in declared order, further ones in file order.
       shape: for each file (rows, columns). scratch: `load_scratch` long.
       report: HB_REPORT numbers for the refusal's format. */
    int32_t (*load)(const double *values, const int64_t *shape, double *b, double *scratch,
                    double *report);
    /* What was loaded against the parameters, at the end of initialisation: as `load`. */
    int32_t (*verify)(double *b, double *report);
    /* The states at the start, from parameters and inputs, in place of `start`; not 0: in vain, and
       that line of `not_settled` is logged, counted from 1. */
    int32_t (*settle)(double *b, double t);
    const char *const *not_settled;
    /* With a remark's numbers for the format, after `out`, a sum: 1, it holds; 2, it is why a step
       failed that did. */
    uint32_t remarks_count;
    const HbRemark *remarks;
    int32_t (*remark)(double *b, double *w, int32_t which, double *report);
    uint32_t tolerance; /* index of the local that has the host's tolerance; 0: there is none */
    const HbWatch *watch; /* NULL: nothing is kept of the inputs, and the linker leaves it out */
    /* When initialisation ends: hb_start_made, if states start as the FMU was made; hb_start_found,
       if they are searched. */
    void (*start_made)(struct Instance *instance);
    uint32_t runs_on_count;
    const HbRunsOn *runs_on;
    uint32_t load_scratch;
    uint32_t refusals_count;
    const HbRefusal *refusals;

    /* Model exchange, offered if it has states: `exchanged` are their indices, in its order. */
    uint32_t exchanged_count;
    const uint32_t *exchanged;
    uint32_t vectors_count;
    const HbVector *vectors;
    uint32_t indicators_count;
    void (*indicators)(double *b, double t, double *z);
    /* Directional derivative. d, as long as the block: on entry the direction at states and inputs,
       zero elsewhere; on exit also the tangents of outputs and locals. dx, 2 states long: on exit the
       states' derivatives, then their tangents. b: outputs are written as `out` does. */
    void (*tangent)(double *b, double t, double *d, double *dx);
    /* Writes those of the entries that are stale: states and outputs that a step has not made; of no
       entries: all. NULL: steps make them. `stale` is the index of what tells which are stale: 0 none,
       1 those that were not asked for, 2 all; it is part of an FMU state. */
    void (*answer)(double *b, double *w, double t, const uint32_t *references, int64_t count);
    uint32_t stale;
} HbComponent;

extern const HbComponent hb_component;

#endif
