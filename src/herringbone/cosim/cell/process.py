"""A cell, as its master sees it."""

import atexit
import contextlib
import ctypes
import itertools
import os
import signal
import subprocess
import sys
import weakref
from pathlib import Path
from typing import Any

from herringbone.core import FmuError, HerringboneError, errors
from herringbone.core.places.paths import module_path
from herringbone.core.wording import option
from herringbone.cosim.cell.block import (
    ALIVE,
    CONTROL,
    INSTANCES,
    LATE,
    MORE,
    places,
)
from herringbone.cosim.cell.calls import messages
from herringbone.cosim.cell.ending import end_group, ends_within, is_child
from herringbone.cosim.cell.inside.code import code_file
from herringbone.cosim.cell.log import OutputLog
from herringbone.cosim.cell.policy import policy, spin_time
from herringbone.cosim.cell.sides import Side
from herringbone.cosim.cell.wire import packed, unpacked

_SLEEP = 0.02
"""Time after which the death of a cell is noticed [s]."""
_START = 120.0
"""Time in which a cell starts, on a machine with much else to do [s]."""
_END = 2.0
_POLLIN = 1 << 32
_CALLS = (
    "", "set", "get", "doStep", "getFMUState", "setFMUState", "freeFMUState",
    "setInputDerivatives", "getOutputDerivatives",
)  # fmt: skip
_POINTER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)
_numbers = itertools.count(1)
_open: weakref.WeakSet["Cell"] = weakref.WeakSet()


class CellLost(FmuError):
    """A cell ended, or had to be ended."""


class Cell:
    """A child process, started for one FMU.

    Args:
        name: of the FMU, for messages.
        content: of it, that tells it from others.
        folder: that it removes if its master is killed; those of its instances are added.
        words: that the operations of the compiled loop need at most.

    Attributes:
        once: its FMU allows one instance per process, so that it is not used again.
        uses: how often it was given back.

    Raises:
        FmuError: it does not start.
    """

    once = False
    uses = 0

    def __init__(self, name: str, content: str, words: int, folder: Path) -> None:
        self.name, self.content = name, content
        code = code_file()
        layout = places(words)
        block = os.memfd_create("herringbone-cell")
        try:
            os.ftruncate(block, layout.size)
            self.side = Side(block, layout, words, _SLEEP)
            self._process = _start(block, words, code, folder)
        finally:
            os.close(block)
        self._watched = os.pidfd_open(self._process.pid)
        self.side.poll[0] = self._watched | _POLLIN
        assert self._process.stdout is not None
        log = f"{name}-{os.getpid()}-{next(_numbers)}.log".replace("/", "_")
        self.log = OutputLog(self._process.stdout, log)
        self._converse = _POINTER(messages.converse.address)
        self._land = _POINTER(messages.land_any.address)
        self._call, self._why = "start", ""
        self._free = list(range(INSTANCES))
        _open.add(self)
        _share_cores()
        self.deadline = _START
        self._deadline(_START)
        try:
            self.ask("start", -1)
        except HerringboneError as error:
            self.close()
            raise FmuError(f"{error} {self.log.described()}".strip()) from error
        self.deadline = policy().deadline
        self._deadline(self.deadline)

    def _deadline(self, seconds: float) -> None:
        self.side.record["deadline"] = int(1e9 * min(seconds, 1e9))

    @property
    def lost(self) -> bool:
        """True if there is no conversation any more."""
        return bool(self.side.record["lost"][0] != ALIVE)

    @property
    def has_instances(self) -> bool:
        """True if it has anything to do."""
        return len(self._free) < INSTANCES

    def new_instance(self) -> int:
        """Number of a new instance; raises FmuError."""
        if not self._free:
            raise FmuError(f"{self.name}: more than {INSTANCES} instances at the same time")
        number = self._free.pop()
        _share_cores()
        return number

    def forget(self, number: int, memory: int) -> None:
        """An instance is closed, whose memory is at this address."""
        self._free.append(number)
        _share_cores()
        if self.side.record["flying"][0] == memory:
            self.side.record["flying"] = 0

    def ask(self, call: str, number: int, *arguments: object) -> Any:  # noqa: ANN401 (of any call)
        """Call a function of the cell.

        Raises:
            CellLost: the cell ended, or did not answer in time.
            HerringboneError: what the function raised.
        """
        self._land(self.side.address)
        self._call = call
        content = packed({"call": call, "instance": number, "arguments": list(arguments)})
        while content:
            content = self.side.write(content)
            self._exchange(CONTROL)
        reply, more = self.side.read()
        while more:
            self._exchange(MORE)
            piece, more = self.side.read()
            reply += piece
        self._call = ""
        found = unpacked(reply)
        if "error" in found:
            kind = getattr(errors, found["kind"], FmuError)
            raise (kind if issubclass(kind, HerringboneError) else FmuError)(found["error"])
        return found["value"]

    def _exchange(self, kind: int) -> None:
        if not self.lost:
            self.side.header["kind"] = kind
            self._converse(self.side.address)
        if self.lost:
            raise CellLost(f"{self.name}: {self.why}")

    @property
    def why(self) -> str:
        """Why it is lost: call, time and signal."""
        if not self._why:
            self._why = self._diagnosed()
        return self._why

    def _diagnosed(self) -> str:
        late = self.side.record["lost"][0] == LATE
        if is_child(self._process) and (late or ends_within(self._watched, _END)):
            end_group(self._process)
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_END)
        call = self._call or _CALLS[int(self.side.header["where"][0]) % len(_CALLS)]
        where = f"in {_NAMES.get(call, call)}" if call else "between two calls"
        time = float(self.side.header["time"][0])
        at = f"{where} at {time:g} s"
        if late:
            return f"no answer {at} within {self.deadline:g} s; its process was ended"
        code = self._process.returncode
        if code is None:
            return f"its process cannot be waited for, {at}"
        if code < 0:
            return f"signal {-code} ({_signal(-code)}) {at} ended its process"
        return f"it ended its process {at} with exit code {code}"

    def close(self) -> None:
        """End the process, and what its FMU has started."""
        _open.discard(self)
        _share_cores()
        if is_child(self._process) and not self.lost:
            with contextlib.suppress(HerringboneError):
                self._quit()
        end_group(self._process)
        self._process.wait()
        self.log.close()
        with contextlib.suppress(OSError):
            os.close(self._watched)
        self._watched = -1

    def _quit(self) -> None:
        """The cell ends without an answer."""
        self._deadline(_END)
        self._land(self.side.address)
        self.side.write(packed({"call": "quit", "instance": -1, "arguments": []}))
        self.side.header["kind"] = CONTROL
        self._converse(self.side.address)
        ends_within(self._watched, _END)


_NAMES = {
    "open": "instantiate",
    "apply": "trials",
    "enter_initialization": "initialise",
    "exit_initialization": "initialise",
    "end": "terminate or freeInstance",
    "put_values": "set",
    "get_values": "get",
}
"""Calls by the words of FMI."""


def _signal(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return "unknown"


def _start(block: int, words: int, code: Path, folder: Path) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-P", "-m", "herringbone.cosim.cell.inside.child"]
    try:
        return subprocess.Popen(
            [*command, str(block), str(words), str(os.getpid()), str(code), str(folder)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            pass_fds=(block,),
            process_group=0,  # Ctrl-C is for the master
            env={**os.environ, "PYTHONPATH": module_path()},
        )
    except OSError as error:
        use = option("in_process", True)
        raise FmuError(f"no cell for a foreign FMU starts ({error}); use {use}") from error


def _share_cores() -> None:
    """Spin only as long as there is a core for each."""
    busy = [cell for cell in _open if cell.has_instances]
    for cell in busy:
        cell.side.spin(spin_time(len(busy)))


@atexit.register
def _end_all() -> None:
    """No cell outlives its master, whatever was not closed."""
    for cell in list(_open):
        with contextlib.suppress(OSError):
            cell.close()
