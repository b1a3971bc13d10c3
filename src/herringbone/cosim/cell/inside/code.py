"""Machine code for cells, made once by numba: a cell that loads it starts without numba.

It has the cell's side of the messages, and the adapters of FMUs 3.0.
"""

from pathlib import Path

import llvmlite.binding as llvm
from llvmlite import ir
from numba.core.ccallback import CFunc

from herringbone.core import FmuError
from herringbone.core.caching.files import is_stored, store
from herringbone.core.caching.keys import kernels_key
from herringbone.core.places.paths import cache_folder
from herringbone.core.process.activity import activity
from herringbone.core.wording import option
from herringbone.cosim.cell.inside import serving
from herringbone.cosim.fmu.fmi3 import calls, within
from herringbone.cosim.fmu.fmi3.adapters import adapters
from herringbone.kernels.compiling.jit import c_code

_OPTIMISATION = 3
_PASSES = 2
"""The second one drops what the first one has shown to be unreachable: all of Python."""
_REFERENCES = {"NRT_incref", "NRT_decref"}
_ANY_NAME = "k"  # LLVM appends a number


def code_file() -> Path:
    """Object file with the functions, from the cache if it is there; raises FmuError."""
    key = kernels_key(serving.__name__, calls.__name__, within.__name__, __name__)
    file = cache_folder("cells") / f"{key}-{llvm.get_process_triple()}.o"
    if not is_stored(file):
        with activity("compiling what runs in cells", "only when its code has changed"):
            store(file, _object_code())
    return file


def _functions() -> dict[str, CFunc]:
    return {"serve": serving.serve, "answer": serving.answer, **adapters()}


def _object_code() -> bytes:
    """Object code of all functions; raises FmuError if they need more than themselves."""
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple().create_target_machine(
        opt=_OPTIMISATION, reloc="default", codemodel="jitdefault", jit=True
    )
    whole = None
    for symbol, function in _functions().items():
        compiled = c_code(function._sig, function._pyfunc)
        module = compiled.code.clone()
        entry = module.get_function(compiled.native_name)
        entry.name, entry.linkage = symbol, "external"
        for item in (*module.functions, *module.global_variables):
            if not item.is_declaration and item.name != symbol:
                item.linkage, item.name = "internal", _ANY_NAME
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    assert whole is not None
    _count_no_references(whole)
    for _ in range(_PASSES):
        options = llvm.create_pipeline_tuning_options(speed_level=_OPTIMISATION)
        builder = llvm.create_pass_builder(target, options)
        builder.getModulePassManager().run(whole, builder)
    needed = [f.name for f in whole.functions if f.is_declaration and not _of_llvm(f.name)]
    if needed:
        use = option("in_process", True)
        raise FmuError(f"the code of cells needs {', '.join(needed)}; use {use}")
    return target.emit_object(whole)


def _count_no_references(module: llvm.ModuleRef) -> None:
    """Let numba's functions that count references do nothing: no array here owns its memory."""
    found = [f.name for f in module.functions if f.is_declaration and f.name in _REFERENCES]
    empty = ir.Module()
    for name in found:
        kind = ir.FunctionType(ir.VoidType(), [ir.IntType(8).as_pointer()])
        ir.IRBuilder(ir.Function(empty, kind, name).append_basic_block()).ret_void()
    module.link_in(llvm.parse_assembly(str(empty)))
    for name in found:
        module.get_function(name).linkage = "internal"


def _of_llvm(name: str) -> bool:
    return name.startswith("llvm.")
