# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""How long the two steps of smoothing are."""

from cloth_sim_ros.sim.solver.edge_law import EdgeLaw

# What smoothing leaves to the coarser levels lies below this, with an eigenvalue of 2 at most.
_LEAST = 0.25
# On coarse levels a bend edge counts with those of four nodes.
_EDGES_OF_A_NODE = (2.0, 2.0, 4.0, 8.0, 8.0)
# The squares of a node's parts in the three lines around it: 1, 2 and 1.
_LINES_OF_A_NODE = 6.0


def smoothing_steps(law: EdgeLaw) -> tuple[float, float]:
    """
    Return the two Chebyshev steps, as shares of a whole step of block-Jacobi.

    They are made for the eigenvalues of the system over its diagonal blocks. With edges that
    weigh d around a node of mass 1 none is below 1 / (1 + d) nor, as an edge ties two nodes, above
    (1 + 2 d) / (1 + d). Bending of the weight b around a node has up to 3 b there, as it ties
    three nodes; out of the plane of the cloth it is alone. Without either both steps are whole
    ones, and the first is exact.

    Beyond the largest eigenvalue foreseen, smoothing makes errors grow and the preconditioner has
    negative eigenvalues: the solver would tell of small residuals and be wrong.
    """
    edges = sum(count * weight for count, weight in zip(_EDGES_OF_A_NODE, law.weights))
    bending = _LINES_OF_A_NODE * sum(law.bending_bounds)
    around = edges + bending
    least = max(_LEAST, 1.0 / (1.0 + around))
    most = max(
        (1.0 + 2.0 * edges + 3.0 * bending) / (1.0 + around),
        (1.0 + 3.0 * bending) / (1.0 + bending))
    middle, reach = 0.5 * (most + least), 0.5 * (most - least) * 0.5**0.5
    return 1.0 / (middle + reach), 1.0 / (middle - reach)
