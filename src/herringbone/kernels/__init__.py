"""Compiled numerics on plain arrays: elementary functions, signals, steppers, interpolation.

Kernel language, so that the same source compiles into a library without Python: scalar loops,
+ - * / sqrt and the functions of this package; no raise, assert, print, allocation, array
expression, slice assignment or linear algebra.
"""
