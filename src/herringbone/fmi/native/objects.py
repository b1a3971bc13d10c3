"""Object code of kernels, without Python, for any platform.

numba writes each kernel behind a C signature as LLVM code, which does not depend on the processor
of this computer; it is optimised for its target with every function but the entry points internal,
once for all systems on one kind of processor.
LLVM then sees that no kernel ever reports an error, and drops all of numba's error path: nothing of
Python remains. That is checked, see `symbols`.

The entry points that a simulation calls all the time are made fast, the others small, as is what
seldom happens.
"""

from collections.abc import Callable, Iterable
from typing import Any

import llvmlite.binding as llvm
from numba import carray, types

from herringbone.components.resources.loader import REPORT, ResourceLoader
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Component, StructureError
from herringbone.core.declaring.component import unbounded, unchanged
from herringbone.fmi.native.platforms import Platform
from herringbone.fmi.native.wide import with_wide
from herringbone.kernels.compiling.jit import c_code
from herringbone.kernels.compiling.linking import CFunction, quickly

_OPTIMISATION = 3
_PLAIN = 1
"""Before code is made small: it shows that indices are inside their tuples, so that no kernel
fails. Small code alone does not tell, as it keeps functions apart."""
_PASSES = 2
"""The second one drops what the first one has shown to be unreachable."""
_FAST = {"hb_step", "hb_rhs", "hb_out", "hb_indicators", "hb_answer"}
"""Entry points that a simulation calls all the time; what they call is made for speed."""
_ANY_NAME = "k"  # LLVM appends a number
_OF_THIS_PROCESS = "numba.dynamic.globals"
_UNKNOWN_SIZE = 2**40  # bounds are not checked, but views are cut at the end
_REALS = types.CPointer(types.float64)
_COUNTS = types.CPointer(types.int64)
_REFERENCES = types.CPointer(types.uint32)
_TIME = types.float64


def entry_points(  # noqa: PLR0915 (all have one form)
    of: Component,
) -> dict[str, CFunction]:
    """The kernels of a component behind their C signatures, by symbol.

    The optional ones, `start`, `load` and `indicators`, only if the component has them.
    """
    block, kernels, count = of.declaration.size, of.kernels, of.indicator_count
    work, states = max(of.declaration.work, 1), max(of.declaration.state_count, 1)

    def step(b, w, t, h):  # noqa: ANN001, ANN202 (typed by the signature)
        return types.int32(kernels_step(carray(b, (block,)), carray(w, (work,)), t, h))

    def rhs(b, t, dx):  # noqa: ANN001, ANN202
        kernels_rhs(carray(b, (block,)), t, carray(dx, (states,)))

    def out(b, t):  # noqa: ANN001, ANN202
        kernels_out(carray(b, (block,)), t)

    def longest_step(b):  # noqa: ANN001, ANN202
        return kernels_longest_step(carray(b, (block,)))

    def start(b):  # noqa: ANN001, ANN202
        kernels_start(carray(b, (block,)))

    def load(values, shape, b, s, report):  # noqa: ANN001, ANN202
        return types.int32(
            kernels_load(
                carray(values, (_UNKNOWN_SIZE,)),
                carray(shape, (_UNKNOWN_SIZE,)),
                carray(b, (block,)),
                carray(s, (scratch,)),
                carray(report, (REPORT,)),
            )
        )

    def verify(b, report):  # noqa: ANN001, ANN202
        return types.int32(kernels_check(carray(b, (block,)), carray(report, (REPORT,))))

    def tangent(b, t, d, dx):  # noqa: ANN001, ANN202
        kernels_tangent(carray(b, (block,)), t, carray(d, (block,)), carray(dx, (2 * states,)))

    def indicators(b, t, z):  # noqa: ANN001, ANN202
        kernels_indicators(carray(b, (block,)), t, carray(z, (count,)))

    def settle(b, t):  # noqa: ANN001, ANN202
        return types.int32(kernels_settle(carray(b, (block,)), t))

    def remark(b, w, which, report):  # noqa: ANN001, ANN202
        return types.int32(
            kernels_remark(
                carray(b, (block,)), carray(w, (work,)), which, carray(report, (REPORT,))
            )
        )

    def answer(b, w, t, references, count):  # noqa: ANN001, ANN202
        places = carray(references, (_UNKNOWN_SIZE,))
        kernels_answer(carray(b, (block,)), carray(w, (work,)), t, places, count)

    kernels_step, kernels_rhs, kernels_out = kernels
    if of.asked is not None:
        kernels_step, kernels_answer = of.asked.advance, of.asked.answer
    kernels_start = of.start
    kernels_indicators: Any = of.indicators  # not used if it is None
    kernels_longest_step = of.longest_step
    kernels_tangent = tangent_kernel(of)
    found: dict[str, tuple[object, Callable]] = {
        "hb_step": (types.int32(_REALS, _REALS, _TIME, _TIME), step),
        "hb_rhs": (types.void(_REALS, _TIME, _REALS), rhs),
        "hb_out": (types.void(_REALS, _TIME), out),
        "hb_tangent": (types.void(_REALS, _TIME, _REALS, _REALS), tangent),
    }
    if of.longest_step is not unbounded:
        found["hb_longest_step"] = (_TIME(_REALS), longest_step)
    if of.start is not unchanged:
        found["hb_start"] = (types.void(_REALS), start)
    if isinstance(of.load, ResourceLoader):
        kernels_load, scratch = of.load.kernel, of.load.scratch
        found["hb_load"] = (types.int32(_REALS, _COUNTS, _REALS, _REALS, _REALS), load)
        kernels_check: Any = of.load.check  # not used if it is None
        if kernels_check is not None:
            found["hb_verify"] = (types.int32(_REALS, _REALS), verify)
    if of.hosting is not None:
        kernels_settle = of.hosting.settle
        found["hb_settle"] = (types.int32(_REALS, _TIME), settle)
    if of.by_tolerance is not None:
        kernels_remark = of.by_tolerance.remark
        found["hb_remark"] = (types.int32(_REALS, _REALS, types.int32, _REALS), remark)
    if of.asked is not None:
        signature = types.void(_REALS, _REALS, _TIME, _REFERENCES, types.int64)
        found["hb_answer"] = (signature, answer)
    if of.indicators is not None:
        found["hb_indicators"] = (types.void(_REALS, _TIME, _REALS), indicators)
    return {symbol: c_code(signature, function) for symbol, (signature, function) in found.items()}


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
    for _ in range(_PASSES):
        _optimise(module, target, fast=fast)
    return module


def _whole(kernels: dict[str, CFunction], platform: Platform) -> llvm.ModuleRef:
    """LLVM code of all entry points, optimised for a platform."""
    fast = {symbol: compiled for symbol, compiled in kernels.items() if symbol in _FAST}
    small = {symbol: compiled for symbol, compiled in kernels.items() if symbol not in _FAST}
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
