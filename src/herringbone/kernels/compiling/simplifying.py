"""LLVM code of a piece made shorter before others take it in.

numba keeps each variable in memory and describes each array by seven numbers: four of five
instructions do nothing. Whoever takes in a piece would drop them, once for each of its callers, and
link, copy and read them before. Here no function is taken into another, and nothing depends on the
processor: what LLVM decides by that is decided in the whole.
"""

from functools import cache

import llvmlite.binding as llvm


@cache
def _passes() -> tuple[llvm.FunctionPassManager, llvm.PassBuilder]:
    """Variables to registers, empty blocks away, instructions joined."""
    target = llvm.Target.from_default_triple().create_target_machine()
    options = llvm.create_pipeline_tuning_options()
    passes = llvm.create_new_function_pass_manager()
    passes.add_sroa_pass()
    passes.add_simplify_cfg_pass()
    passes.add_instruction_combine_pass()
    return passes, llvm.create_pass_builder(target, options)


def simplify(function: llvm.ValueRef) -> None:
    """Make a function shorter, which computes the same bits."""
    passes, builder = _passes()
    passes.run(function, builder)
