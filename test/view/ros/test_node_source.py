# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The view of a running node: what it publishes is shown, and its services do what is asked."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
import signal
import subprocess
import sys
import time

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.ros.node_source import NodeSource
from cloth_under_test import SCENE
from node_process import NodeProcess
from node_process import PATIENCE
import numpy as np
import pytest
from served_view import served
from view_page import ViewPage

PAUSED = {**SCENE, 'start_paused': True}


@pytest.fixture(scope='module')
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeProcess]:
    """Start a paused node."""
    with NodeProcess(tmp_path_factory.mktemp('node'), PAUSED, '-r', '__ns:=/shown') as node:
        yield node


@pytest.fixture
def source(node: NodeProcess) -> NodeSource:
    """Listen to the node, at its start; the view of it leaves the graph."""
    source = NodeSource('shown/cloth_sim', 300.0)
    source.set_paused(True)
    source.reset()
    return source


@pytest.fixture
def page(source: NodeSource) -> Iterator[ViewPage]:
    """Open a page of the node."""
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: page.text and '/cloth/pins' in page.nodes, 'a cloth')
        yield page


def test_the_node_is_shown_and_steered(page: ViewPage, source: NodeSource):
    """The page would show another cloth than the node's, or not reach its services."""
    page.wait_for(lambda: 't = 0.00 s' in page.text, 'the start')
    rest = Scene(SCENE).rest_positions().reshape(-1, 3)
    np.testing.assert_allclose(
        np.unique(page.points(), axis=0), np.unique(np.float32(rest), axis=0), atol=1e-6)
    assert page.text.startswith('**/shown/cloth_sim**, paused')
    page.give('Step', True)
    page.wait_for(lambda: source.latest().frame.time == pytest.approx(SCENE['dt']), 'a step')
    page.give('Mode', 'adaptive')
    page.wait_for(lambda: 'mode adaptive' in page.text, 'the mode')
    page.give('Run', True)
    page.wait_for(lambda: 'running' in page.text, 'a run')
    target = (-0.35, 0.3, 1.1)
    page.drag('/handles/0_0', target)
    page.wait_for(
        lambda: np.allclose(source.latest().frame.positions[0, 0], target, atol=1e-5), 'the pin')
    page.click((0.05, 0.05, 3.0), (0.0, 0.0, -1.0))
    page.give('Click', 'pins or releases')
    page.give('Mode', 'mass_spring')
    page.wait_for(lambda: 'mode mass_spring' in page.text, 'the mode before')


def test_what_the_node_refuses_is_told(source: NodeSource):
    """A page would not learn why nothing happens."""
    try:
        with pytest.raises(ClothSimError, match='pinned|pin it'):
            source.move_pin(3, 3, (0.0, 0.0, 1.0))
        with pytest.raises(ClothSimError, match='no free node'):
            source.push((0.0, 0.0, 1.0), (9.0, 9.0, 9.0), 0.1, 0.1)
        source.hold(3, 3)
        source.push((0.0, 0.0, 1.0), (0.0, 0.0, 1.0), 0.2, 0.1)
        source.release(3, 3)
    finally:
        source.close()


def test_a_view_that_ends_waits_for_no_answer(node: NodeProcess, source: NodeSource):
    """Ctrl-C would leave a view of a busy node running until its timeout."""
    node.send(signal.SIGSTOP)
    try:
        with ThreadPoolExecutor() as pool:
            call = pool.submit(source.step, 1)
            while not source._waiting:
                assert not call.done()
                time.sleep(0.01)
            source.close()
            with pytest.raises(ClothSimError, match='cloth_sim/step has not answered before'):
                call.result()
    finally:
        node.send(signal.SIGCONT)


def test_a_view_leaves_the_node_as_it_is(node: NodeProcess, source: NodeSource):
    """Closing a page would end the node."""
    source.close()
    assert node.running


def test_without_a_node_it_is_told(tmp_path: Path):
    """A page would wait for ever."""
    with pytest.raises(ClothSimError, match='no message arrives on /nobody/state within 0.2 s'):
        NodeSource('nobody', 0.2)


# Threads that take turns often end a view at any point of the first spin of its executor.
_ENDED_AT_ONCE = """
import sys
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.view.ros.node_source import NodeSource
sys.setswitchinterval(1e-6)
for number in range(60):
    try:
        NodeSource('nobody', (0.0, 1e-5, 1e-4, 3e-4, 1e-3, 2e-3)[number % 6])
    except ClothSimError:
        print('ended')
"""


def test_a_view_ends_as_soon_as_it_has_begun():
    """An executor that was shut down as it began to spin waited for ever, and the view with it."""
    done = subprocess.run(
        [sys.executable, '-c', _ENDED_AT_ONCE], capture_output=True, text=True, timeout=PATIENCE)
    assert done.stdout.count('ended') == 60, done.stderr
