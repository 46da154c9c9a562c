# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a solve of an implicit step leaves is found by the next."""

import numpy as np


def test_errors_of_solves_do_not_add_up(simulate, within):
    """Each solve would leave momentum that no later one finds, and a run drift away."""
    ways = []
    for tolerance in (1e-5, 0.02):
        simulation = simulate({
            'mode': 'constraint', 'rows': 32, 'cols': 32, 'areal_density': 0.15, 'dt': 0.005,
            'auto_substeps': False, 'substeps': 2, 'solver.tolerance': tolerance,
            'solver.max_iterations': 200})
        simulation.advance(0.3)
        ways.append(simulation.positions().astype(float))
    within('RMS distance from a run of fine solves [m]',
           np.sqrt(((ways[1] - ways[0])**2).sum(axis=-1).mean()), 2e-5)
