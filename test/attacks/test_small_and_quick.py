# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths so small that frames take no time at all."""

from cloth_sim_interfaces.msg import ClothStats
from node_process import NodeProcess
import pytest

# Number for each of four sizes at two paces: 100,000 in all.
FRAMES = 12_500
# So that a frame every 0.5 ms is asked for where time keeps to the wall clock.
QUICK = {'publish.rate': 2000.0, 'dt': 0.0005}


@pytest.mark.parametrize(('nodes', 'factor', 'frames'), [
    (16, 1.0, 1500), *(
        pytest.param(nodes, factor, FRAMES, marks=pytest.mark.long)
        for nodes in (2, 4, 8, 16) for factor in (0.0, 1.0))])
def test_lives_on(client, tmp_path, nodes, frames, factor):
    """A node with little to do would end by itself after some seconds."""
    scene = {
        'rows': nodes, 'cols': nodes, 'real_time_factor': factor, 'publish.points': False,
        'publish.markers': False, 'publish.wrenches': False, 'publish.tf': False, **QUICK}
    with NodeProcess(tmp_path, scene, '-r', '__ns:=/quick') as node:
        stats = client.watch(ClothStats, '/quick/cloth_sim/stats', depth=10)
        made, latest = 0, 0.0
        while made < frames:
            client.spin_until(lambda: stats.messages or not node.running, 'a frame')
            assert node.running, node.output[-3000:]
            for message in stats.messages:
                stamp = message.header.stamp.sec + message.header.stamp.nanosec * 1e-9
                assert stamp > latest or message.steps <= 1
                assert stamp == pytest.approx(message.steps * scene['dt'], abs=1e-9)
                made, latest = message.steps, stamp
            stats.clear()
        assert 'unexpected' not in node.output
    assert node.wait() == 0
