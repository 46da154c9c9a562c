# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A hanging cloth with hard edges that has come to rest stays there."""

import numpy as np
import pytest


def _calm(simulation, seconds, interval=0.1, kept=0.8):
    """Take speed away from a cloth for a while, as air would."""
    for _ in range(round(seconds / interval)):
        simulation.advance(interval)
        seen = simulation.snapshot()
        simulation.set_state(seen.positions, kept * seen.velocities)


@pytest.mark.parametrize('slack', [pytest.param(0.0, marks=pytest.mark.long), 0.05])
@pytest.mark.parametrize(('nodes', 'calm', 'settle', 'rest'), [
    (12, 15.0, 0.0, 4.0), pytest.param(64, 60.0, 20.0, 10.0, marks=pytest.mark.long)])
def test_a_light_cloth_stays_at_rest(simulate, within, nodes, calm, settle, rest, slack):
    """A cloth at rest would tremble, swing up again, or pull at its pins with what is not."""
    simulation = simulate({
        'mode': 'constraint', 'rows': nodes, 'cols': nodes, 'areal_density': 0.15, 'dt': 0.02,
        'start.pose': 'hanging', 'start.jitter': 0.003})
    pinned = simulation.scene.pinned_nodes()
    if slack:
        # Its pins come together, so that it hangs in folds and not between taut lines.
        corner = simulation.scene.rest_positions()[0, 0]
        simulation.move_pin(0, 0, corner + (slack, 0.0, 0.0), 0.5)
    _calm(simulation, calm)
    # To write a state moves a free edge of a fine cloth by a millimetre a second, which air takes.
    simulation.advance(settle)
    weight = 0.15 * 9.81
    fastest = chequered = off = 0.0
    signs = (-1.0)**np.add.outer(np.arange(nodes), np.arange(nodes))[..., None]
    for _ in range(round(rest / 0.1)):
        simulation.advance(0.1)
        seen = simulation.snapshot(pin_forces=True)
        fastest = max(fastest, np.linalg.norm(seen.velocities, axis=-1).max())
        chequered = max(chequered, np.abs((signs * seen.velocities)[~pinned].mean(axis=0)).max())
        held = seen.pin_forces.forces.sum(axis=0)
        off = max(off, np.linalg.norm(held + (0.0, 0.0, weight)) / weight)
    within('fastest node [m/s]', fastest, 1e-3)
    within('chequerboard in the velocities [m/s]', chequered, 1e-4)
    within('forces at the pins off the weight, relative', off, 1e-3)
