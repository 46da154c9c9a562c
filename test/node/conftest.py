# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One node, and one place in the graph, for all the tests that need no node of their own."""

from collections.abc import Iterator

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from cloth_under_test import HANDLED_NAME
from cloth_under_test import NAMESPACE
from cloth_under_test import PAUSED
from cloth_under_test import SCENE
from graph_client import GraphClient
from graph_fixtures import client  # noqa: F401
from graph_fixtures import discovery  # noqa: F401
from graph_fixtures import passing  # noqa: F401
from node_process import NodeProcess
import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node


@pytest.fixture(scope='session')
def shared_node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NodeProcess]:
    """Start the node that most tests share."""
    folder = tmp_path_factory.mktemp('shared_node')
    with NodeProcess(folder, PAUSED, '-r', f'__ns:={NAMESPACE}') as node:
        yield node


@pytest.fixture(scope='session')
def shared_cloth(shared_node: NodeProcess, client: GraphClient) -> ClothUnderTest:  # noqa: F811
    """Listen to the shared node once."""
    return ClothUnderTest(client, PAUSED)


@pytest.fixture
def cloth(shared_cloth: ClothUnderTest) -> ClothUnderTest:
    """Bring the shared node back to its start, paused."""
    shared_cloth.restore()
    return shared_cloth


@pytest.fixture(scope='session')
def handled_cloth(
        tmp_path_factory: pytest.TempPathFactory,
        client: GraphClient) -> Iterator[ClothUnderTest]:  # noqa: F811
    """Start a node with colliders, for the tests of what moves them and of grasps."""
    folder = tmp_path_factory.mktemp('handled_node')
    values = {**HANDLED, 'start_paused': True}
    with NodeProcess(folder, values, '-r', f'__ns:={HANDLED_NAME.rpartition("/")[0]}'):
        yield ClothUnderTest(client, values, HANDLED_NAME)


@pytest.fixture
def handled(handled_cloth: ClothUnderTest) -> ClothUnderTest:
    """Bring the node with colliders back to its start, paused."""
    handled_cloth.restore()
    return handled_cloth


@pytest.fixture
def twin() -> Iterator[Simulation]:
    """Make its cloth without a node, to compare with."""
    with Simulation(Scene(HANDLED)) as simulation:
        yield simulation


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    """Make the same cloth without a node, to compare with."""
    simulation = Simulation(Scene(SCENE))
    yield simulation
    simulation.close()


@pytest.fixture
def lone_node() -> Iterator[Node]:
    """Lend a node of this process, in a graph of its own context."""
    context = Context()
    rclpy.init(context=context)
    made = rclpy.create_node('lone_node', context=context)
    yield made
    made.destroy_node()
    rclpy.try_shutdown(context=context)
