"""Elements of arrays in one dimension, read and written in a few instructions.

numba finds each by the general rule for arrays of any dimensions, which unpacks all of the array's
description, and adds and multiplies by constants: some thirty instructions, of which LLVM keeps
three. Kernels hardly do anything but read and write elements: without it a first run takes a tenth
more time. The code is the same, so that it may serve whatever else is compiled in the process.

What it leans on inside of numba is tested for every minor version that is admitted.
"""

import operator

from llvmlite import ir
from numba import types
from numba.core.base import BaseContext
from numba.core.cgutils import do_boundscheck
from numba.core.imputils import lower_builtin
from numba.core.typing import Signature
from numba.cpython.slicing import fix_index
from numba.np.arrayobj import getitem_arraynd_intp, load_item, setitem_array, store_item


def _is_plain(array: types.Array) -> bool:
    return (
        array.ndim == 1
        and array.layout == "C"
        and isinstance(array.dtype, types.Number | types.Boolean)
    )


def _place(
    context: BaseContext, builder: ir.IRBuilder, kinds: tuple, values: tuple[ir.Value, ...]
) -> ir.Value:
    """Pointer to an element; negative indices count from the end."""
    (array, index, *_), (description, place, *_) = kinds, values
    fields = context.data_model_manager[array]
    size = builder.extract_value(description, (fields.get_field_position("shape"), 0))
    place = context.cast(builder, place, index, types.intp if index.signed else types.uintp)
    if index.signed and not (isinstance(place, ir.Constant) and place.constant >= 0):
        place = fix_index(builder, place, size)
    if context.enable_boundscheck:
        do_boundscheck(context, builder, place, size, 0)
    data = builder.extract_value(description, fields.get_field_position("data"))
    return builder.gep(data, [place])


@lower_builtin(operator.getitem, types.Array, types.Integer)
def read(
    context: BaseContext, builder: ir.IRBuilder, signature: Signature, values: tuple[ir.Value, ...]
) -> ir.Value:
    """Element of an array."""
    array = signature.args[0]
    if not _is_plain(array):
        return getitem_arraynd_intp(context, builder, signature, values)
    return load_item(context, builder, array, _place(context, builder, signature.args, values))


@lower_builtin(operator.setitem, types.Array, types.Integer, types.Number)
def write(
    context: BaseContext, builder: ir.IRBuilder, signature: Signature, values: tuple[ir.Value, ...]
) -> None:
    """Write an element of an array."""
    array, _, of = signature.args
    if not _is_plain(array):
        setitem_array(context, builder, signature, values)
        return
    value = context.cast(builder, values[2], of, array.dtype)
    store_item(context, builder, array, value, _place(context, builder, signature.args, values))
