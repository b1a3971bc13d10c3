"""What the linear model of a foreign part answers to shafts that speed up evenly."""

import numpy as np

from herringbone.analysis.stability.surrogates.identification import LinearModel


def by_acceleration(model: LinearModel, angles: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """(m,) outputs by an acceleration of 1 rad/s^2, when motions of the model's own have died out.

    With inputs angles t^2 / 2 + speeds t the states are x_0 + x_1 t + x_2 t^2 / 2, and

        0 = a x_2 + b angles,    x_2 = a x_1 + b speeds,    x_1 = a x_0.

    What is told is that at t = 0: what speed makes of outputs is no inertia.

    Args:
        model: of k states.
        angles: (n,) second rates of the inputs that are angles; 0 of others.
        speeds: (n,) rates of the inputs that are speeds; 0 of others.

    Raises:
        LinAlgError: the model has a motion that never dies out.
    """
    if not len(model.a):
        return np.zeros(len(model.d))
    second = -np.linalg.solve(model.a, model.b @ angles)
    first = np.linalg.solve(model.a, second - model.b @ speeds)
    return model.c @ np.linalg.solve(model.a, first)
