# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The scenes that ship with the project."""

from pathlib import Path

from cloth_sim_ros.node.node_fields import check_together
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

SCENES = sorted((Path(__file__).resolve().parents[2] / 'config').glob('*.yaml'))


@pytest.fixture(params=SCENES, ids=lambda path: path.stem)
def given(request):
    """Return the parameters of each scene."""
    return load_parameters(request.param)


def scene_of(given):
    """Return the scene in what a file gives."""
    names = {field.name for field in all_fields(given)}
    return Scene({name: value for name, value in given.items() if name in names})


def test_node_and_simulation_accept_it(given):
    """A user's first start would end with an error."""
    refuse_unknown(given, all_fields(given) + NODE_FIELDS)
    scene_of(given)
    check_together({
        field.name: field.check(given.get(field.name, field.default)) for field in NODE_FIELDS})


def test_lists_of_numbers_are_all_of_one_kind(given):
    """ROS would refuse the file: it takes [0.0, 1.0] and [0, 1], and not [0, 1.0]."""
    for name, value in given.items():
        if isinstance(value, list):
            assert len({type(part) for part in value}) == 1, name


@pytest.mark.parametrize('seconds', [0.5, pytest.param(1.5, marks=pytest.mark.long)])
def test_it_moves_and_stays_cloth(given, seconds):
    """A shipped scene would blow up, or stretch like rubber."""
    scene = scene_of(given)
    simulation = Simulation(scene)
    simulation.advance(seconds)
    snapshot = simulation.snapshot()
    simulation.close()
    assert snapshot.finite
    assert np.nanmax(np.abs(snapshot.positions - scene.start_positions())) > 2e-3
    # Next to pins springs stretch more; cloth as a whole hardly does.
    assert float(snapshot.strain[scene.present_nodes].mean()) < 0.03
    assert snapshot.max_strain < 0.3
