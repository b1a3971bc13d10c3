/* FMI 3.0: what these FMUs do not have. Every call with an instance gets an error and a message. */
#include "fmi3Functions.h"

#include "instance.h"

static fmi3Status refuse(Instance *instance, const char *what) {
    if (!instance)
        return fmi3Error;
    return (fmi3Status)instance_fail(instance, STATUS_ERROR, "%s: this FMU has no %s",
                                     instance->name, what);
}

/* There are no variables of the type; to get or set none of them is fine. */
static fmi3Status none(Instance *instance, const char *type, const fmi3ValueReference vr[],
                       size_t n) {
    return !instance ? fmi3Error
           : n       ? (fmi3Status)instance_unknown(instance, type, vr, n)
                     : fmi3OK;
}

#define NO_VARIABLES(Type)                                                                    \
    fmi3Status fmi3Get##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n,         \
                             fmi3##Type v[], size_t count) {                                  \
        (void)v, (void)count;                                                                 \
        return none(c, #Type, vr, n);                                                         \
    }                                                                                         \
    fmi3Status fmi3Set##Type(fmi3Instance c, const fmi3ValueReference vr[], size_t n,         \
                             const fmi3##Type v[], size_t count) {                            \
        (void)v, (void)count;                                                                 \
        return none(c, #Type, vr, n);                                                         \
    }

NO_VARIABLES(Float32)
NO_VARIABLES(Int8)
NO_VARIABLES(UInt8)
NO_VARIABLES(Int16)
NO_VARIABLES(UInt16)
NO_VARIABLES(Int32)
NO_VARIABLES(UInt32)
NO_VARIABLES(UInt64)
NO_VARIABLES(Boolean)

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n, size_t sizes[],
                         fmi3Binary v[], size_t count) {
    (void)sizes, (void)v, (void)count;
    return none(c, "Binary", vr, n);
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                         const size_t sizes[], const fmi3Binary v[], size_t count) {
    (void)sizes, (void)v, (void)count;
    return none(c, "Binary", vr, n);
}

fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n, fmi3Clock v[]) {
    (void)v;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                        const fmi3Clock v[]) {
    (void)v;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                  fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[]) {
    (void)intervals, (void)qualifiers;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                   fmi3UInt64 counters[], fmi3UInt64 resolutions[],
                                   fmi3IntervalQualifier qualifiers[]) {
    (void)counters, (void)resolutions, (void)qualifiers;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                               fmi3Float64 shifts[]) {
    (void)shifts;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                fmi3UInt64 counters[], fmi3UInt64 resolutions[]) {
    (void)counters, (void)resolutions;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                  const fmi3Float64 intervals[]) {
    (void)intervals;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                   const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    (void)counters, (void)resolutions;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                               const fmi3Float64 shifts[]) {
    (void)shifts;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                const fmi3UInt64 counters[], const fmi3UInt64 resolutions[]) {
    (void)counters, (void)resolutions;
    return none(c, "Clock", vr, n);
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference clock, fmi3Float64 time) {
    (void)clock, (void)time;
    return refuse(c, "model partitions");
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference unknowns[],
                                    size_t unknown_count, const fmi3ValueReference knowns[],
                                    size_t known_count, const fmi3Float64 seed[],
                                    size_t seed_count, fmi3Float64 sensitivity[],
                                    size_t sensitivity_count) {
    (void)unknowns, (void)unknown_count, (void)knowns, (void)known_count, (void)seed,
        (void)seed_count, (void)sensitivity, (void)sensitivity_count;
    return refuse(c, "adjoint derivatives");
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance c) {
    return refuse(c, "configuration mode");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance c) {
    return refuse(c, "configuration mode");
}

fmi3Status fmi3EnterStepMode(fmi3Instance c) {
    return refuse(c, "event mode in co-simulation, so that no call leads from it to step mode");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference vr,
                                               size_t *count) {
    (void)vr, (void)count;
    return refuse(c, "variable dependencies at run time; modelDescription.xml gives them");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference dependent,
                                       size_t dependent_elements[],
                                       fmi3ValueReference independents[],
                                       size_t independent_elements[], fmi3DependencyKind kinds[],
                                       size_t count) {
    (void)dependent, (void)dependent_elements, (void)independents, (void)independent_elements,
        (void)kinds, (void)count;
    return refuse(c, "variable dependencies at run time; modelDescription.xml gives them");
}
