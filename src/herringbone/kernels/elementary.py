"""Sine, cosine and exponential from + - * / alone, so that all platforms give the same bits.

Method and coefficients: W. J. Cody and W. Waite, Software Manual for the Elementary Functions
(1980), argument reduction in three parts; minimax polynomials as published in FDLIBM 5.3
(Sun Microsystems 1993, freely distributable), k_sin.c, k_cos.c, e_exp.c. Sine's and cosine's are
summed in two parts, which need not wait for each other.
Error at most 1 ulp for |x| <= 1e6 (sine, cosine) and -708 <= x <= 709 (exponential).
"""

import math

from herringbone.kernels.compiling.jit import kernel

_TWO_OVER_PI = 6.36619772367581382433e-01
# pi/2 in three parts of 33 bits and a remainder: n * part is exact for |n| < 2**20.
_PIO2_1 = 1.57079632673412561417e00
_PIO2_2 = 6.07710050630396597660e-11
_PIO2_3 = 2.02226624871116645580e-21
_PIO2_3T = 8.47842766036889956997e-32

_S1, _S2, _S3 = -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04
_S4, _S5, _S6 = 2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10
_C1, _C2, _C3 = 4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05
_C4, _C5, _C6 = -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11

_LN2_HIGH = 6.93147180369123816490e-01
_LN2_LOW = 1.90821492927058770002e-10
_INVERSE_LN2 = 1.44269504088896338700e00
_P1, _P2, _P3 = 1.66666666666666019037e-01, -2.77777777770155933842e-03, 6.61375632143793436117e-05
_P4, _P5 = -1.65339022054652515390e-06, 4.13813679705723846039e-08


@kernel
def _reduce(x: float) -> tuple[int, float, float]:
    """Quadrant n and remainder in two parts: x = n pi/2 + high + low."""
    n = math.floor(x * _TWO_OVER_PI + 0.5)
    first = x - n * _PIO2_1
    part = n * _PIO2_2
    second = first - part
    error = (first - second) - part
    part = n * _PIO2_3
    third = second - part
    error += (second - third) - part - n * _PIO2_3T
    high = third + error
    return int(n) & 3, high, (third - high) + error


@kernel
def _sine(x: float, low: float) -> float:
    z = x * x
    v = z * x
    r = _S2 + z * (_S3 + z * _S4) + z * (z * z) * (_S5 + z * _S6)
    return x - ((z * (0.5 * low - v * r) - low) - v * _S1)


@kernel
def _cosine(x: float, low: float) -> float:
    z = x * x
    square = z * z
    r = z * (_C1 + z * (_C2 + z * _C3)) + square * square * (_C4 + z * (_C5 + z * _C6))
    half = 0.5 * z
    w = 1.0 - half
    return w + (((1.0 - w) - half) + (z * r - x * low))


@kernel
def sine(x: float) -> float:
    """Sine of x [rad]."""
    quadrant, high, low = _reduce(x)
    if quadrant == 0:
        return _sine(high, low)
    if quadrant == 1:
        return _cosine(high, low)
    if quadrant == 2:
        return -_sine(high, low)
    return -_cosine(high, low)


@kernel
def cosine(x: float) -> float:
    """Cosine of x [rad]."""
    quadrant, high, low = _reduce(x)
    if quadrant == 0:
        return _cosine(high, low)
    if quadrant == 1:
        return -_sine(high, low)
    if quadrant == 2:
        return -_cosine(high, low)
    return _sine(high, low)


@kernel
def sine_and_cosine(x: float) -> tuple[float, float]:
    """Sine and cosine of x [rad], the same bits as `sine` and `cosine`."""
    quadrant, high, low = _reduce(x)
    s, c = _sine(high, low), _cosine(high, low)
    if quadrant == 0:
        return s, c
    if quadrant == 1:
        return c, -s
    if quadrant == 2:
        return -s, -c
    return -c, s


@kernel
def exponential(x: float) -> float:
    """Exponential of x; 0 below -708, infinite above 709."""
    if x < -708.0:
        return 0.0
    if x > 709.0:
        return math.inf
    n = math.floor(x * _INVERSE_LN2 + 0.5)
    high = x - n * _LN2_HIGH
    low = n * _LN2_LOW
    r = high - low
    z = r * r
    c = r - z * (_P1 + z * (_P2 + z * (_P3 + z * (_P4 + z * _P5))))
    value = 1.0 - ((low - (r * c) / (2.0 - c)) - high)
    scale = 2.0 if n > 0 else 0.5
    steps = abs(int(n))
    while steps > 0:
        if steps & 1:
            value *= scale
        scale *= scale
        steps >>= 1
    return value
