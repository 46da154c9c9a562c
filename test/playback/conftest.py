# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording to play, and a place in the graph to listen from."""

from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.batch_run import BatchRun
from cloth_under_test import SCENE
from graph_client import GraphClient
from graph_fixtures import discovery  # noqa: F401
import pytest

SECONDS = 1.0


@pytest.fixture(scope='session')
def bag(tmp_path_factory):
    """Record a second of a cloth, and return the folder."""
    values = {field.name: field.default for field in NODE_FIELDS}
    values['recording.name'] = 'run'
    # Whoever listens to /tf hears the nodes of other tests, too.
    values['publish.tf'] = False
    simulation = Simulation(Scene(SCENE))
    run = BatchRun(simulation, values, str(tmp_path_factory.mktemp('bags')))
    run.advance(SECONDS)
    simulation.close()
    return run.recording_path


@pytest.fixture
def client():
    """Join the graph."""
    with GraphClient() as client:
        yield client
