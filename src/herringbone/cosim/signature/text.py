"""A signature in lines for people."""

from collections.abc import Iterator

import numpy as np

from herringbone.cosim.signature.signature import Answer, Kind, Rate, Signature

_MOST = 12
"""Entries of the feedthrough that are shown."""
_RESTORES = {
    True: "it saves and restores its state",
    False: "its saved state is not to be trusted",
    None: "it does not save its state",
}
_HOLDS = {Answer.NO: "does not hold", Answer.UNKNOWN: "is not clear"}


def described(signature: Signature) -> list[str]:
    """What a part is in the coupling, line by line."""
    lines = [f"by trial steps of {1e6 * signature.step:g} us: {_kind(signature)}"]
    lines.append(_restoring(signature))
    passed = list(_passed(signature))
    lines += passed[:_MOST]
    if len(passed) > _MOST:
        lines.append(f"and {len(passed) - _MOST} more of these")
    return [*lines, *_rates(signature), *signature.notes]


def _restoring(signature: Signature) -> str:
    if not signature.repeats:
        return "no step can be repeated"
    if signature.restores is None and signature.kind is Kind.UNKNOWN:
        return "whether it saves its state is not known"
    return _RESTORES[signature.restores]


def _rates(signature: Signature) -> Iterator[str]:
    """Those that do not hold, one by one; of the others how many there are."""
    right = [rate for rate in signature.rates if rate.holds is Answer.YES]
    if len(right) == 1:
        yield f"{right[0].rate} = d({right[0].of})/dt holds"
    elif right:
        yield f"{right[0].rate} = d({right[0].of})/dt holds, as {len(right) - 1} other rates do"
    for rate in signature.rates:
        if rate.holds is not Answer.YES:
            yield f"{rate.rate} = d({rate.of})/dt {_HOLDS[rate.holds]}{_off(rate)}"


def _off(rate: Rate) -> str:
    if not rate.ratio:
        return ""
    return f": it is {1.0 / rate.ratio:.4g} times that"


def _kind(signature: Signature) -> str:
    inner = signature.inner_tick or (signature.tick if signature.kind is not Kind.SAMPLED else 0.0)
    if inner:
        return f"{signature.kind}, in inner steps of {inner:.3g} s"
    return str(signature.kind)


def _passed(signature: Signature) -> Iterator[str]:
    for row, column in np.argwhere(np.nan_to_num(signature.feedthrough) != 0.0):
        value = signature.feedthrough[row, column]
        yield f"d({signature.outputs[row]})/d({signature.inputs[column]}) = {value:.6g}"
