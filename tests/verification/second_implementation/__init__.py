"""A second statement of gearbox and test rig, in numpy, written from the READMEs alone.

One file per concept, with the equations of the README in `fmus` that it names; nothing here is
taken from the kernels. `assembly` joins them to one system of ordinary differential equations,
without coupling and without micro steps, which scipy's DOP853 solves; `product` runs the product,
and hands over start values and parameters as the product says them; the tests compare both.

What differs is an error of one of the two, or a gap in a README: mend it there.
"""
