"""What the tests of FMUs share: names, and a run with the golden inputs."""

from herringbone.components.registry import COMPONENTS
from herringbone.fmi import golden

NAMES = list(COMPONENTS)
H = golden.STEP_SIZE
STEPS = 30
"""Of a short run; long enough for a sample of the velocity sensor that is not zero."""


def outputs(name):
    return [v.name for v in COMPONENTS[name].declaration.outputs]


def run(host, name, steps=STEPS, first=0):
    """Outputs after some steps with the golden inputs."""
    for n in range(first, first + steps):
        host.set_values(golden.inputs(COMPONENTS[name], n * H))
        host.step(n * H, H)
    return host.values(*outputs(name))
