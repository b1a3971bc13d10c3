"""What the energy monitor sees of a macro step with signals at nodes: the iterated algorithms.

The force that a body took is the polynomial through the trial values of the last pass; the motion
is the one of degree 2 p + 1 through positions and velocities at the p + 1 nodes. It is right for
bonds that turn much further in a step than the forces' polynomial of degree p can follow, which is
what makes the step unstable. Elements have seen the true motion. Both integrals are Gauss rules.
"""

import numpy as np

from herringbone.cosim.energy.loop import begin_step, finish_pair
from herringbone.cosim.energy.monitor import COMMON, DRAG_AT_END, ELASTIC, EnergyMonitor
from herringbone.cosim.energy.window import end_step
from herringbone.kernels.compiling.jit import inlined, kernel


@inlined
def _write_speed(monitor: EnergyMonitor, nodes: np.ndarray, i: int, h: float) -> None:
    """Velocities of pair i at the points, less their common mean."""
    count, s, v = nodes.shape[0], monitor.places.position[i], monitor.places.velocity[i]
    points, common, rule = monitor.points, monitor.state[COMMON, i], monitor.rule
    share, per_step = h * common / (count - 1), 1.0 / h
    for k in range(count):
        points[count + k] = h * (nodes[k, v] - common)
    for k in range(count):
        points[k] = 0.0
        if s >= 0:
            points[k] = nodes[k, s] - nodes[0, s] - k * share
        else:
            for j in range(count):
                points[k] += rule.position[k, j] * points[count + j]
    for q in range(rule.weight.size):
        total = 0.0
        for k in range(2 * count):
            total += rule.motion[q, k] * points[k]
        monitor.speed[i, q] = total * per_step


@inlined
def _taken_force(
    monitor: EnergyMonitor, nodes: np.ndarray, trial: np.ndarray, i: int, values: np.ndarray
) -> float:
    """Force on the body of pair i at the nodes, into `values`; its mean over the step."""
    f, unknown, mean = monitor.places.force[i], monitor.places.unknown[i], 0.0
    for k in range(nodes.shape[0]):
        at_node = k > 0 and unknown >= 0
        values[k] = trial[k - 1, unknown] if at_node else nodes[k, f]
        mean += monitor.rule.mean[k] * values[k]
    return mean


@inlined
def _work(
    monitor: EnergyMonitor, nodes: np.ndarray, trial: np.ndarray, i: int, elastic: float, h: float
) -> float:
    """Work of the force that pair i's body took, less that of the elastic force [J]."""
    rule, values, start = monitor.rule, monitor.points, monitor.state[ELASTIC, i]
    mean, work = _taken_force(monitor, nodes, trial, i, values), 0.0
    less = 0.5 * (start + elastic)
    for q in range(rule.weight.size):
        force = mean
        if not monitor.places.held[i]:
            force = 0.0
            for k in range(nodes.shape[0]):
                force += rule.force[q, k] * values[k]
        if monitor.springless[i]:
            less = start + (elastic - start) * rule.place[q]
        work += rule.weight[q] * (force - less) * monitor.speed[i, q]
    return h * work


@inlined
def _write_heat(monitor: EnergyMonitor, h: float) -> None:
    """Energy that the dampers take at each pair, into `taken[0]`."""
    speed, weight, heat = monitor.speed, monitor.rule.weight, monitor.taken
    for i in range(monitor.places.force.size):
        heat[0, i] = 0.0
    for k in range(monitor.row.size):
        total, i, j = 0.0, monitor.row[k], monitor.column[k]
        for q in range(weight.size):
            total += weight[q] * speed[i, q] * speed[j, q]
        heat[0, i] += h * monitor.damping[k] * total


@kernel
def watch_nodes(monitor: EnergyMonitor, nodes: np.ndarray, trial: np.ndarray, h: float) -> None:
    """Account for one macro step.

    Args:
        monitor: is written.
        nodes: (p + 1, outputs) at c = 0, 1/p, ..., 1, as the last pass left them.
        trial: (p, unknowns) values at c > 0 on which that pass stepped the bodies.
        h: macro step [s].
    """
    state, end = monitor.state, nodes[nodes.shape[0] - 1]
    begin_step(monitor, nodes[0], end, True)
    for i in range(monitor.places.force.size):
        _write_speed(monitor, nodes, i, h)
    _write_heat(monitor, h)
    for i in range(monitor.places.force.size):
        elastic = end[monitor.places.force[i]] + state[DRAG_AT_END, i]
        work = _work(monitor, nodes, trial, i, elastic, h)
        finish_pair(monitor, i, elastic, work, monitor.taken[0, i], h)
    end_step(monitor, h)
