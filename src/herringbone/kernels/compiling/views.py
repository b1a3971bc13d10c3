"""Parts of a work space as matrices and as integers.

numba's own `reshape` and `view` may fail, and what may fail needs Python.
"""

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import make_array, populate_array

_SIZE = 8


def _part(context, builder, kind, whole, values, shape):  # noqa: ANN001, ANN202
    """An array of a kind that begins at an element of the work space, by rows."""
    data = builder.gep(make_array(whole)(context, builder, values[0]).data, [values[1]])
    found = make_array(kind)(context, builder)
    strides: list[object] = []
    step = context.get_constant(types.intp, _SIZE)
    for size in reversed(shape):
        strides.insert(0, step)
        step = builder.mul(step, size)
    populate_array(
        found,
        data=builder.bitcast(data, found.data.type),
        shape=cgutils.pack_array(builder, shape),
        strides=cgutils.pack_array(builder, strides),
        itemsize=context.get_constant(types.intp, _SIZE),
        meminfo=context.get_constant_null(types.voidptr),
    )
    return found._getvalue()


@intrinsic
def matrix(typing_context, whole, first, rows, columns):  # noqa: ANN001, ANN201
    """Reals (rows, columns) of a work space from a place on."""
    kind = types.Array(types.float64, 2, "C")

    def generate(context, builder, signature, values):  # noqa: ANN001, ANN202
        return _part(context, builder, kind, signature.args[0], values, list(values[2:]))

    return kind(whole, types.intp, types.intp, types.intp), generate


@intrinsic
def integers(typing_context, whole, first, count):  # noqa: ANN001, ANN201
    """As many integers where the reals of a work space would be, from a place on."""
    kind = types.Array(types.int64, 1, "C")

    def generate(context, builder, signature, values):  # noqa: ANN001, ANN202
        return _part(context, builder, kind, signature.args[0], values, list(values[2:]))

    return kind(whole, types.intp, types.intp), generate
