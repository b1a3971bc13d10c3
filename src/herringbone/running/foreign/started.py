"""Instances of one FMU with start values set, for trials of it alone."""

from collections.abc import Callable, Mapping

from herringbone.core import HerringboneError, ParameterError
from herringbone.core.part import Part


def started(new: Callable[[], Part], values: Mapping[str, str]) -> Callable[[], Part]:
    """Makes instances with start values set.

    Args:
        new: makes an instance.
        values: texts by variable.

    The function raises ParameterError where a value does not fit.
    """

    def make() -> Part:
        part = new()
        try:
            for name, text in values.items():
                number = part.variables[name].is_real if name in part.variables else False
                part.set(name, float(text) if number else text)
        except (ValueError, HerringboneError) as error:
            part.enter_initialization(0.0, 1.0)  # pythonfmu does not survive freeing what was not
            part.close()
            if isinstance(error, ValueError):
                raise ParameterError(f"{name} = {text}: it must be a number") from error
            raise
        return part

    return make
