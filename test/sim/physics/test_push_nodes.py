# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes a push on a sphere acts on: device, reference and energy account agree."""

from itertools import product

from cloth_sim_ros.reference.forces import push_nodes
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
import pytest
from springs import SPRINGS

_STILL = {'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]}
_CENTERS = ((0, 0), (1, 0), (2, 3), (-4, 1), (5, 5), (-3, -2), (0, 4))
_RADII = (1, 2, 3, 4, 5, 7)


@pytest.mark.parametrize('parts', [10, 14, 30])
def test_a_node_on_the_sphere_is_in_it(context, parts: int):
    """Rounding would decide which nodes are pushed, and the force on each of the others."""
    side = parts + 1
    simulation = Simulation(Scene({
        **SPRINGS, 'rows': side, 'cols': side, **_STILL}), context=context)
    free = ~simulation.scene.pinned_nodes()
    wrong = []
    for (col, row), radius in product(_CENTERS, _RADII):
        # In units of the spacing all is whole, so what is inside is exact.
        offsets = product(range(-(parts // 2), parts // 2 + 1), repeat=2)
        exact = sum((x - col)**2 + (y - row)**2 <= radius**2 for x, y in offsets)
        simulation.reset()
        account = EnergyAccount(simulation)
        applied = simulation.push(
            (0.0, 0.0, 1e-3), duration=simulation.dt, region='sphere',
            center=(col / parts, row / parts, 1.0), radius=radius / parts)
        reference = push_nodes(applied.push, simulation.scene.start_positions(), free)
        account.step()
        counts = (applied.nodes, int(reference.sum()), int(account.pushed[applied.push].sum()))
        if counts != (exact,) * 3:
            wrong.append((col, row, radius, exact, counts))
    print(f'measured: {len(wrong)} of {len(_CENTERS) * len(_RADII)} spheres wrong: {wrong}')
    assert not wrong


def test_a_node_outside_by_more_than_rounding_is_not_pushed(context):
    """The tolerance would reach nodes that are clearly outside."""
    simulation = Simulation(Scene({**SPRINGS, 'rows': 11, 'cols': 11, **_STILL}), context=context)
    place = {'region': 'sphere', 'center': (0.0, 0.0, 1.0)}
    # 2^-23 (1 + 0.1) m is what float32 can't tell apart.
    for radius, nodes in ((0.1 - 1e-7, 5), (0.1 - 3e-7, 1), (0.1 + 3e-7, 5)):
        applied = simulation.push((0.0, 0.0, 1.0), duration=0.1, radius=radius, **place)
        assert applied.nodes == nodes, radius


def test_a_sphere_may_be_as_large_as_a_push_allows(context):
    """A request with a huge radius would miss the cloth, for the rounding of squared distances."""
    simulation = Simulation(Scene({**SPRINGS, 'rows': 3, 'cols': 3, **_STILL}), context=context)
    applied = simulation.push(
        (0.0, 0.0, 1.0), duration=0.1, region='sphere', center=(7e5, 0.0, -7e5), radius=1e6)
    assert applied.nodes == 9
    reference = push_nodes(
        applied.push, simulation.scene.start_positions(), ~simulation.scene.pinned_nodes())
    assert reference.all()
