/* FMI 2.0 functions of capabilities that a test's FMU has not; the last lines of its source.
   `EXPORT`, `Status` and `ERROR` are the source's. */
#define ABSENT(name) \
    EXPORT Status fmi2##name(void) { return ERROR; }
ABSENT(GetInteger) ABSENT(GetBoolean) ABSENT(GetString)
ABSENT(SetInteger) ABSENT(SetBoolean) ABSENT(SetString)
#ifndef WITH_STATES
ABSENT(GetFMUstate) ABSENT(SetFMUstate) ABSENT(FreeFMUstate)
#endif
ABSENT(SerializedFMUstateSize) ABSENT(SerializeFMUstate) ABSENT(DeSerializeFMUstate)
ABSENT(GetDirectionalDerivative) ABSENT(SetRealInputDerivatives) ABSENT(GetRealOutputDerivatives)
ABSENT(CancelStep) ABSENT(GetStatus) ABSENT(GetRealStatus) ABSENT(GetIntegerStatus)
ABSENT(GetBooleanStatus) ABSENT(GetStringStatus)
