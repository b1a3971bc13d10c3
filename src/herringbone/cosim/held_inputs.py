"""What it costs that a part without signal nodes has its inputs held over a step."""

from collections.abc import Sequence

from herringbone.core.part import Part


def order_of_held(part: Part, inputs: Sequence[str], outputs: Sequence[str]) -> str:
    """Order with a part whose inputs are held: what a mean passes directly is half a step late.

    An element takes the value at the end.

    Args:
        part: whose inputs are held.
        inputs, outputs: names of those that are coupled.
    """
    second, first = "second order in the step", "first order in the step"
    if part.has_states is False:
        return second
    passed = [part.variables[name].dependencies for name in outputs]
    if not all(depends is None or depends.isdisjoint(inputs) for depends in passed):
        direct = "as inputs pass directly to outputs"
        if part.has_states:
            return f"{first}, {direct}"
        return f"{second}, or first order if it has states, {direct}"
    if None in passed:
        return (
            f"{second}, or first order if it has states and passes inputs directly to its outputs"
        )
    return second
