"""Loading the machine code of a cell, without numba."""

from pathlib import Path

import llvmlite.binding as llvm

_kept: list[llvm.ExecutionEngine] = []
"""The code lives as long as they do."""


def loaded(file: Path) -> "Code":
    """The functions of an object file; see `code`."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple().create_target_machine(
        codemodel="jitdefault", jit=True
    )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), target)
    engine.add_object_file(llvm.ObjectFileRef.from_data(file.read_bytes()))
    engine.finalize_object()
    _kept.append(engine)
    return Code(engine)


class Code:
    """Functions by their names."""

    def __init__(self, engine: llvm.ExecutionEngine) -> None:
        self._engine = engine

    def address(self, name: str) -> int:
        """C address of a function."""
        return self._engine.get_function_address(name)
