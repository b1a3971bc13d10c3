"""The FMI functions of a library, as fmpy calls them.

fmpy looks up its own signatures for each instance anew, which takes longer than all the rest of
making one. They are the same for all instances of an FMI version: the first one's are kept.
"""

from typing import Any, ClassVar

_DECLARED = "argnames", "argtypes", "restype"


class KnownFunctions:
    """To derive from before a class of fmpy's: functions are declared as the first ones were."""

    _declared: ClassVar[dict[str, dict[str, Any]]]
    dll: Any
    _functions: dict[str, Any]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls._declared = {}

    def _loadFunctions(self) -> None:
        if not self._declared:
            super()._loadFunctions()  # type: ignore[misc]  # fmpy's
            self._declared.update(
                (name, {what: getattr(function, what) for what in _DECLARED})
                for name, function in self._functions.items()
            )
            return
        for name, declared in self._declared.items():
            function = self._functions[name] = getattr(self.dll, name)
            for what, value in declared.items():
                setattr(function, what, value)
