"""What runs in a cell: `python -m ...cell.inside.child BLOCK WORDS MASTER CODE FOLDER`."""

import ctypes
import os
import resource
import shutil
import signal
import sys
import tempfile
import threading
import time
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from fmpy.model_description import ModelDescription

from herringbone.core import FmuError, HerringboneError
from herringbone.cosim.cell.block import FUNCTIONS, INSTANCES, SERVER, STATES, places
from herringbone.cosim.cell.inside.loading import Code, loaded
from herringbone.cosim.cell.inside.surroundings import surroundings
from herringbone.cosim.cell.sides import Side
from herringbone.cosim.cell.wire import packed, unpacked
from herringbone.cosim.fmu.file import read_fmu
from herringbone.cosim.fmu.float_modes import leave_modes
from herringbone.cosim.fmu.fmi3.adapters import ADAPTERS, use_adapters
from herringbone.cosim.fmu.instance import new_part
from herringbone.cosim.fmu.part import FmuPart
from herringbone.cosim.fmu.variables import changes

_SLEEP = 1.0
_LOOK = 0.25
"""Seconds between looks at whether the master lives."""
_STACK = 1 << 28
"""Bytes of stack where the surroundings set no limit."""
_KNOWN = set(FUNCTIONS.names or ())
_SIMPLE = {
    "set", "get", "put_values", "get_values", "enter_initialization", "exit_initialization",
    "ended", "messages", "failed",
}  # fmt: skip
_POINTER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


class Server:
    """The instances of a cell, and the conversation with the master.

    Args:
        block: file descriptor of the shared memory.
        capacity: words of operations that fit into it.
        master: number of the master's process.
        code: compiled functions.
    """

    def __init__(self, block: int, capacity: int, master: int, code: Code) -> None:
        self._side = Side(block, places(capacity), capacity, _SLEEP)
        self._side.record["parent"] = master
        self._functions = np.zeros(INSTANCES, FUNCTIONS)
        self._references = np.zeros(capacity, np.uint32)
        self._orders = np.zeros(capacity, np.int32)
        self._server = np.zeros(1, SERVER)
        self._server["side"] = self._side.address
        self._server["instances"] = self._functions.ctypes.data
        self._server["references"] = self._references.ctypes.data
        self._server["orders"] = self._orders.ctypes.data
        self._parts: dict[int, FmuPart] = {}
        self._states: dict[int, np.ndarray] = {}
        self._model: ModelDescription | None = None
        self._first: FmuPart | None = None
        self._folder = Path()
        self._libraries: list[ctypes.CDLL] = []
        self._before: dict[str, object] = {}
        self._serve, self._answer = (_POINTER(code.address(n)) for n in ("serve", "answer"))
        self.folders: set[str] = set()

    def _start(self, _: int) -> None:
        """It is there."""

    def converse(self) -> None:
        """Answer until the master is gone, or wants no more."""
        while self._serve(self._server.ctypes.data) == 0:
            message = self._received()
            if message is None:
                return
            self._send(self._reply(message))

    def remove_folders(self) -> None:
        """What a killed master leaves."""
        for folder in self.folders:
            shutil.rmtree(folder, ignore_errors=True)

    def _received(self) -> dict[str, Any] | None:
        """The whole message; None: the last one."""
        content, more = self._side.read()
        while more:
            self._answer(self._server.ctypes.data)
            if self._serve(self._server.ctypes.data):
                return None
            piece, more = self._side.read()
            content += piece
        message = unpacked(content)
        return None if message["call"] == "quit" else message

    def _send(self, reply: dict[str, object]) -> None:
        rest = self._side.write(packed(reply))
        self._answer(self._server.ctypes.data)
        while rest:
            if self._serve(self._server.ctypes.data):
                return
            rest = self._side.write(rest)
            self._answer(self._server.ctypes.data)

    def _reply(self, message: dict[str, Any]) -> dict[str, object]:
        call, number = message["call"], message["instance"]
        try:
            if call in _SIMPLE:
                found = getattr(self._parts[number], call)(*message["arguments"])
                if call == "set":  # sizes of arrays may have moved the memory
                    self._connect(number)
            else:
                found = getattr(self, f"_{call}")(number, *message["arguments"])
        except HerringboneError as error:
            return {"error": str(error), "kind": type(error).__name__}
        except Exception as error:  # whatever an FMU's code does to Python
            return {"error": f"{type(error).__name__}: {error}", "kind": FmuError.__name__}
        return {"value": found}

    def _open(self, number: int, name: str, file: str, folder: str) -> list[bool]:
        """Instantiate; which of the part's functions there are."""
        self.folders.add(folder)
        self._before = self._before or surroundings()
        part = self._new_part(name, Path(file), Path(folder))
        self._parts[number] = part
        self._states[number] = np.zeros(STATES, np.int64)
        self._functions[number]["states"] = self._states[number].ctypes.data
        return self._connect(number)

    def _new_part(self, name: str, file: Path, folder: Path) -> FmuPart:
        """An instance of the cell's one FMU; there may be hundreds, so what they share is kept."""
        if self._model is None or changes(self._model):
            self._model, self._first = read_fmu(file), None
        alike = self._first if self._first and self._folder == folder else None
        part = new_part(name, file, folder, self._model, alike)
        if alike is None:  # its library stays loaded, see `_free`
            self._first, self._folder = part, folder
        return part

    def _connect(self, number: int) -> list[bool]:
        at = self._parts[number].addresses
        for function, address in at._asdict().items():
            if function in _KNOWN:
                self._functions[number][function] = address
        return [bool(address) for address in at]

    def _initialise(self, number: int, *experiment: float) -> None:
        """Enter initialisation mode and leave it."""
        self._parts[number].enter_initialization(*experiment)
        self._parts[number].exit_initialization()

    def _terminate(self, number: int) -> None:
        self._parts[number].terminate()

    def _free(self, number: int) -> None:
        """Free the instance; its library stays, because a thread of it may run on in its code."""
        self._libraries.append(ctypes.CDLL(self._parts[number].slave.dll._name))
        self._parts[number].free()
        del self._parts[number]

    def _end(self, number: int) -> None:
        """Terminate and free the instance."""
        self._terminate(number)
        self._free(number)

    def _apply(self, _: int, module: str, function: str, file: str, folder: str) -> object:
        """What a function finds about an FMU; it has a folder for temporary files."""
        self.folders.add(folder)
        tempfile.tempdir = folder
        return getattr(import_module(module), function)(Path(file))

    def _changed(self, _: int) -> list[str]:
        """What FMUs changed of the process and did not put back."""
        ctypes.CDLL(None).fflush(None)
        now = surroundings()
        return [what for what, before in self._before.items() if now[what] != before]


def watch(master: int, server: Server) -> None:
    """End this process when the master has ended, and remove what it left."""
    while os.getppid() == master:
        time.sleep(_LOOK)
    server.remove_folders()
    os._exit(1)


def limit_stack() -> None:
    """Endless recursion shall be a signal; without a limit it fills the machine's memory first."""
    soft, hard = resource.getrlimit(resource.RLIMIT_STACK)
    if soft == resource.RLIM_INFINITY:
        resource.setrlimit(resource.RLIMIT_STACK, (_STACK, hard))


def main(block: int, capacity: int, master: int, code: Path, folder: str) -> None:
    """Serve one master."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    limit_stack()
    functions = loaded(code)
    leave_modes()
    use_adapters({name: functions.address(name) for name in ADAPTERS})
    server = Server(block, capacity, master, functions)
    server.folders.add(folder)
    os.close(block)
    threading.Thread(target=watch, args=(master, server), daemon=True).start()
    server.converse()
    if os.getppid() != master:
        server.remove_folders()
    os._exit(0)  # nothing of an FMU runs at the end


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:4]]
    main(numbers[0], numbers[1], numbers[2], Path(sys.argv[4]), sys.argv[5])
