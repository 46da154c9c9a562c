# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
