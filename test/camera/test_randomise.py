# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Random look and place of a camera."""

import math

from cloth_sim_ros.camera.randomise import randomise
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np
import pytest
from seen_cloths import ASIDE
from seen_cloths import plane_cloth
from seen_cloths import snapshot_of

MODEL = CameraModel.of(**ASIDE)


def test_places_are_within_their_bounds(fallen):
    """A camera below the table, or within the cloth, makes a picture of nothing."""
    middle = fallen.positions().reshape(-1, 3).mean(axis=0)
    azimuths = []
    for seed in range(40):
        model, look = randomise(
            MODEL, fallen, seed=seed, distance=(0.9, 1.1), elevation=(30.0, 40.0))
        away = np.array(model.pose.position) - middle
        distance = np.linalg.norm(away)
        assert 0.9 <= distance <= 1.1
        assert 30.0 <= math.degrees(math.asin(away[2] / distance)) <= 40.0
        # The middle of the cloth is near the middle of the picture.
        u, v = model.project(model.pose.seen_from(middle[None]))[0]
        assert 0.0 < u < model.width and 0.0 < v < model.height
        assert (model.width, model.fx, model.far) == (MODEL.width, MODEL.fx, MODEL.far)
        assert look.sun[2] > 0.0 and set(look.bodies) == {'ball', 'ground'}
        azimuths.append(math.atan2(away[1], away[0]))
    assert max(azimuths) > 1.5 and min(azimuths) < -1.5


def test_a_seed_repeats_its_picture(camera, fallen):
    """A picture that is looked into again must be the same."""
    pictures = []
    for seed in (3, 3, 4):
        model, look = randomise(MODEL, fallen, seed=seed)
        pictures.append(camera(model=model).capture(fallen, look=look))
    same, again, other = (picture.color for picture in pictures)
    np.testing.assert_array_equal(same, again)
    assert np.any(same != other)


def test_a_generator_is_drawn_from(fallen):
    """Pictures of one generator were all alike."""
    random = np.random.default_rng(3)
    first, second = (randomise(MODEL, fallen, seed=random) for _ in range(2))
    assert first == randomise(MODEL, fallen, seed=3) and first != second


def test_a_snapshot_with_colliders(fallen):
    """Snapshots know no colliders: those given get their colours."""
    cloth = snapshot_of(plane_cloth((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    _, look = randomise(MODEL, cloth, seed=1, colliders=fallen.colliders)
    assert set(look.bodies) == {'ball', 'ground'}


@pytest.mark.parametrize('wrong, rule', [
    ({'seed': -1}, 'must be 0 or more'),
    ({'seed': 1.5}, 'must be a whole number'),
    ({'distance': (2.0, 1.0)}, 'the lower one first'),
    ({'distance': (0.0, 1.0)}, 'from 0.05 to 1000 m'),
    ({'elevation': (0.0, 91.0)}, 'from -89 to 89 deg'),
    ({'elevation': 3.0}, 'must be 2 finite numbers'),
    ({'camera': 3}, 'must be a CameraModel'),
])
def test_wrong_values_are_refused(fallen, wrong, rule):
    """A picture would show nothing, and nobody told why."""
    with pytest.raises(ClothSimError, match=rule):
        randomise(**{'camera': MODEL, 'cloth': fallen, 'seed': 1, **wrong})
