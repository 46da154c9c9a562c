# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs of a scene with the code of two commits."""

from contextlib import ExitStack
from pathlib import Path

from against_commit import Contestant
from against_commit import largest_stretch
from against_commit import scene_values
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
VALUES = {'rows': 4, 'cols': 5, 'width': 1.2, 'height': 0.6, 'areal_density': 0.15}


@pytest.mark.parametrize(('axis', 'stretch'), [(0, 0.03), (1, 0.02)])
def test_the_stretch_is_that_of_the_longest_edge(axis, stretch):
    """A diagonal or an edge along one axis would be left out, or be set against another length."""
    across, down = np.meshgrid(np.linspace(0.0, 1.2, 5), np.linspace(0.0, 0.6, 4))
    positions = np.stack([across, down, np.zeros_like(across)], axis=-1)
    assert largest_stretch(positions, VALUES) == pytest.approx(0.0, abs=1e-12)
    positions[..., axis] *= 1.0 + stretch
    assert largest_stretch(positions, VALUES) == pytest.approx(stretch)


def test_the_same_code_twice_makes_the_same_motion():
    """The two would not run the same scene, or one would begin later than the other."""
    with ExitStack() as processes:
        twins = [Contestant('twin', ROOT, VALUES), Contestant('twin', ROOT, VALUES)]
        for twin in twins:
            twin.begin(processes)
            twin.advance(0.02)
            twin.advance(0.02)
    assert twins[0].stretches == twins[1].stretches
    assert len(twins[0].stretches) == len(twins[0].substeps) == 2
    assert 0.0 < twins[0].stretches[-1] < 0.1
    assert min(twin.processor for twin in twins) > 0.0


@pytest.mark.parametrize(('name', 'collider'), [
    ('towel_over_bodies', 'colliders.ball.shape'), ('drape', None)])
def test_a_scene_file_is_taken_as_it_is(name, collider):
    """Parameters of colliders, which have their own names, would be lost, or the node's kept."""
    values = scene_values(ROOT / 'config' / f'{name}.yaml', {'dt': 0.004})
    assert values['dt'] == 0.004
    assert not any(key.startswith('publish.') for key in values)
    assert collider is None or collider in values
    scene = Scene(values)
    assert (values['width'], values['height']) == (scene['width'], scene['height'])
