# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What an environment asks of its cloth: hands, start, goal, rewards and observations."""

import warnings

from cloth_sim_ros import ClothSimError
from cloth_sim_ros import Scene
from cut_scene import CUT
import gymnasium
from gymnasium.utils.env_checker import check_env
import numpy as np
import pytest
from small_environment import SMALL

LOOSE = {**SMALL, 'pins': ['none']}
HANDS = [[(0, 0), (1, 0), (0, 1)], [(5, 4)]]


def heights(positions, velocities):
    """Return the mean height of each cloth [m]."""
    return np.nanmean(positions[..., 2], axis=(1, 2))


@pytest.mark.parametrize('options', [
    {'observation': lambda positions, velocities: positions[:, 0, :2]},
    {'reward': heights, 'goal': None, 'hands': HANDS}])
def test_gymnasium_accepts_functions_of_users(make, options):
    """Learning libraries would fail with rewards and observations of a user's own."""
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        check_env(make(**options), skip_render_check=True)


def test_gymnasium_accepts_pictures():
    """A video of a policy could not be recorded."""
    environment = gymnasium.make(
        'cloth_sim_ros/CarryCloth-v0', scene=SMALL, render_mode='rgb_array')
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        check_env(environment.unwrapped)
    environment.reset(seed=1)
    assert environment.render().shape == (240, 320, 3)
    environment.close()


def test_a_hand_carries_all_its_nodes(make):
    """A gripper would hold one thread of the cloth, and leave the rest behind."""
    environment = make(LOOSE, hands=HANDS, speed=0.5, frame=0.1)
    start, _ = environment.reset(seed=2)
    for _ in range(3):
        seen, *_ = environment.step(np.array([[0.0, 1.0, 1.0], [0.0, 0.0, 0.0]], np.float32))
    rows, cols = np.transpose(HANDS[0])
    np.testing.assert_allclose(
        seen[rows, cols] - start[rows, cols], [(0.0, 0.15, 0.15)] * 3, atol=1e-6)
    np.testing.assert_allclose(seen[5, 4], start[5, 4], atol=1e-6)
    assert environment.action_space.shape == (2, 3)
    # Pins that no hand holds stay.
    environment = make(hands=HANDS[1:])
    start, _ = environment.reset(seed=2)
    seen, *_ = environment.step(np.ones((1, 3), np.float32))
    np.testing.assert_array_equal(seen[0, [0, 4]], start[0, [0, 4]])


def test_episodes_begin_where_the_user_says(make):
    """A folded cloth could not be the start of a task."""
    folded = Scene(SMALL).rest_positions()
    folded[..., 0] = np.abs(folded[..., 0])
    environment = make(start=folded, goal=(0.0, 0.3, 0.0), jitter=0.0)
    for _ in range(2):
        seen, info = environment.reset()
        np.testing.assert_allclose(seen, folded, atol=1e-6)
        assert info['distance'] == pytest.approx(0.3, abs=1e-6)
        environment.step(np.ones((2, 3), np.float32))


def test_a_reward_of_the_users_replaces_that_of_the_goal(make_many):
    """A task could ask for nothing but a place."""
    many = make_many(3, goal=None, reward=heights, max_steps=None)
    observations, infos = many.reset(seed=1)
    assert 'distance' not in infos
    actions = np.zeros((3, 2, 3), np.float32)
    actions[:, :, 2] = np.array([-1.0, 0.0, 1.0])[:, None]
    for _ in range(8):
        observations, rewards, terminations, truncations, _ = many.step(actions)
    np.testing.assert_allclose(rewards, observations[..., 2].mean(axis=(1, 2)), rtol=1e-6)
    assert np.all(np.diff(rewards) > 0.05)
    assert not (terminations.any() or truncations.any())


def test_functions_get_nan_where_a_shape_has_no_node(make_many):
    """A mean over the cloth would count nodes that are not there."""
    seen = []

    def reward(positions, velocities):
        seen.append((positions.shape, positions.dtype, velocities.dtype))
        assert (np.isnan(positions).any(axis=-1) == ~Scene(CUT).present_nodes).all()
        return heights(positions, velocities)

    many = make_many(3, CUT, goal=None, reward=reward, hands=[[(6, 0)]])
    many.reset(seed=1)
    many.step(np.zeros((3, 1, 3), np.float32))
    assert seen[-1] == ((3, 13, 14, 3), np.float32, np.float32)


@pytest.mark.parametrize('function, said', [
    (lambda positions, velocities: positions.mean(), r'must return \(2,\) numbers, got \(\)'),
    (lambda positions, velocities: np.zeros((2, 1)), r'must return \(2,\) numbers, got \(2, 1\)'),
    (lambda positions, velocities: np.full(len(positions), np.nan), 'finite numbers, got nan'),
    (lambda positions, velocities: ['a'] * len(positions), r'\(2,\) numbers'),
    (lambda positions, velocities: [[1], [1, 2]], r'\(2,\) numbers, got none'),
    (lambda positions: 0.0, 'a function of positions and velocities'), (3.0, 'a function of')])
def test_wrong_rewards_are_refused_at_once(make_many, function, said):
    """A training would end with its first step, or learn from nonsense."""
    with pytest.raises(ClothSimError, match=f'^reward .*{said}') as error:
        make_many(2, reward=function)
    assert '\n' not in str(error.value)


@pytest.mark.parametrize('function, said', [
    (lambda positions, velocities: positions[0], r'must return \(2, ...\) numbers'),
    (lambda positions, velocities: positions[..., 0] / 0.0, 'finite numbers, got'),
    (lambda: 0.0, 'a function of positions and velocities')])
def test_wrong_observations_are_refused_at_once(make_many, function, said):
    """A policy would get no number, or those of another cloth."""
    with np.errstate(all='ignore'), pytest.raises(ClothSimError, match=f'^observation .*{said}'):
        make_many(2, observation=function)


def test_a_reward_that_changes_its_shape_ends_the_step(make_many):
    """The rewards of cloths would be taken for those of others."""
    calls = []

    def reward(positions, velocities):
        calls.append(1)
        return np.zeros(len(positions) + (len(calls) > 2))

    many = make_many(2, reward=reward)
    many.reset(seed=1)
    with pytest.raises(ClothSimError, match=r'reward must return \(2,\) numbers, got \(3,\)'):
        many.step(np.zeros((2, 2, 3), np.float32))


@pytest.mark.parametrize('options, said', [
    ({'goal': None}, 'nothing to reward: give a goal'),
    ({'hands': []}, r'each hand needs \(n, 2\) nodes'),
    ({'hands': [(0, 0)]}, r'each hand needs \(n, 2\) nodes'),
    ({'hands': [[(9, 0)]]}, 'there is no node'),
    ({'hands': [[(0, 0)], [(0, 0)]]}, 'in two hands'),
    ({'start': np.zeros((2, 2, 3))}, r'the start must be \(6, 5, 3\) numbers'),
    ({'start': np.full((6, 5, 3), np.inf)}, 'give finite ones'),
    ({'render_mode': 'rgb_array', 'render_size': (0, 9)}, 'from 1 to 4096 pixels'),
    ({'render_mode': 'rgb_array', 'scene': {**SMALL, 'cols': 1}}, 'a picture needs a surface')])
def test_wrong_values_are_refused(make, options, said):
    """A mistake would show hours later, in what was learned."""
    with pytest.raises(ClothSimError, match=said):
        make(**options)
