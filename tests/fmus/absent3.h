/* FMI 3.0 functions of capabilities that a test's FMU has not, but that fmpy wants to find; the last
   lines of its source. `EXPORT`, `Status` and `ERROR` are the source's. */
#define ABSENT(name) \
    EXPORT Status fmi3##name(void) { return ERROR; }
ABSENT(InstantiateModelExchange) ABSENT(InstantiateScheduledExecution) ABSENT(GetClock)
ABSENT(SetClock) ABSENT(GetNumberOfVariableDependencies) ABSENT(GetVariableDependencies)
ABSENT(SerializedFMUStateSize) ABSENT(SerializeFMUState) ABSENT(DeserializeFMUState)
ABSENT(GetDirectionalDerivative) ABSENT(GetAdjointDerivative) ABSENT(GetIntervalDecimal)
ABSENT(GetIntervalFraction) ABSENT(GetShiftDecimal) ABSENT(GetShiftFraction)
ABSENT(SetIntervalDecimal) ABSENT(SetIntervalFraction) ABSENT(SetShiftDecimal)
ABSENT(SetShiftFraction) ABSENT(EvaluateDiscreteStates) ABSENT(EnterContinuousTimeMode)
ABSENT(CompletedIntegratorStep) ABSENT(SetTime) ABSENT(SetContinuousStates)
ABSENT(GetContinuousStateDerivatives) ABSENT(GetEventIndicators) ABSENT(GetContinuousStates)
ABSENT(GetNominalsOfContinuousStates) ABSENT(GetNumberOfEventIndicators)
ABSENT(GetNumberOfContinuousStates) ABSENT(ActivateModelPartition) ABSENT(Reset)
ABSENT(GetOutputDerivatives) ABSENT(SetDebugLogging)
