/* A component made by hand, small enough to know its results in closed form: a rotor with two
   resource files.

       J gain w' = ratio tau,   phi' = w,   and two state vectors with room for two elements each

   of which as many are in use as `shapes` has columns of numbers but one; the FMU is built for one.
   The first element of `counter` counts steps; in model exchange its rate is the time.

   The work space caches ratio / (J gain).

   `gain` is the first number of the table `inertias`, the unit of `speed` there scales it, and
   `shapes` has a further column for each number that is summed into `offset`. */
#include "component.h"

#include <stddef.h>

#include "rotor.h"


#define NODES \
    {0, -1e300, 1e300, 1, 0, 0, 0, 0}, {0, -1e300, 1e300, 1, 0, 1, 0, 0}, \
    {0, -1e300, 1e300, 1, 0, 2, 0, 0}, {0, -1e300, 1e300, 1, 0, 3, 0, 0}, \
    {0, -1e300, 1e300, 1, 0, 4, 0, 0}
static const HbReal reals[] = {
    {0, -1e300, 1e300, 1, 0, 0, 0, 0},
    {0, -1e300, 1e300, 100, 0, 0, 0, 0},
    {0, -1e300, 1e300, 10, 0, 0, 0, 0},
    {0, -1e300, 1e300, 1, 0, 0, 0, 0},
    {0, -1e300, 1e300, 20, 0, 0, 0, 0},
    {0, -1e300, 1e300, 1, 0, 0, 0, 0},
    NODES,
    NODES,
    NODES,
    NODES,
    {0, -1e300, 1e300, 1, 0, 0, 0, 0},
    {0, -1e300, 1e300, 1, 0, 0, 0, 0},
    {2, 1e-9, 1e9, 1, 0, 0, 0, 0},
    {1, -1e9, 1e9, 1, 0, 0, 0, 0},
    {0, 0, 4, 1, 1, 0, 0, 1},
};
static const char names[] = "phi\0" "w\0" "counter[1]\0" "\0" "other[1]\0" "\0" "tau\0"
                            "flange.phi\0" "flange.w\0" "torque\0" "flange.a\0" "steps\0"
                            "inertia\0" "ratio\0" "interface_degree\0";
static const char units[] = "rad\0" "rad/s\0" "s\0" "\0" "1\0" "\0" "N.m\0" "rad\0" "rad/s\0"
                            "N.m\0" "rad/s2\0" "1\0" "kg.m2\0" "1\0" "1\0";
static const uint8_t access_of[] = {
    HB_STATE, HB_STATE, HB_ELEMENT, HB_HIDDEN, HB_ELEMENT, HB_HIDDEN,
    HB_INPUT, HB_INPUT, HB_INPUT, HB_INPUT, HB_INPUT,
    HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT,
    HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT,
    HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT, HB_OUTPUT,
    HB_OUTPUT, HB_LOCAL, HB_FIXED, HB_TUNABLE, HB_TUNABLE,
};
static const uint32_t exchanged[] = {PHI, W, COUNTER, OTHER};
static const uint8_t extents[] = {1, 1, 1, 0, 1, 0, 1, 4, 0, 0, 0, 1, 4, 0, 0, 0, 1, 4,
                                  0, 0, 0, 1, 4, 0, 0, 0, 1, 1, 1, 1, 1};
static const uint32_t rates[GAIN] = {[PHI] = W, [PHI_OUT] = W_OUT, [W_OUT] = A};

static const char *const side_words[] = {"left", "right", NULL};
static const char *const no_words[] = {NULL};
static const char *const kilogram[] = {"kg", NULL};
static const char *const speeds[] = {"r/min", "rad/s", NULL};
static const char *const shape_units[] = {"kg^-1/2", NULL};
static const HbColumn inertia_columns[] = {
    {"side", NULL, side_words, 0, 0}, {"mass", kilogram, NULL, 0, 0}, {"speed", speeds, NULL, 0, 0}};
static const HbColumn shape_columns[] = {{"point", NULL, no_words, 1, 0},
                                         {"shape", shape_units, NULL, 0, 1}};
static const HbText texts[] = {{"inertias", "inertias.csv", inertia_columns, 3, "", 0, NULL, 0},
                               {"shapes", "shapes.csv", shape_columns, 2, "", 0, NULL, 1}};
static const HbVector vectors[] = {{1, LENGTH, 1, "counters"}, {1, LENGTH, 1, "others"}};
static const HbRefusal refusals[] = {{0, ": mass %g kg in row %g must be positive"},
                                     {1, ": %g rows, %g expected"}};

static double signal_at(const double *nodes, int degree, double c) {
    double value[HB_STRIDE];
    for (int i = 0; i <= degree; i++)
        value[i] = nodes[i];
    for (int order = 1; order <= degree; order++) /* Neville */
        for (int i = 0; i <= degree - order; i++)
            value[i] += (c * degree - i) / order * (value[i + 1] - value[i]);
    return value[0];
}

static double acceleration(const double *b) {
    return b[RATIO] * b[TAU] / (b[INERTIA] * b[GAIN]);
}

static void rhs(double *b, double t, double *dx) {
    dx[PHI] = b[W];
    dx[W] = acceleration(b);
    dx[COUNTER] = t; /* so that the time shows */
    dx[COUNTER + 1] = dx[OTHER + 1] = 0.0;
    dx[OTHER] = -b[OTHER];
}

static void out(double *b, double t) {
    (void)t;
    b[PHI_OUT] = b[PHI];
    b[W_OUT] = b[W];
    b[TORQUE] = b[TAU] + b[OFFSET];
    b[A] = acceleration(b);
}

/* Exact for a torque that is at most linear in time. */
static int32_t step(double *b, double *w, double t, double h) {
    int degree = (int)b[DEGREE];
    int intervals = degree ? degree : 1;
    double kept = b[TAU];
    if (w[0] == 0.0)
        w[0] = b[RATIO] / (b[INERTIA] * b[GAIN]);
    for (int node = 1; node <= intervals; node++) {
        double hs = h / intervals, a[3];
        for (int k = 0; k < 3; k++)
            a[k] = w[0] * signal_at(b + TAU, degree, (node - 1 + 0.5 * k) / intervals);
        b[PHI] += hs * b[W] + hs * hs * (a[0] + 2.0 * a[1]) / 6.0;
        b[W] += hs * (a[0] + 4.0 * a[1] + a[2]) / 6.0;
        b[TAU] = signal_at(b + TAU, degree, (double)node / intervals);
        out(b, t + node * hs);
        b[TAU] = kept;
        b[PHI_OUT + node] = b[PHI_OUT];
        b[W_OUT + node] = b[W_OUT];
        b[TORQUE + node] = b[TORQUE];
    }
    b[COUNTER] += 1.0;
    b[STEPS] = b[COUNTER];
    return b[W] - b[W] == 0.0 ? 0 : 1;
}

static int32_t load(const double *values, const int64_t *shape, double *b, double *scratch,
                    double *report) {
    (void)scratch;
    const double *row = values + 3;
    b[GAIN] = row[1] * (values[2] == 1.0 ? 1.0 : 10.0);
    for (int64_t i = 0; i < shape[0]; i++, row += shape[1]) {
        if (row[1] <= 0.0) {
            report[0] = row[1];
            report[1] = (double)(i + 1);
            return 1;
        }
    }
    if (shape[2] != 2) {
        report[0] = (double)shape[2];
        report[1] = 2.0;
        return 2;
    }
    row += 2;
    b[LENGTH] = (double)(shape[3] - 2);
    for (int64_t i = 0; i < shape[2]; i++, row += shape[3])
        for (int64_t k = 1; k < shape[3]; k++)
            b[OFFSET] += row[k];
    return 0;
}

static void indicators(double *b, double t, double *z) {
    (void)t;
    z[0] = b[PHI] - 1.0;
}

static void tangent(double *b, double t, double *d, double *dx) {
    rhs(b, t, dx);
    out(b, t);
    double *rate = dx + STATES;
    rate[PHI] = d[W];
    rate[W] = b[RATIO] * d[TAU] / (b[INERTIA] * b[GAIN]);
    rate[COUNTER] = rate[COUNTER + 1] = rate[OTHER + 1] = 0.0;
    rate[OTHER] = -d[OTHER];
    d[PHI_OUT] = d[PHI];
    d[W_OUT] = d[W];
    d[TORQUE] = d[TAU];
    d[A] = rate[W];
}

const HbComponent hb_component = {
    .name = "rotor", .token = "{token}", .sources = SOURCES,
    .states = STATES, .visible_states = 2, .first_input = TAU, .inputs = 1, .first_output = PHI_OUT,
    .node_outputs = 3, .mutable_size = INERTIA, .first_table = GAIN, .size = SIZE, .work = 1,
    .degree = DEGREE, .reals = reals, .names = names, .units = units, .access = access_of,
    .extents = extents, .rates = rates,
    .texts_count = 2, .texts = texts, .step = step, .rhs = rhs, .out = out, .load = load,
    .refusals_count = 2, .refusals = refusals, .exchanged_count = 4, .exchanged = exchanged,
    .vectors_count = 2, .vectors = vectors, .indicators_count = 1, .indicators = indicators,
    .tangent = tangent,
};
