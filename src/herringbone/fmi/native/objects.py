"""Object code of kernels: `python -m ...native.objects KIND FOLDER PLATFORMS FACTORY ...`.

numba compiles each kernel behind a C signature; its LLVM code is taken, given another target, and
optimised with every function but the entry points internal. LLVM then sees that no kernel ever
reports an error, and drops all of numba's error path: nothing of Python remains. That is checked,
see `symbols`.

It runs in processes of their own, because numba must be asked for a generic processor before it is
imported, and before that how hard it shall optimise: first with KIND `fast`, for the entry points
that a simulation calls all the time, then with `small` for the others; see `build`.
"""

import re
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import llvmlite.binding as llvm
from numba import carray, cfunc, types
from numba.core.ccallback import CFunc

from herringbone.components.resources.loader import REPORT, ResourceLoader
from herringbone.components.tangent import tangent_kernel
from herringbone.core import Component
from herringbone.core.component import unbounded, unchanged
from herringbone.fmi.native.model import made_component
from herringbone.fmi.native.platforms import Platform, platform_of

_TARGET_LINES = re.compile(r"^target (triple|datalayout) = .*$", re.MULTILINE)
_OPTIMISATION = 3
_PASSES = 2
"""The second one drops what the first one has shown to be unreachable."""
_FAST = {"hb_step", "hb_rhs", "hb_out", "hb_indicators"}
"""Entry points that a simulation calls all the time; what they call is made for speed."""
_ANY_NAME = "k"  # LLVM appends a number
_UNKNOWN_SIZE = 2**40  # bounds are not checked, but views are cut at the end
_REALS = types.CPointer(types.float64)
_COUNTS = types.CPointer(types.int64)
_TIME = types.float64


def entry_points(of: Component, *, fast: bool) -> dict[str, CFunc]:
    """The fast or the other kernels of a component behind their C signatures, by symbol.

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

    def tangent(b, t, d, dx):  # noqa: ANN001, ANN202
        kernels_tangent(carray(b, (block,)), t, carray(d, (block,)), carray(dx, (2 * states,)))

    def indicators(b, t, z):  # noqa: ANN001, ANN202
        kernels_indicators(carray(b, (block,)), t, carray(z, (count,)))

    kernels_step, kernels_rhs, kernels_out = kernels
    kernels_start, kernels_indicators = of.start, of.indicators
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
    if of.indicators is not None:
        found["hb_indicators"] = (types.void(_REALS, _TIME, _REALS), indicators)
    return {
        symbol: cfunc(signature, error_model="numpy")(function)
        for symbol, (signature, function) in found.items()
        if (symbol in _FAST) == fast
    }


def _linked(kernels: dict[str, CFunc], target: llvm.TargetMachine, triple: str) -> llvm.ModuleRef:
    """LLVM code of entry points for a target; what they share is there once."""
    whole = None
    for symbol, compiled in kernels.items():
        module = llvm.parse_assembly(_TARGET_LINES.sub("", compiled.inspect_llvm()))
        module.triple, module.data_layout = triple, str(target.target_data)
        entry = module.get_function(compiled.native_name)
        entry.name, entry.linkage, entry.visibility = symbol, "external", "hidden"
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    return whole


def _internalise(module: llvm.ModuleRef, entries: Iterable[str]) -> None:
    """Let nothing but the entry points be seen from outside.

    Their long names are dropped, as libraries for macOS keep them.
    """
    for item in (*module.functions, *module.global_variables):
        if not item.is_declaration and item.name not in entries:
            item.linkage, item.name = "internal", _ANY_NAME


def _make_small(module: llvm.ModuleRef) -> None:
    for function in module.functions:
        if not function.is_declaration:
            function.add_function_attribute("optsize")
            function.add_function_attribute("minsize")


def _optimise(module: llvm.ModuleRef, target: llvm.TargetMachine, *, fast: bool) -> None:
    options = llvm.create_pipeline_tuning_options(speed_level=_OPTIMISATION)
    options.slp_vectorization = options.loop_vectorization = options.loop_unrolling = fast
    builder = llvm.create_pass_builder(target, options)
    for _ in range(_PASSES):
        builder.getModulePassManager().run(module, builder)


def _target(platform: Platform) -> llvm.TargetMachine:
    return llvm.Target.from_triple(platform.triple).create_target_machine(
        cpu=platform.cpu, features="", opt=_OPTIMISATION, reloc="pic", codemodel="default"
    )


def _optimised(kernels: dict[str, CFunc], platform: Platform, *, fast: bool) -> llvm.ModuleRef:
    """LLVM code of entry points for a platform."""
    target = _target(platform)
    module = _linked(kernels, target, platform.triple)
    _internalise(module, kernels)
    if not fast:
        _make_small(module)
    module.verify()
    _optimise(module, target, fast=fast)
    return module


def main(
    kind: str, folder: Path, platforms: list[Platform], factory: str, arguments: list[str]
) -> None:
    """Write FOLDER/PLATFORM/COMPONENT for the components that a factory makes.

    That is LLVM code (.bc) of the fast entry points or, with it, object code (.o) of all.
    """
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    fast = kind == "fast"
    for argument in arguments:
        component = made_component(factory, argument)
        kernels = entry_points(component, fast=fast)
        for platform in platforms:
            module = _optimised(kernels, platform, fast=fast)
            file = folder / platform.name / f"{component.name}.bc"
            file.parent.mkdir(parents=True, exist_ok=True)
            if fast:
                file.write_bytes(module.as_bitcode())
            else:
                whole = llvm.parse_bitcode(file.read_bytes())
                whole.link_in(module)
                file.with_suffix(".o").write_bytes(_target(platform).emit_object(whole))


if __name__ == "__main__":
    wanted = [platform_of(name) for name in sys.argv[3].split(",")]
    main(sys.argv[1], Path(sys.argv[2]), wanted, sys.argv[4], sys.argv[5:])
