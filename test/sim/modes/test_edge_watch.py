# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is foreseen of edges that come near their limit."""

from contextlib import closing

from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.edge_watch import StrainWatch
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np
import pytest
from springs import SPRINGS

# A cloth that falls on a ball at 5 m/s; its middle arrives after 4 ms.
FALLING = {
    **SPRINGS,
    'mode': 'adaptive', 'rows': 9, 'cols': 9, 'width': 0.4, 'height': 0.4,
    'start.pose': 'horizontal', 'start.z': 0.1, 'gravity': [0.0, 0.0, 0.0],
    'contact.thickness': 0.0, 'colliders.names': ['ball'], 'colliders.ball.size': [0.08]}


@pytest.mark.parametrize(('ahead', 'strain'), [
    (0.002, 0.0), (0.0065, (0.05**2 + 0.0125**2)**0.5 / 0.05 - 1.0)])
def test_a_collider_that_stops_a_node_is_foreseen(context, ahead, strain):
    """Edges would pass their limit by far where a falling cloth hits something."""
    scene = Scene(FALLING)
    layout = choose_layout(scene, context)
    positions = scene.start_positions()
    velocities = np.broadcast_to([0.0, 0.0, -5.0], positions.shape)
    pinned = np.zeros(positions.shape[:2], dtype=bool)
    with closing(_Parts(scene, layout, positions, velocities, pinned)) as parts:
        now, then = parts.watch.strains(
            parts.state, parts.loads.forcing(parts.state, 0.0, ahead), ahead)
    assert now < 1e-6
    # The node in the middle stays behind its neighbours, which go on.
    assert then == pytest.approx(strain, abs=1e-5)


@pytest.mark.parametrize('speed', [0.0, -0.4])
def test_strain_is_foreseen_by_velocity_and_by_what_acts(context, speed):
    """A limit would be passed before anybody looks again."""
    scene = Scene({
        **SPRINGS, 'mode': 'adaptive', 'rows': 5, 'cols': 4, 'width': 0.3, 'height': 0.4,
        'start.pose': 'hanging', 'pins': ['top_edge']})
    positions, pinned = scene.start_positions(), scene.pinned_nodes()
    velocities = np.zeros_like(positions)
    velocities[1:, :, 2] = speed
    ahead = 0.03
    with closing(_Parts(
            scene, choose_layout(scene, context), positions, velocities, pinned)) as parts:
        now, then = parts.watch.strains(
            parts.state, parts.loads.forcing(parts.state, 0.0, ahead), ahead)
    # As in one substep of all the time: the free nodes, 0.1 m below the pins, move alike.
    longer = ahead * (-speed + ahead * 9.81)
    assert now == pytest.approx(0.0, abs=1e-6)
    assert then == pytest.approx(longer / 0.1, rel=1e-5)


class _Parts:
    """A state on the device, its loads and a watch."""

    def __init__(self, scene, layout, positions, velocities, pinned):
        self.state = State(layout, positions, pinned)
        self.state.write(positions, velocities)
        self.loads = Loads(scene, layout, self.state)
        self.watch = StrainWatch(scene, layout, 0.9 * scene['adaptive.threshold'])

    def close(self):
        for part in (self.watch, self.loads, self.state):
            part.delete()
