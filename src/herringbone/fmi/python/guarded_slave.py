"""pythonfmu's slave, made safe: errors are logged, remembered, and never crash the host.

What pythonfmu 0.7 dictates:

- An exception in any call is fatal, without a traceback, and each one drops a reference too many to
  the instance, which the third `doStep` does not survive. Errors are therefore logged and
  remembered, and the next `doStep` is discarded. Only leaving initialisation and restoring a state
  raise, because their callers must not go on; the references are then made up for.
- Log messages and the text of exceptions are printf formats: percent signs are doubled.
- A variable of an unknown value reference is an exception; here it is an error like others.
"""

import ctypes
import math
import traceback
from collections.abc import Callable, Iterable

from pythonfmu import Fmi2Slave
from pythonfmu.enums import Fmi2Status

from herringbone.core import FmuError, HerringboneError


class GuardedSlave(Fmi2Slave):
    """A slave whose errors become one message and a discarded step."""

    def __init__(self, **kwargs: object) -> None:
        super().__init__(**kwargs)
        self._failure = ""
        self._time = 0.0

    def _say(self, message: str, status: Fmi2Status) -> None:
        self.log(message.replace("%", "%%"), status)

    def _fail(self, message: str) -> None:
        """Log an error with its time, and remember the first one."""
        message = f"{message} (t = {self._time:g} s)"
        self._failure = self._failure or message
        self._say(message, Fmi2Status.error)

    def _attempt(self, action: Callable[..., None], *args: object) -> None:
        """Call; an exception becomes an error."""
        try:
            action(*args)
        except HerringboneError as error:
            self._fail(str(error))
        except Exception:
            self._fail(f"{self.instance_name}: {traceback.format_exc()}")

    def _raise(self) -> None:
        """Make the present call fatal; pythonfmu drops one reference to each of three objects.

        Raises:
            FmuError: always, with the first error's message.
        """
        for dropped in (self, type(self), self.log_queue):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(dropped))
        raise FmuError(self._failure.replace("%", "%%"))

    def _unknown(self, kind: str, vrs: Iterable[int], known: Iterable[int] = ()) -> None:
        bad = ", ".join(str(vr) for vr in vrs if vr not in known)
        self._fail(f"{self.instance_name}: there is no {kind} with value reference {bad}")

    def get_real(self, vrs: list[int]) -> list[float]:
        """NaN: there are no such variables."""
        self._unknown("Real", vrs)
        return [math.nan] * len(vrs)

    def get_integer(self, vrs: list[int]) -> list[int]:
        """0: there are no such variables."""
        self._unknown("Integer", vrs)
        return [0] * len(vrs)

    def get_boolean(self, vrs: list[int]) -> list[bool]:
        """False: there are no such variables."""
        self._unknown("Boolean", vrs)
        return [False] * len(vrs)

    def get_string(self, vrs: list[int]) -> list[str]:
        """Empty: there are no such variables."""
        self._unknown("String", vrs)
        return [""] * len(vrs)

    def set_integer(self, vrs: list[int], values: list[int]) -> None:
        """An error: there are no such variables."""
        del values
        self._unknown("Integer", vrs)

    def set_boolean(self, vrs: list[int], values: list[bool]) -> None:
        """An error: there are no such variables."""
        del values
        self._unknown("Boolean", vrs)
