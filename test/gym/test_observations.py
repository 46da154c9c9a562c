# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What an environment shows of its cloth."""

import subprocess
import sys
import warnings

from cloth_sim_ros import ClothSimError
import gymnasium
from gymnasium.utils.env_checker import check_env
import numpy as np
import pytest
from small_environment import SMALL

STRAIGHT = {'azimuth': -90.0, 'elevation': 0.0}


@pytest.mark.parametrize('observation', [
    'positions', 'state', 'depth', ['positions', 'depth'], ('state', 'depth'), ['positions']])
def test_gymnasium_accepts_it(make, observation):
    """Learning libraries would fail in it, or learn from other seeds than they gave."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        check_env(make(observation=observation), skip_render_check=True)


def test_a_depth_picture_shows_the_cloth_where_it_hangs(make):
    """A policy would look at nothing, or at another cloth."""
    environment = make(
        observation='depth', camera=STRAIGHT, picture_size=(40, 60), jitter=0.0,
        goal=(0.4, 0.0, 0.0))
    seen, _ = environment.reset()
    far = environment.observation_space.high
    assert seen.shape == (40, 60) and seen.dtype == np.float32 and (far == far[0, 0]).all()
    covered = seen < far
    # Straight in front of the camera, half of what it looks at: the goal is beside the cloth.
    assert covered[20, :28].sum() > 20 and not covered[:, 32:].any()
    np.testing.assert_allclose(seen[covered], np.median(seen[covered]), rtol=1e-3)


def test_depth_image_shows_occluders(make):
    """A policy would see through a table."""
    wall = {
        'colliders.names': ['wall'], 'colliders.wall.shape': 'box',
        'colliders.wall.size': [9.0, 0.1, 9.0], 'colliders.wall.position': [0.0, -0.15, 0.0]}
    pictures = [
        make({**SMALL, **more}, observation='depth', camera=STRAIGHT, jitter=0.0).reset()[0]
        for more in ({}, wall)]
    # Its front is 0.2 m in front of the cloth, and covers all.
    np.testing.assert_allclose(pictures[1], pictures[0].min() - 0.2, rtol=1e-3)


def test_the_picture_follows_the_cloth(make):
    """A policy would see the start for ever."""
    environment = make(
        observation=['positions', 'depth'], camera=STRAIGHT, goal=(0.4, 0.0, 0.0), speed=2.0)
    first, _ = environment.reset(seed=1)
    for _ in range(4):
        last, *_ = environment.step(np.array([[1.0, 0.0, 0.0]] * 2, np.float32))
    far = environment.observation_space['depth'].high
    across = [np.argwhere(seen['depth'] < far)[:, 1].mean() for seen in (first, last)]
    assert list(last) == ['positions', 'depth']
    assert across[1] > across[0] + 10.0
    assert last['positions'][0, 0, 0] - first['positions'][0, 0, 0] == pytest.approx(0.4, abs=1e-5)


def test_a_seed_gives_the_same_picture(make):
    """A result could not be made again."""
    environment = make(observation='depth')
    pictures = [environment.reset(seed=seed)[0] for seed in (7, 7, 8)]
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert not np.array_equal(pictures[0], pictures[2])


def test_it_is_made_by_name():
    """A configuration that names environments could not ask for a picture."""
    environment = gymnasium.make(
        'cloth_sim_ros/CarryCloth-v0', scene=SMALL, observation='depth', picture_size=[8, 12])
    assert environment.reset(seed=1)[0].shape == (8, 12)
    environment.close()


@pytest.mark.parametrize('options, said', [
    ({'observation': 'picture'},
     "positions, state or depth, a list of them, or a function, got 'picture'"),
    ({'observation': []}, 'a list of them'),
    ({'observation': ['depth', 'depth']}, 'a list of them'),
    ({'observation': 'depth', 'camera': {'height': 3.0}}, 'give azimuth, elevation'),
    ({'observation': 'depth', 'camera': {'azimuth': 'left'}}, 'give azimuth, elevation'),
    ({'observation': 'depth', 'camera': {'field_of_view': 0.0}}, 'above 0 degrees'),
    ({'observation': 'depth', 'camera': {'zoom': 0.0}}, 'zoom must be above 0'),
    ({'observation': 'depth', 'picture_size': (64, 0)}, 'from 1 to 4096 pixels'),
    ({'observation': 'depth', 'picture_size': (64.0, 64.0)}, 'two whole numbers'),
    ({'observation': 'depth', 'picture_size': (64, 64, 3)}, 'two whole numbers'),
    ({'observation': 'depth', 'scene': {**SMALL, 'cols': 1}}, 'give 2 or more along each side')])
def test_wrong_values_are_refused(make, options, said):
    """A mistake would show hours later, in what was learned."""
    with pytest.raises(ClothSimError, match=said):
        make(**options)


def test_neither_ros_nor_matplotlib_is_needed():
    """A training machine would need what only recordings and plots use."""
    names = ('rclpy', 'std_msgs', 'sensor_msgs', 'mcap', 'rosbags', 'matplotlib', 'PIL')
    program = (
        f'import sys; sys.modules.update(dict.fromkeys({names}))\n'
        'from cloth_sim_ros.gym import CarryCloth\n'
        'print(CarryCloth(observation="depth").reset(seed=1)[0].shape)')
    done = subprocess.run(
        [sys.executable, '-c', program], capture_output=True, text=True, timeout=120)
    assert done.stdout == '(64, 64)\n', done.stderr
