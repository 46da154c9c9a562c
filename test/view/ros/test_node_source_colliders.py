# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The view of a running node shows what its cloth can touch, where that is."""

from pathlib import Path
import time

from cloth_sim_ros.view.ros.node_source import NodeSource
from cloth_under_test import HANDLED
from node_process import NodeProcess
import numpy as np

TARGET = (0.3, 0.0, 0.85)
VALUES = {
    **HANDLED, 'start_paused': True, 'collider_moves.start': [0.0],
    'collider_moves.name': ['ball'], 'collider_moves.target': list(TARGET),
    'collider_moves.orientation': [0.0, 0.0, 1.0, 1.0], 'collider_moves.speed': [3.0],
    'collider_moves.angular_speed': [30.0]}
PATIENCE = 300.0


def wait_for(condition):
    """Wait until ``condition`` returns something true, and return it."""
    deadline = time.monotonic() + PATIENCE
    while not (found := condition()):
        assert time.monotonic() < deadline
        time.sleep(0.01)
    return found


def colliders_of(source):
    """Return the colliders that the view shows now, by name."""
    moment = source.latest()
    return {collider.name: collider for collider in moment.frame.colliders} if moment else {}


def test_the_colliders_of_a_node_are_shown_where_they_are(tmp_path: Path):
    """A cloth would hang over something that nobody sees, or sees elsewhere."""
    with NodeProcess(tmp_path, VALUES, '-r', '__ns:=/touched'):
        source = NodeSource('touched/cloth_sim', PATIENCE)
        try:
            source.set_paused(True)
            found = wait_for(lambda: colliders_of(source))
            assert {name: (each.shape, each.size) for name, each in found.items()} == {
                'ball': ('sphere', (0.1,)), 'floor': ('plane', ())}
            np.testing.assert_allclose(found['floor'].position, (0.0, 0.0, 0.2), atol=1e-12)
            source.step(round(0.2 / HANDLED['dt']))
            wait_for(lambda: np.allclose(colliders_of(source)['ball'].position, TARGET))
            turned = colliders_of(source)['ball'].orientation
            np.testing.assert_allclose(turned, (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)), atol=1e-9)
        finally:
            source.close()
