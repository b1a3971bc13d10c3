"""Object code of kernels, without Python, for any platform.

numba writes each kernel behind a C signature as LLVM code, which does not depend on the processor
of this computer; it is optimised for its target with every function but the entry points internal,
once for all systems on one kind of processor.
LLVM then sees that no kernel ever reports an error, and drops all of numba's error path: nothing of
Python remains. That is checked, see `symbols`.

The entry points that a simulation calls all the time are made fast, the others small, as is what
seldom happens.
"""

from collections.abc import Iterable

import llvmlite.binding as llvm

from herringbone.core import Component, StructureError
from herringbone.fmi.native.entry_points import FAST, entry_points
from herringbone.fmi.native.platforms import Platform
from herringbone.fmi.native.wide import with_wide
from herringbone.kernels.compiling.dispatching import CFunction
from herringbone.kernels.compiling.linking import quickly

_OPTIMISATION = 3
_PLAIN = 1
"""Before code is made small: it shows that indices are inside their tuples, so that no kernel
fails. Small code alone does not tell, as it keeps functions apart."""
_PASSES, _MOST = 2, 4
"""The second one drops what the first one has shown to be unreachable; what that shows, a third."""
_ANY_NAME = "k"  # LLVM appends a number
_RAISES = "numba_do_raise"
_OF_THIS_PROCESS = "numba.dynamic.globals"


def _linked(
    kernels: dict[str, CFunction], target: llvm.TargetMachine, triple: str
) -> llvm.ModuleRef:
    """LLVM code of entry points for a target; what they share is there once."""
    whole = None
    for symbol, compiled in kernels.items():
        module = compiled.code.clone()
        module.triple, module.data_layout = triple, str(target.target_data)
        entry = module.get_function(compiled.native_name)
        entry.name, entry.linkage, entry.visibility = symbol, "external", "hidden"
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    _refuse_addresses(whole)
    return whole


def _refuse_addresses(module: llvm.ModuleRef) -> None:
    """Refuse code that reads an array of this process: one with gaps, or of more than 1 MB."""
    if any(v.name.startswith(_OF_THIS_PROCESS) for v in module.global_variables):
        raise StructureError(
            "a kernel uses an array that is not contiguous, whose address would be that of this "
            "process; copy it (numpy.ascontiguousarray) where the kernel is made"
        )


def _internalise(module: llvm.ModuleRef, entries: Iterable[str]) -> None:
    """Let nothing but the entry points be seen from outside.

    Their long names are dropped, as libraries for macOS keep them.
    """
    for item in (*module.functions, *module.global_variables):
        if not item.is_declaration and item.name not in entries:
            item.linkage, item.name = "internal", _ANY_NAME


def _is_rare(function: llvm.ValueRef) -> bool:
    """True if a function stays outside of those that call it."""
    return any(b"cold" in attribute for attribute in function.attributes)


def _may_fail(module: llvm.ModuleRef) -> bool:
    """True if numba's error path is still there."""
    return any(f.is_declaration and f.name == _RAISES for f in module.functions)


def _make_small(functions: Iterable[llvm.ValueRef]) -> None:
    for function in functions:
        if not function.is_declaration:
            function.add_function_attribute("optsize")
            function.add_function_attribute("minsize")


def _optimise(
    module: llvm.ModuleRef, target: llvm.TargetMachine, level: int = _OPTIMISATION, *, fast: bool
) -> None:
    options = llvm.create_pipeline_tuning_options(speed_level=level)
    options.slp_vectorization = options.loop_vectorization = options.loop_unrolling = fast
    builder = llvm.create_pass_builder(target, options)
    builder.getModulePassManager().run(module, builder)


def _target(platform: Platform) -> llvm.TargetMachine:
    return llvm.Target.from_triple(platform.triple).create_target_machine(
        cpu=platform.cpu, features="", opt=_OPTIMISATION, reloc="pic", codemodel="default"
    )


def _optimised(kernels: dict[str, CFunction], platform: Platform, *, fast: bool) -> llvm.ModuleRef:
    """LLVM code of entry points for a platform."""
    target = _target(platform)
    module = _linked(kernels, target, platform.triple)
    if fast and platform.chooses_vectors:
        module = with_wide(module)
    _internalise(module, kernels)
    module.verify()
    if not fast:
        _optimise(module, target, _PLAIN, fast=False)
    _make_small(f for f in module.functions if not fast or _is_rare(f))
    for done in range(_MOST):
        if done >= _PASSES and not _may_fail(module):
            break
        _optimise(module, target, fast=fast)
    return module


def _whole(kernels: dict[str, CFunction], platform: Platform) -> llvm.ModuleRef:
    """LLVM code of all entry points, optimised for a platform."""
    fast = {symbol: compiled for symbol, compiled in kernels.items() if symbol in FAST}
    small = {symbol: compiled for symbol, compiled in kernels.items() if symbol not in FAST}
    whole = _optimised(fast, platform, fast=True)
    whole.link_in(_optimised(small, platform, fast=False))
    return whole


def _machine_code(whole: llvm.ModuleRef, platform: Platform) -> bytes:
    """Object code for a platform, of code that was optimised for its kind of processor."""
    target = _target(platform)
    whole.triple, whole.data_layout = platform.triple, str(target.target_data)
    return target.emit_object(whole)


def _of_platforms(
    kernels: dict[str, CFunction], platforms: Iterable[Platform]
) -> dict[Platform, bytes]:
    """Object code of entry points by platform; most of the time goes into what is optimised."""
    of_kinds: dict[Platform, list[Platform]] = {}
    for platform in platforms:
        of_kinds.setdefault(platform.optimised_as, []).append(platform)
    found: dict[Platform, bytes] = {}
    for like, alike in of_kinds.items():
        whole = _whole(kernels, like)  # which becomes another one when machine code is made of it
        codes = {p: whole if p == like else whole.clone() for p in alike}
        found |= {p: _machine_code(code, p) for p, code in codes.items()}
    return found


def object_code(component: Component, platforms: Iterable[Platform]) -> dict[Platform, bytes]:
    """Object code of a component's kernels by platform."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    with quickly():
        kernels = entry_points(component)
    return _of_platforms(kernels, platforms)
