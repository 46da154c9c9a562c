# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What rigid links do, by Lagrange's equations in their angles: no edges, no tensions, no steps.

Link i of length L ends in a mass m and has the angle a_i below the level. With
c_ij = (n - max(i, j)) m L^2 cos(a_i - a_j), the kinetic energy is sum c_ij a_i' a_j' / 2 and the
potential energy -sum (n - i) m g L sin a_i, i and j from 0, which gives

    sum_j (n - max(i, j)) m L^2 (cos(a_i - a_j) a_j'' + sin(a_i - a_j) a_j'^2) =
        (n - i) m g L cos a_i
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipk

GRAVITY = 9.81


def fall_from_level(links: int, length: float, times: np.ndarray) -> np.ndarray:
    """
    Return where the masses of a chain are that starts level and at rest.

    :param length: of each link [m]
    :param times: rising, from 0 on [s]
    :return: x and z of each mass from the pin (times, links, 2) [m]
    """
    below = links - np.arange(links)
    weights = links - np.maximum.outer(np.arange(links), np.arange(links))

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        angles, speeds = state[:links], state[links:]
        between = angles[:, None] - angles
        right = (below * GRAVITY / length * np.cos(angles)
                 - (weights * np.sin(between)) @ speeds**2)
        return np.concatenate([speeds, np.linalg.solve(weights * np.cos(between), right)])

    found = solve_ivp(
        rates, (0.0, float(times[-1])), np.zeros(2 * links), method='DOP853', rtol=1e-11,
        atol=1e-11, t_eval=times)
    angles = found.y[:links].T
    return np.stack(
        [length * np.cumsum(np.cos(angles), axis=1),
         -length * np.cumsum(np.sin(angles), axis=1)], axis=-1)


def catenary(nodes: int, length: float, span: float) -> np.ndarray:
    """
    Return a chain of equal masses that hangs between two pins at one height.

    Horizontal balance gives all links one pull, vertical balance steps of one weight from link
    to link: the tangents of their angles fall evenly.

    :param length: of the whole chain [m]
    :param span: between the pins [m]
    :return: x and z of each node from the first pin (nodes, 2) [m]
    """
    link = length / (nodes - 1)
    carried = (nodes - 2) / 2.0 - np.arange(nodes - 1)

    def angles(pull: float) -> np.ndarray:
        return np.arctan2(carried, pull)

    pull = brentq(lambda each: link * np.cos(angles(each)).sum() - span, 1e-3, 1e4)
    shape = np.zeros((nodes, 2))
    shape[1:, 0] = np.cumsum(link * np.cos(angles(pull)))
    shape[1:, 1] = -np.cumsum(link * np.sin(angles(pull)))
    return shape


def period_error(offsets: np.ndarray, dt: float) -> float:
    """
    Return the period of a rod of 1 m over 4 sqrt(L/g) K(sin 1/2), that from 1 rad at rest, less 1.

    :param offsets: of the lower end from the pin at each step of ``dt`` [s] (steps, 3) [m]
    """
    across = offsets[:, 0]
    before = np.flatnonzero(np.diff(np.sign(across)))
    crossings = before - across[before] / (across[before + 1] - across[before])
    exact = 4.0 * np.sqrt(1.0 / GRAVITY) * ellipk(np.sin(0.5)**2)
    return 2.0 * dt * float(np.mean(np.diff(crossings))) / exact - 1.0


def longest_explicit_pull(links: int) -> float:
    """
    Return the longest step [s] in which the pull across the links of a hanging chain is explicit.

    It is 2 / sqrt(lambda_max(M^-1 K_geo)); links of 1 m in all, with equal masses at their ends.
    """
    stiffness = np.zeros((links + 1, links + 1))
    for edge in range(links):
        per_length = (links - edge) * GRAVITY * links
        stiffness[edge:edge + 2, edge:edge + 2] += per_length * np.array([[1, -1], [-1, 1]])
    return float(2.0 / np.sqrt(np.linalg.eigvalsh(stiffness[1:, 1:])[-1]))
